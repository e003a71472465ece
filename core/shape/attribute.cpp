#include "core/shape/attribute.h"

#include <cstring>
#include <utility>

namespace lpf {
namespace {

template <typename T>
double read(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

Attribute gather_lists(const Attribute& source, std::span<const std::uint32_t> rows) {
    Attribute result{source.name, source.type, {}, {0}, source.count_type};
    const std::size_t size = size_of(source.type);
    for (const std::uint32_t row : rows) {
        const auto* first = source.data.data() + source.list_offsets[row] * size;
        const auto* last = source.data.data() + source.list_offsets[row + 1] * size;
        result.data.insert(result.data.end(), first, last);
        result.list_offsets.push_back(result.data.size() / size);
    }
    return result;
}

}  // namespace

Attribute gather(const Attribute& source, std::span<const std::uint32_t> rows) {
    if (source.is_list()) return gather_lists(source, rows);
    const std::size_t size = size_of(source.type);
    Attribute result{source.name, source.type, {}, {}, source.count_type};
    result.data.resize(rows.size() * size);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::memcpy(result.data.data() + i * size, source.data.data() + rows[i] * size, size);
    }
    return result;
}

double value_at(const Attribute& attribute, std::size_t row) {
    const std::byte* from = attribute.data.data() + row * size_of(attribute.type);
    switch (attribute.type) {
        case ScalarType::Int8: return read<std::int8_t>(from);
        case ScalarType::UInt8: return read<std::uint8_t>(from);
        case ScalarType::Int16: return read<std::int16_t>(from);
        case ScalarType::UInt16: return read<std::uint16_t>(from);
        case ScalarType::Int32: return read<std::int32_t>(from);
        case ScalarType::UInt32: return read<std::uint32_t>(from);
        case ScalarType::Float32: return read<float>(from);
        case ScalarType::Float64: return read<double>(from);
    }
    return 0.0;
}

Attribute float_attribute(std::string name, std::span<const float> values) {
    Attribute result;
    result.name = std::move(name);
    result.data.resize(values.size_bytes());
    if (!values.empty()) std::memcpy(result.data.data(), values.data(), values.size_bytes());
    return result;
}

}  // namespace lpf
