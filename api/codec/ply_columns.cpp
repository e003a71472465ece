#include "api/codec/ply_columns.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lpf {
namespace {

template <typename T>
void fill(const PlyColumn& column, Points& points, Eigen::Index axis, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     const std::byte* source = column.data().data() + begin * sizeof(T);
                     for (std::size_t i = begin; i < end; ++i, source += sizeof(T)) {
                         T value;
                         std::memcpy(&value, source, sizeof value);
                         points(axis, static_cast<Eigen::Index>(i)) = static_cast<double>(value);
                     }
                 });
}

}  // namespace

std::byte* PlyColumn::set_rows(std::size_t rows) {
    data_.resize(rows * size_of(property_.type));
    return data_.data();
}

std::byte* PlyColumn::add_list(std::size_t length, std::size_t rows, std::size_t most_values) {
    const std::size_t size = size_of(property_.type);
    if (lists_ == 0) {
        common_length_ = length;
        // rows * length cannot overflow: rows <= bytes of the file, length <= 65536.
        data_.reserve(std::min(rows * length, most_values) * size);
    } else if (offsets_.empty() && length != common_length_) {
        write_offsets_out();
        offsets_.reserve(rows + 1);
    }
    ++lists_;
    if (!offsets_.empty()) offsets_.push_back(offsets_.back() + length);
    const std::size_t begin = data_.size();
    data_.resize(begin + length * size);
    return data_.data() + begin;
}

void PlyColumn::write_offsets_out() {
    offsets_.resize(lists_ + 1);
    for (std::size_t i = 0; i <= lists_; ++i) offsets_[i] = i * common_length_;
}

std::vector<std::uint64_t> PlyColumn::take_offsets() {
    if (offsets_.empty()) write_offsets_out();
    return std::exchange(offsets_, {});
}

Attribute PlyColumn::release() {
    Attribute result;
    result.name = property_.name;
    result.type = property_.type;
    result.count_type = property_.count_type;
    if (property_.is_list) result.list_offsets = take_offsets();
    result.data = std::exchange(data_, {});
    return result;
}

PlyTable table_for(const PlyElement& element, std::size_t rows) {
    PlyTable table{element.name, rows, {}};
    table.columns.reserve(element.properties.size());
    for (const PlyProperty& property : element.properties) table.columns.emplace_back(property);
    return table;
}

void fill_coordinate(const PlyColumn& column, Points& points, Eigen::Index axis,
                     const Execution& execution) {
    switch (column.property().type) {
        case ScalarType::Int8: return fill<std::int8_t>(column, points, axis, execution);
        case ScalarType::UInt8: return fill<std::uint8_t>(column, points, axis, execution);
        case ScalarType::Int16: return fill<std::int16_t>(column, points, axis, execution);
        case ScalarType::UInt16: return fill<std::uint16_t>(column, points, axis, execution);
        case ScalarType::Int32: return fill<std::int32_t>(column, points, axis, execution);
        case ScalarType::UInt32: return fill<std::uint32_t>(column, points, axis, execution);
        case ScalarType::Float32: return fill<float>(column, points, axis, execution);
        case ScalarType::Float64: return fill<double>(column, points, axis, execution);
    }
}

PlyTable read_rows(FileFormat format, const PlyElement& element, std::size_t rows, PlyPlace& place,
                   const Execution& execution) {
    if (format == FileFormat::PlyAscii) return read_ascii_rows(element, rows, place, execution);
    return read_binary_rows(element, rows, place, format == FileFormat::PlyBigEndian, execution);
}

}  // namespace lpf
