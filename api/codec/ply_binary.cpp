#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "api/codec/ply_columns.h"
#include "api/codec/strided.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

static_assert(std::endian::native == std::endian::little,
              "columns are kept in the machine's byte order, taken to be little-endian");

class BinaryReader {
public:
    BinaryReader(const PlyElement& element, std::size_t rows, const PlyPlace& place,
                 bool big_endian, const Execution& execution)
        : file_(place.file),
          at_(place.at),
          first_row_(place.row),
          element_rows_(element.count),
          big_endian_(big_endian),
          execution_(execution),
          table_(table_for(element, rows)) {}

    PlyTable read() {
        const bool has_list =
            std::any_of(table_.columns.begin(), table_.columns.end(),
                        [](const PlyColumn& column) { return column.property().is_list; });
        if (has_list) {
            read_row_by_row();
        } else {
            read_blocks();
        }
        if (big_endian_) {
            for (PlyColumn& column : table_.columns) {
                swap_bytes(size_of(column.property().type), column.data());
            }
        }
        return std::move(table_);
    }

    [[nodiscard]] std::size_t at() const { return at_; }

private:
    void read_blocks();
    void read_row_by_row();
    void read_row(std::size_t row);
    void read_list(PlyColumn& column, std::size_t row);
    [[nodiscard]] std::int64_t read_integer(ScalarType type, const std::byte* source) const;
    std::uint64_t read_count(const PlyColumn& column, std::size_t row);
    const std::byte* take(std::size_t size, std::size_t row, const PlyColumn& column);

    std::span<const std::byte> file_;
    std::size_t at_;
    std::size_t first_row_;
    std::uint64_t element_rows_;
    bool big_endian_;
    const Execution& execution_;
    PlyTable table_;
};

/// The next `size` bytes of the file.
const std::byte* BinaryReader::take(std::size_t size, std::size_t row, const PlyColumn& column) {
    if (file_.size() - at_ < size) {
        malformed("the file ends at byte ", file_.size(), " inside row ", first_row_ + row, " of ",
                  element_rows_, " of element ", quoted(table_.name), ", property ",
                  quoted(column.property().name), ", which needs ", size, " bytes at byte ", at_);
    }
    const std::byte* bytes = file_.data() + at_;
    at_ += size;
    return bytes;
}

/// Rows of one length: a block of them at a time, column by column.
void BinaryReader::read_blocks() {
    std::size_t row_size = 0;
    for (const PlyColumn& column : table_.columns) row_size += size_of(column.property().type);
    // Lists of earlier elements may have used up bytes that the counts alone seemed to leave.
    const std::size_t bytes_left = file_.size() - at_;
    if (row_size > 0 && table_.rows > bytes_left / row_size) {
        malformed("element ", quoted(table_.name), " at byte ", at_, " has ", table_.rows,
                  " rows of ", row_size, " bytes, but only ", bytes_left,
                  " bytes are left; the file is truncated");
    }
    const std::byte* first = file_.data() + at_;
    for (PlyColumn& column : table_.columns) {
        column.set_rows(table_.rows);
        throw_if_cancelled(execution_);
    }
    const auto copy_block = [&](std::size_t row, std::size_t end, std::size_t) {
        const std::byte* source = first + row * row_size;
        for (PlyColumn& column : table_.columns) {
            const std::size_t size = size_of(column.property().type);
            copy_strided(size, end - row, source, row_size, column.data().data() + row * size,
                         size);
            source += size;
        }
    };
    parallel_for(execution_, kDecodePhase, "rows", table_.rows, kRowsPerBlock, copy_block);
    at_ += table_.rows * row_size;
}

void BinaryReader::read_row_by_row() {
    for (PlyColumn& column : table_.columns) {
        if (!column.property().is_list) column.set_rows(table_.rows);
    }
    parallel_for(on_one_thread(execution_), kDecodePhase, "rows", table_.rows, kRowsPerStep,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t row = begin; row < end; ++row) read_row(row);
                 });
}

void BinaryReader::read_row(std::size_t row) {
    for (PlyColumn& column : table_.columns) {
        if (column.property().is_list) {
            read_list(column, row);
            continue;
        }
        const std::size_t size = size_of(column.property().type);
        const std::byte* value = take(size, row, column);
        copy_strided(size, 1, value, size, column.data().data() + row * size, size);
    }
}

void BinaryReader::read_list(PlyColumn& column, std::size_t row) {
    const std::uint64_t length = read_count(column, row);
    const std::size_t size = size_of(column.property().type);
    const std::size_t most_values = (file_.size() - at_) / size;
    if (length >= static_cast<std::uint64_t>(kLongList)) throw_if_cancelled(execution_);
    const std::byte* values = take(length * size, row, column);
    std::byte* target = column.add_list(length, table_.rows, most_values);
    if (length > 0) std::memcpy(target, values, length * size);
}

template <typename T>
std::int64_t integer_of(std::span<const std::byte> bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

std::int64_t BinaryReader::read_integer(ScalarType type, const std::byte* source) const {
    std::array<std::byte, 4> copy{};
    const std::span<std::byte> bytes(copy.data(), size_of(type));
    std::copy_n(source, bytes.size(), bytes.begin());
    if (big_endian_) swap_bytes(bytes.size(), bytes);
    switch (type) {
        case ScalarType::Int8: return integer_of<std::int8_t>(bytes);
        case ScalarType::UInt8: return integer_of<std::uint8_t>(bytes);
        case ScalarType::Int16: return integer_of<std::int16_t>(bytes);
        case ScalarType::UInt16: return integer_of<std::uint16_t>(bytes);
        case ScalarType::Int32: return integer_of<std::int32_t>(bytes);
        default: return integer_of<std::uint32_t>(bytes);
    }
}

std::uint64_t BinaryReader::read_count(const PlyColumn& column, std::size_t row) {
    const ScalarType type = column.property().count_type;
    const std::size_t at = at_;
    const std::int64_t length = read_integer(type, take(size_of(type), row, column));
    if (length < 0) {
        malformed("byte ", at, ": the list ", quoted(column.property().name), " in row ",
                  first_row_ + row, " of element ", quoted(table_.name), " claims ", length,
                  " values; a length cannot be negative");
    }
    if (length > static_cast<std::int64_t>(kMaxPlyListLength)) {
        fail(ErrorCode::LimitExceeded, "byte ", at, ": the list ", quoted(column.property().name),
             " in row ", first_row_ + row, " of element ", quoted(table_.name), " claims ", length,
             " values; the limit is ", kMaxPlyListLength);
    }
    return static_cast<std::uint64_t>(length);
}

}  // namespace

PlyTable read_binary_rows(const PlyElement& element, std::size_t rows, PlyPlace& place,
                          bool big_endian, const Execution& execution) {
    BinaryReader reader(element, rows, place, big_endian, execution);
    PlyTable table = reader.read();
    place.at = reader.at();
    place.row += rows;
    return table;
}

}  // namespace lpf
