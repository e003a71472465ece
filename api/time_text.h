#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lpf {

/// Milliseconds since 1970-01-01T00:00:00Z.
using UnixMillis = std::int64_t;

/// "2026-03-01T12:00:00.123Z" (RFC 3339, UTC, milliseconds).
[[nodiscard]] std::string to_rfc3339(UnixMillis time);

/// The inverse; accepts 0 to 9 decimals and offsets ("+02:00"), as RFC 3339 allows.
[[nodiscard]] std::optional<UnixMillis> from_rfc3339(std::string_view text);

}  // namespace lpf
