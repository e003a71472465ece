#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/ply_header.h"
#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

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

/// Where a reader of rows stands.
struct PlyPlace {
    std::span<const std::byte> file;  ///< all of it, so that messages can name lines and offsets
    std::size_t at = 0;               ///< the next byte
    std::size_t row = 0;              ///< the next row of the element
};

/// Reads the next `rows` rows of `element` from ASCII or binary data; `place` moves behind them.
/// @throws Error{MalformedFile, LimitExceeded, Cancelled}
[[nodiscard]] PlyTable read_ascii_rows(const PlyElement& element, std::size_t rows, PlyPlace& place,
                                       const Execution& execution);
[[nodiscard]] PlyTable read_binary_rows(const PlyElement& element, std::size_t rows,
                                        PlyPlace& place, bool big_endian,
                                        const Execution& execution);

[[nodiscard]] PlyTable read_rows(FileFormat format, const PlyElement& element, std::size_t rows,
                                 PlyPlace& place, const Execution& execution);

/// Fills one row of `points` with the values of a scalar column. @pre as many values as points
void fill_coordinate(const PlyColumn& column, Points& points, Eigen::Index axis,
                     const Execution& execution);

/// An empty table of `rows` rows with a column for each property.
[[nodiscard]] PlyTable table_for(const PlyElement& element, std::size_t rows);

/// What reading and writing files is called while it goes on.
inline constexpr std::string_view kDecodePhase = "decode";
inline constexpr std::string_view kEncodePhase = "encode";

/// Rows between two questions whether to stop.
inline constexpr std::size_t kRowsPerStep = 512;

/// Lists of so many values are asked about one by one: a few hundred rows of them are a whole file.
inline constexpr std::int64_t kLongList = 1024;

}  // namespace lpf
