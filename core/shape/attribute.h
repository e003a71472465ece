#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lpf {

enum class ScalarType : std::uint8_t {
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Float32,
    Float64
};

/// Bytes of one value.
[[nodiscard]] constexpr std::size_t size_of(ScalarType type) {
    switch (type) {
        case ScalarType::Int8:
        case ScalarType::UInt8: return 1;
        case ScalarType::Int16:
        case ScalarType::UInt16: return 2;
        case ScalarType::Int32:
        case ScalarType::UInt32:
        case ScalarType::Float32: return 4;
        case ScalarType::Float64: return 8;
    }
    return 0;
}

/// One named column of values that goes along with the points, one row a point, in the machine's
/// byte order: red, green, blue, intensity, nx, ... or a list of values a point.
struct Attribute {
    std::string name;
    ScalarType type = ScalarType::Float32;
    std::vector<std::byte> data;  ///< rows x size_of(type) bytes; for lists, all lists in a row

    /// Empty for a scalar column. For a list column: rows + 1 offsets into `data`, in values.
    std::vector<std::uint64_t> list_offsets;
    ScalarType count_type = ScalarType::UInt8;  ///< of the list's length, as the file had it

    [[nodiscard]] bool is_list() const { return !list_offsets.empty(); }
    [[nodiscard]] std::size_t rows() const {
        return is_list() ? list_offsets.size() - 1 : data.size() / size_of(type);
    }
};

/// The rows of `source` named by `rows`, in that order. @pre every row < source.rows()
[[nodiscard]] Attribute gather(const Attribute& source, std::span<const std::uint32_t> rows);

/// The value in row `row` of a scalar column, as a double. @pre row < attribute.rows()
[[nodiscard]] double value_at(const Attribute& attribute, std::size_t row);

/// A float32 column from values. @post rows() == values.size()
[[nodiscard]] Attribute float_attribute(std::string name, std::span<const float> values);

}  // namespace lpf
