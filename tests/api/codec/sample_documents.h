#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/document.h"
#include "api/codec/format.h"
#include "core/base/error.h"

namespace lpf {

[[nodiscard]] std::span<const std::byte> bytes_of(std::string_view text);

/// Decodes with the given or the default limits.
[[nodiscard]] Document read(std::string_view file, const DecodeLimits& limits = {});

/// The error that decoding ends in; nothing if it succeeds. Any other exception fails the test.
[[nodiscard]] std::optional<Error> refusal(std::string_view file, const DecodeLimits& limits = {});

/// Encodes; what was lost is put into `lost` if it is given.
[[nodiscard]] std::string written(const Document& document, const EncodeOptions& options,
                                  std::vector<Warning>* lost = nullptr);

/// Appends the bytes of a value as they lie in a binary file.
template <typename T>
void append(std::string& out, T value, bool big_endian = false) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big_endian) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
}

/// An attribute from values.
template <typename T>
Attribute column(std::string name, ScalarType type, const std::vector<T>& values) {
    Attribute attribute{std::move(name), type, {}, {}, ScalarType::UInt8};
    attribute.data.resize(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(attribute.data.data(), values.data(), attribute.data.size());
    return attribute;
}

/// All values of an attribute, lists in a row, as doubles.
[[nodiscard]] std::vector<double> values_of(const Attribute& attribute);

/// The attribute of that name; fails the test if there is none.
[[nodiscard]] const Attribute& attribute_of(const Document& document, std::string_view name);

[[nodiscard]] bool has_warning(const std::vector<Warning>& warnings, std::string_view code);

/// Four points with a column of every type at both ends of its range.
[[nodiscard]] Document points_with_every_type();

/// A quad, a triangle and everything else that a PLY file can hold: lists, face properties,
/// elements before and after, comments.
[[nodiscard]] Document mesh_with_everything();

void expect_same_attribute(const Attribute& got, const Attribute& expected);
void expect_same(const Document& got, const Document& expected);

}  // namespace lpf
