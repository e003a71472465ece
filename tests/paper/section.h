#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lpf::paper {

/// A cell of a table: text, and the number behind it where there is one.
struct Cell {
    Cell(const char* words) : text(words) {}             // NOLINT: cells are written as literals
    Cell(std::string words) : text(std::move(words)) {}  // NOLINT
    Cell(std::string words, double number) : text(std::move(words)), value(number) {}

    std::string text;
    std::optional<double> value = {};
};

/// `digits` significant digits, never in powers of ten.
[[nodiscard]] Cell number(double value, int digits = 3);

/// `value` as a share in per cent.
[[nodiscard]] Cell percent(double share, int digits = 3);

/// The first cell of a row is its name.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows = {};

    /// The number in a row and a column, by their names.
    /// @throws std::out_of_range if there is none
    [[nodiscard]] double at(const std::string& row, const std::string& column) const;
};

struct Picture {
    std::string file;  ///< relative to the document
    std::string caption;
};

/// What the paper says or shows, held against the numbers found here.
struct Claim {
    std::string text;
    bool holds = false;
};

/// What an experiment leaves: a chapter of the document, and its numbers.
struct Section {
    std::string title = {};  ///< begins with the paper's name of it: "Fig. 16", "Table 1"
    std::string paper = {};  ///< what the paper did and found
    std::string here = {};   ///< what is done here
    std::vector<Table> tables = {};
    std::vector<Picture> pictures = {};
    std::string note = {};  ///< how to read them
    std::vector<Claim> claims = {};
};

[[nodiscard]] std::string markdown(const Section& section, double seconds);

}  // namespace lpf::paper
