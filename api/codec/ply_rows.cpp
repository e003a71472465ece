#include "api/codec/ply_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "api/codec/ply_columns.h"
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

void write_row_with_lists(const PlyOutputElement& element, std::size_t row, bool big_endian,
                          std::string& out) {
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

/// A block of rows at a time, column by column.
void write_equal_rows(const PlyOutputElement& element, bool big_endian, std::string& out,
                      const Execution& execution) {
    std::size_t row_size = 0;
    for (const PlyOutputColumn& column : element.columns) row_size += size_of(column.type);
    const std::size_t begin = out.size();
    out.resize(begin + element.rows * row_size);
    throw_if_cancelled(execution);
    auto* const target = reinterpret_cast<std::byte*>(out.data() + begin);
    const auto write_block = [&](std::size_t row, std::size_t end, std::size_t) {
        std::array<std::byte, 8 * kRowsPerBlock> swapped;
        const std::size_t n = end - row;
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
    };
    parallel_for(execution, kEncodePhase, "rows", element.rows, kRowsPerBlock, write_block);
}

void write_ascii_row(const PlyOutputElement& element, std::size_t row, std::string& out) {
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

/// Calls write(row) for every row, and asks now and then whether to stop.
template <typename Write>
void for_each_row(const PlyOutputElement& element, const Execution& execution, Write write) {
    parallel_for(on_one_thread(execution), kEncodePhase, "rows", element.rows, kRowsPerStep,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t row = begin; row < end; ++row) write(row);
                 });
}

}  // namespace

void write_ascii_rows(const PlyOutputElement& element, std::string& out,
                      const Execution& execution) {
    for_each_row(element, execution, [&](std::size_t row) { write_ascii_row(element, row, out); });
}

void write_binary_rows(const PlyOutputElement& element, bool big_endian, std::string& out,
                       const Execution& execution) {
    const bool has_list = std::any_of(element.columns.begin(), element.columns.end(),
                                      [](const PlyOutputColumn& column) { return column.is_list; });
    if (!has_list) return write_equal_rows(element, big_endian, out, execution);
    for_each_row(element, execution,
                 [&](std::size_t row) { write_row_with_lists(element, row, big_endian, out); });
}

}  // namespace lpf
