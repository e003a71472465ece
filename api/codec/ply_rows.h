#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/attribute.h"

namespace lpf {

/// One property as it is written. Points into the document, which must stay.
struct PlyOutputColumn {
    std::string name;
    ScalarType type = ScalarType::Float32;
    const std::byte* data = nullptr;
    bool is_list = false;
    ScalarType count_type = ScalarType::UInt8;
    std::span<const std::uint64_t> offsets;  ///< of lists; empty: every list has common_length
    std::size_t common_length = 0;

    [[nodiscard]] std::size_t list_begin(std::size_t row) const {
        return offsets.empty() ? row * common_length : offsets[row];
    }
    [[nodiscard]] std::size_t list_length(std::size_t row) const {
        return offsets.empty() ? common_length : offsets[row + 1] - offsets[row];
    }
};

struct PlyOutputElement {
    std::string name;
    std::size_t rows = 0;
    std::vector<PlyOutputColumn> columns;
};

/// Appends the rows of `element` to `out`. @throws Error{Cancelled}
void write_ascii_rows(const PlyOutputElement& element, std::string& out,
                      const Execution& execution);
void write_binary_rows(const PlyOutputElement& element, bool big_endian, std::string& out,
                       const Execution& execution);

}  // namespace lpf
