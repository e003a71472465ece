#include "api/codec/ply_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "api/codec/strided.h"

namespace lpf {
namespace {

template <typename T>
void append_text(const std::byte* from, std::string& out) {
    T value;
    std::memcpy(&value, from, sizeof value);
    std::array<char, 32> text{};
    // Shortest text that reads back as the same value.
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    out.append(text.data(), result.ptr);
}

void append_text(ScalarType type, const std::byte* from, std::string& out) {
    switch (type) {
        case ScalarType::Int8: return append_text<std::int8_t>(from, out);
        case ScalarType::UInt8: return append_text<std::uint8_t>(from, out);
        case ScalarType::Int16: return append_text<std::int16_t>(from, out);
        case ScalarType::UInt16: return append_text<std::uint16_t>(from, out);
        case ScalarType::Int32: return append_text<std::int32_t>(from, out);
        case ScalarType::UInt32: return append_text<std::uint32_t>(from, out);
        case ScalarType::Float32: return append_text<float>(from, out);
        case ScalarType::Float64: return append_text<double>(from, out);
    }
}

void append_list_text(const PlyOutputColumn& column, std::size_t row, std::string& out) {
    const std::size_t size = size_of(column.type);
    const std::size_t length = column.list_length(row);
    const std::byte* values = column.data + column.list_begin(row) * size;
    out += std::to_string(length);
    for (std::size_t i = 0; i < length; ++i) {
        out += ' ';
        append_text(column.type, values + i * size, out);
    }
}

/// Appends `n` values in the byte order that is asked for.
void append_binary(std::size_t size, std::size_t n, const std::byte* from, bool big_endian,
                   std::string& out) {
    const std::size_t begin = out.size();
    out.append(reinterpret_cast<const char*>(from), size * n);
    if (big_endian) swap_bytes(size, std::as_writable_bytes(std::span(out).subspan(begin)));
}

void append_count(const PlyOutputColumn& column, std::size_t length, bool big_endian,
                  std::string& out) {
    const auto count = static_cast<std::uint32_t>(length);
    std::array<std::byte, sizeof count> bytes{};
    std::memcpy(bytes.data(), &count, sizeof count);
    append_binary(size_of(column.count_type), 1, bytes.data(), big_endian, out);
}

void write_rows_with_lists(const PlyOutputElement& element, bool big_endian, std::string& out) {
    for (std::size_t row = 0; row < element.rows; ++row) {
        for (const PlyOutputColumn& column : element.columns) {
            const std::size_t size = size_of(column.type);
            if (!column.is_list) {
                append_binary(size, 1, column.data + row * size, big_endian, out);
                continue;
            }
            const std::size_t length = column.list_length(row);
            append_count(column, length, big_endian, out);
            const std::byte* values = column.data + column.list_begin(row) * size;
            append_binary(size, length, values, big_endian, out);
        }
    }
}

/// A block of rows at a time, column by column.
void write_equal_rows(const PlyOutputElement& element, bool big_endian, std::string& out) {
    std::size_t row_size = 0;
    for (const PlyOutputColumn& column : element.columns) row_size += size_of(column.type);
    const std::size_t begin = out.size();
    out.resize(begin + element.rows * row_size);
    auto* const target = reinterpret_cast<std::byte*>(out.data() + begin);
    std::array<std::byte, 8 * kRowsPerBlock> swapped{};
    for (std::size_t row = 0; row < element.rows; row += kRowsPerBlock) {
        const std::size_t n = std::min(kRowsPerBlock, element.rows - row);
        std::byte* value = target + row * row_size;
        for (const PlyOutputColumn& column : element.columns) {
            const std::size_t size = size_of(column.type);
            const std::byte* source = column.data + row * size;
            if (big_endian) {
                std::copy_n(source, n * size, swapped.data());
                swap_bytes(size, std::span(swapped).first(n * size));
                source = swapped.data();
            }
            copy_strided(size, n, source, size, value, row_size);
            value += size;
        }
    }
}

}  // namespace

void write_ascii_rows(const PlyOutputElement& element, std::string& out) {
    for (std::size_t row = 0; row < element.rows; ++row) {
        bool first = true;
        for (const PlyOutputColumn& column : element.columns) {
            if (!first) out += ' ';
            first = false;
            if (column.is_list) {
                append_list_text(column, row, out);
            } else {
                append_text(column.type, column.data + row * size_of(column.type), out);
            }
        }
        out += '\n';
    }
}

void write_binary_rows(const PlyOutputElement& element, bool big_endian, std::string& out) {
    const bool has_list = std::any_of(element.columns.begin(), element.columns.end(),
                                      [](const PlyOutputColumn& column) { return column.is_list; });
    if (has_list) {
        write_rows_with_lists(element, big_endian, out);
    } else {
        write_equal_rows(element, big_endian, out);
    }
}

}  // namespace lpf
