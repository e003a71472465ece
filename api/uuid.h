#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lpf {

/// Every ID of the service, as a regular expression.
inline constexpr std::string_view kUuidPattern =
    "^[0-9a-f]{8}-[0-9a-f]{4}-7[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$";

/// A version 7 UUID (RFC 9562): 48 bits of time, 74 random bits; sorts by time as text.
/// @param random 80 random bits, of which the six under version and variant are overwritten
[[nodiscard]] std::string make_uuid7(std::int64_t unix_millis,
                                     const std::array<std::uint8_t, 10>& random);

/// True for a version 7 UUID in canonical form: lower case, 8-4-4-4-12.
[[nodiscard]] bool is_uuid7(std::string_view text);

/// The time inside. @pre is_uuid7(text)
[[nodiscard]] std::int64_t uuid7_millis(std::string_view text);

}  // namespace lpf
