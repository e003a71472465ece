#include "tests/paper/section.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace lpf::paper {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
    std::string line = "|";
    for (const std::string& cell : cells) line += " " + cell + " |";
    return line + "\n";
}

std::string markdown(const Table& table) {
    std::string text = line_of(table.columns) + "|";
    for (std::size_t i = 0; i < table.columns.size(); ++i) text += "---|";
    text += "\n";
    for (const auto& row : table.rows) {
        std::vector<std::string> cells;
        for (const Cell& cell : row) cells.push_back(cell.text);
        text += line_of(cells);
    }
    return text + "\n";
}

constexpr double kNothing = 1e-9;  // what rounding leaves of zero

}  // namespace

Cell number(double value, int digits) {
    if (!std::isfinite(value)) return {"-"};
    if (std::abs(value) < kNothing) return {"0", value};
    const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    std::ostringstream out;
    out << std::fixed << std::setprecision(std::max(0, digits - before)) << value;
    return {out.str(), value};
}

Cell percent(double share, int digits) {
    Cell cell = number(100 * share, digits);
    cell.text += " %";
    return cell;
}

double Table::at(const std::string& row, const std::string& column) const {
    const auto place = std::ranges::find(columns, column);
    for (const auto& cells : rows) {
        if (cells.empty() || cells[0].text != row || place == columns.end()) continue;
        const auto index = static_cast<std::size_t>(place - columns.begin());
        if (index < cells.size() && cells[index].value) return *cells[index].value;
    }
    throw std::out_of_range("There is no number in row '" + row + "', column '" + column + "'.");
}

std::string markdown(const Section& section, double seconds) {
    std::ostringstream out;
    out << "## " << section.title << "\n\n";
    if (!section.paper.empty()) out << "**Paper.** " << section.paper << "\n\n";
    if (!section.here.empty()) out << "**Here.** " << section.here << "\n\n";
    for (const Table& table : section.tables) out << markdown(table);
    for (const Picture& picture : section.pictures) {
        out << "![" << picture.caption << "](" << picture.file << ")\n\n*" << picture.caption
            << "*\n\n";
    }
    if (!section.note.empty()) out << section.note << "\n\n";
    for (const Claim& claim : section.claims) {
        out << "- " << (claim.holds ? "holds" : "**does not hold**") << ": " << claim.text << "\n";
    }
    if (!section.claims.empty()) out << "\n";
    out << "(" << std::fixed << std::setprecision(0) << std::max(1.0, seconds)
        << " s, measurements and pictures included)\n";
    return out.str();
}

}  // namespace lpf::paper
