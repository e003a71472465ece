#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/limits.h"
#include "server/http/message.h"

namespace lpf::http {

/// The head of a request: request line and header fields, strictly checked.
struct Head {
    std::string method;
    std::string path;  ///< percent-decoded
    Fields query;      ///< percent-decoded
    Fields headers;    ///< names in lower case
    std::optional<std::uint64_t> content_length;
    bool chunked = false;
    bool gzip = false;              ///< the body is compressed
    bool expects_continue = false;  ///< the body comes only after 100 Continue
    bool old = false;               ///< HTTP/1.0
    bool keep_alive = true;         ///< the client may have another request

    [[nodiscard]] bool has_body() const { return chunked || content_length.value_or(0) > 0; }
};

/// Parses a head, from the request line up to and including the empty line. Stricter than the
/// transport library below, which guesses where it should refuse (lengths that are no numbers,
/// length and chunked together) and so can be made to see two requests in one.
/// @throws ProblemException 400, 405, 411, 413, 414, 415 or 431
[[nodiscard]] Head parse_head(std::string_view text, const Limits& limits);

/// Position after the empty line that ends a head, or npos while it is incomplete.
/// @param known bytes that were looked at before
/// @throws ProblemException 400 at a line that ends in a bare LF
[[nodiscard]] std::size_t end_of_head(std::string_view text, std::size_t known = 0);

/// The head that the transport library gets to see: only what it needs to write an answer. Path
/// (it matches by recursive regular expressions), body, ranges and forged address fields are ours
/// to judge.
[[nodiscard]] std::string transport_head(const Head& head);

/// Decodes %XX, and '+' as a blank if `plus_is_blank`.
/// @throws ProblemException 400 for a broken escape or an encoded NUL
[[nodiscard]] std::string percent_decode(std::string_view text, bool plus_is_blank);

/// Splits and decodes `a=1&b=2`.
[[nodiscard]] Fields parse_query(std::string_view text);

}  // namespace lpf::http
