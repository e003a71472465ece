#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lpf {

/// ASCII letters in lower case.
[[nodiscard]] std::string lower(std::string_view text);

/// Without blanks and tabs at either end.
[[nodiscard]] std::string_view trim(std::string_view text);

/// True if there is a control character other than a tab, which no header field may hold.
[[nodiscard]] bool has_control(std::string_view text);

/// Seconds of `Prefer: wait=N` (RFC 7240), at most `maximum`; nothing if it is absent or not a
/// number. Preferences that are not understood are passed over, as the RFC wants.
[[nodiscard]] std::optional<std::uint64_t> prefer_wait(std::string_view header,
                                                       std::uint64_t maximum);

/// True if the header holds `respond-async` (RFC 7240).
[[nodiscard]] bool prefers_async(std::string_view header);

/// The offer that the Accept header likes best (RFC 9110, Sec. 12.5.1): quality first, then the
/// order of the offers. An empty header accepts everything; a header that cannot be read, too.
/// @param offers media types without parameters, the server's favourite first
/// @returns index into offers, or nothing if none is acceptable
[[nodiscard]] std::optional<std::size_t> best_offer(std::string_view accept,
                                                    std::span<const std::string_view> offers);

/// Media type without parameters, lower case: "Application/JSON; charset=x" -> "application/json".
[[nodiscard]] std::string bare_media_type(std::string_view content_type);

/// A parameter of a header ("boundary" of multipart/form-data, "filename" of a disposition),
/// unquoted.
[[nodiscard]] std::optional<std::string> header_parameter(std::string_view header,
                                                          std::string_view name);

/// The text of an extended parameter (RFC 8187) such as `UTF-8''na%C3%AFve`; nothing if it is
/// malformed or in another character set.
[[nodiscard]] std::optional<std::string> extended_value(std::string_view text);

/// What a Range header (RFC 9110, Sec. 14) asks of `size` bytes.
struct ByteRange {
    enum class Kind { Whole, Part, Unsatisfiable } kind = Kind::Whole;
    std::uint64_t first = 0;  ///< of Part, inclusive
    std::uint64_t last = 0;   ///< of Part, inclusive

    bool operator==(const ByteRange&) const = default;
};

/// A single range gives a Part, or Unsatisfiable (416) if it starts behind the end. Several ranges,
/// another unit and malformed text are ignored, as RFC 9110 allows: the whole is sent.
[[nodiscard]] ByteRange parse_range(std::string_view header, std::uint64_t size);

/// "bytes 0-99/1234", or "bytes */1234" for an unsatisfiable one.
[[nodiscard]] std::string content_range(const ByteRange& range, std::uint64_t size);

/// True if an If-None-Match or If-Match list names the tag, or is "*". Weak comparison ignores W/.
/// @param etag with its quotes
[[nodiscard]] bool etag_matches(std::string_view header, std::string_view etag, bool weak);

/// attachment; filename="..." (RFC 6266), with filename* where the name is not plain ASCII. Control
/// characters, quotes and slashes become "_".
[[nodiscard]] std::string content_disposition(std::string_view filename);

/// Whole text as a decimal number: no sign, no space. Nothing on overflow.
[[nodiscard]] std::optional<std::uint64_t> parse_number(std::string_view text);

}  // namespace lpf
