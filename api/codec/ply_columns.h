#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/codec/ply_header.h"

namespace lpf {

/// One property of one element while it is read: all its values in a row.
class PlyColumn {
public:
    explicit PlyColumn(const PlyProperty& property) : property_(property) {}

    [[nodiscard]] const PlyProperty& property() const { return property_; }
    [[nodiscard]] std::vector<std::byte>& data() { return data_; }
    [[nodiscard]] const std::vector<std::byte>& data() const { return data_; }

    /// Makes room for `rows` scalar values and returns where the first goes.
    std::byte* set_rows(std::size_t rows);

    /// Adds a list of `length` values and returns where they go. The first list makes room for
    /// `rows` like it, but no more than `most_values` values, which is what the file can hold.
    std::byte* add_list(std::size_t length, std::size_t rows, std::size_t most_values);

    /// The length of every list, if all are equally long. @pre a list column
    [[nodiscard]] bool all_lists_have(std::size_t length) const {
        return offsets_.empty() && (lists_ == 0 || common_length_ == length);
    }

    /// Offsets of the lists in values, one more than there are lists.
    [[nodiscard]] std::vector<std::uint64_t> take_offsets();

    /// The column as an attribute; nothing is left behind.
    [[nodiscard]] Attribute release();

private:
    void write_offsets_out();

    PlyProperty property_;
    std::vector<std::byte> data_;
    std::size_t lists_ = 0;
    std::size_t common_length_ = 0;
    std::vector<std::uint64_t> offsets_;  ///< empty while all lists are equally long
};

/// One element's rows, as columns.
struct PlyTable {
    std::string name;
    std::size_t rows = 0;
    std::vector<PlyColumn> columns;
};

/// Reads the rows of `element` from ASCII or binary data; `at` moves behind them.
/// @param file  the whole file, so that messages can name lines and offsets
/// @throws Error{MalformedFile, LimitExceeded}
[[nodiscard]] PlyTable read_ascii_rows(const PlyElement& element, std::span<const std::byte> file,
                                       std::size_t& at);
[[nodiscard]] PlyTable read_binary_rows(const PlyElement& element, std::span<const std::byte> file,
                                        std::size_t& at, bool big_endian);

/// An empty table with a column for each property.
[[nodiscard]] PlyTable table_for(const PlyElement& element);

}  // namespace lpf
