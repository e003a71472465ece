#include "server/http/head.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "api/http_text.h"
#include "api/problem.h"

namespace lpf::http {
namespace {

constexpr std::string_view kEndOfLine = "\r\n";

[[noreturn]] void refuse(ProblemCode problem, const std::string& detail) {
    throw ProblemException(problem, detail);
}

[[noreturn]] void refuse_head(const std::string& detail) {
    refuse(ProblemCode::MalformedRequest, detail);
}

bool is_token(std::string_view text) {
    static constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) ||
               kMarks.find(c) != std::string_view::npos;
    });
}

void parse_target(std::string_view target, const Limits& limits, Head& head) {
    if (target.size() > limits.uri_bytes) {
        refuse(ProblemCode::UriTooLong,
               "The request target is longer than " + std::to_string(limits.uri_bytes) + " bytes.");
    }
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (!target.starts_with(scheme)) continue;
        const auto slash = target.find('/', scheme.size());
        target = slash == std::string_view::npos ? "/" : target.substr(slash);
    }
    if (!target.starts_with('/') || has_control(target))
        refuse_head("The request target must be a path that starts with '/'.");
    const auto mark = target.find('?');
    head.path = percent_decode(target.substr(0, mark), false);
    if (mark != std::string_view::npos) head.query = parse_query(target.substr(mark + 1));
}

void parse_request_line(std::string_view line, const Limits& limits, Head& head) {
    const auto first = line.find(' ');
    const auto last = line.rfind(' ');
    if (first == std::string_view::npos || first == last)
        refuse_head("The request line must read 'METHOD target HTTP/1.1'.");
    const auto version = line.substr(last + 1);
    if (version != "HTTP/1.1" && version != "HTTP/1.0")
        refuse_head("Only HTTP/1.1 and HTTP/1.0 are spoken here.");
    const auto target = line.substr(first + 1, last - first - 1);
    if (target.find(' ') != std::string_view::npos)
        refuse_head("The request target must not hold a blank; write %20.");
    head.method = line.substr(0, first);
    constexpr std::array kMethods{"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"};
    if (std::find(kMethods.begin(), kMethods.end(), head.method) == kMethods.end())
        refuse(ProblemCode::MethodNotAllowed, "This request method is not known here.");
    parse_target(target, limits, head);
}

void parse_fields(std::string_view text, const Limits& limits, Head& head) {
    while (!text.starts_with(kEndOfLine)) {
        const auto end = text.find(kEndOfLine);
        const auto line = text.substr(0, end);
        text.remove_prefix(end + kEndOfLine.size());
        const auto colon = line.find(':');
        if (colon == std::string_view::npos || !is_token(line.substr(0, colon)))
            refuse_head("A header field must read 'Name: value'.");
        const auto value = trim(line.substr(colon + 1));
        if (has_control(value)) refuse_head("A header value holds a control character.");
        if (head.headers.size() == limits.head_fields) {
            refuse(ProblemCode::HeadTooLarge,
                   "More than " + std::to_string(limits.head_fields) + " header fields.");
        }
        head.headers.emplace_back(lower(line.substr(0, colon)), value);
    }
}

/// The value of a field that may come once at most.
std::optional<std::string> single(const Head& head, std::string_view name) {
    std::optional<std::string> found;
    for (const auto& [key, value] : head.headers) {
        if (key != name) continue;
        if (found) refuse_head("The header field " + std::string(name) + " came twice.");
        found = value;
    }
    return found;
}

void parse_length(const std::string& text, const Limits& limits, Head& head) {
    std::uint64_t length = 0;
    const auto* end = text.data() + text.size();
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
    if (!digits) refuse_head("Content-Length must be a number of bytes.");
    const auto [stop, error] = std::from_chars(text.data(), end, length);
    if (error != std::errc() || stop != end || length > limits.upload_bytes) {
        refuse(ProblemCode::PayloadTooLarge, "The body is larger than the limit of " +
                                                 std::to_string(limits.upload_bytes) +
                                                 " bytes (uploadBytes).");
    }
    head.content_length = length;
}

void find_framing(const Limits& limits, Head& head) {
    const auto length = single(head, "content-length");
    const auto encoding = single(head, "transfer-encoding");
    if (length && encoding)
        refuse_head("Content-Length and Transfer-Encoding must not come together.");
    if (encoding && (lower(*encoding) != "chunked" || head.old))
        refuse_head("The only transfer coding known here is 'chunked', of HTTP/1.1.");
    head.chunked = encoding.has_value();
    if (length) parse_length(*length, limits, head);
    const bool wants_body = head.method == "POST" || head.method == "PUT" || head.method == "PATCH";
    if (wants_body && !length && !encoding) {
        refuse(ProblemCode::LengthRequired,
               "Say how long the body is: send Content-Length, or Transfer-Encoding: chunked.");
    }
}

void find_coding(Head& head) {
    const std::string coding = lower(single(head, "content-encoding").value_or("identity"));
    head.gzip = coding == "gzip" || coding == "x-gzip";
    if (head.gzip || coding == "identity") return;
    refuse(ProblemCode::UnsupportedMediaType,
           "The body may be compressed with gzip, or not at all: send Content-Encoding: gzip, or "
           "none.");
}

/// What the client says about the connection itself.
void find_manners(Head& head) {
    head.expects_continue =
        !head.old && lower(single(head, "expect").value_or("")) == "100-continue";
    head.keep_alive = !head.old;
    for (const auto& [name, value] : head.headers) {
        if (name != "connection") continue;
        const std::string options = "," + lower(value) + ",";
        for (std::size_t at = 0; (at = options.find("close", at)) != std::string::npos; ++at) {
            const bool begins = options[at - 1] == ',' || options[at - 1] == ' ';
            const bool ends = options[at + 5] == ',' || options[at + 5] == ' ';
            if (begins && ends) head.keep_alive = false;
        }
    }
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::size_t end_of_head(std::string_view text, std::size_t known) {
    auto at = text.find('\n', known);
    for (; at != std::string_view::npos; at = text.find('\n', at + 1)) {
        if (at == 0 || text[at - 1] != '\r') refuse_head("A line of the head does not end CR LF.");
        if (at >= 3 && text.substr(at - 3, 2) == kEndOfLine) return at + 1;
    }
    return std::string_view::npos;
}

Head parse_head(std::string_view text, const Limits& limits) {
    if (text.size() > limits.head_bytes || end_of_head(text) != text.size()) {
        refuse(ProblemCode::HeadTooLarge, "The request's head is larger than " +
                                              std::to_string(limits.head_bytes) + " bytes.");
    }
    Head head;
    const auto end = text.find(kEndOfLine);
    parse_request_line(text.substr(0, end), limits, head);
    parse_fields(text.substr(end + kEndOfLine.size()), limits, head);
    head.old = text.substr(0, end).ends_with("HTTP/1.0");
    const auto host = single(head, "host");
    if (!host && !head.old) refuse_head("The header field Host is missing.");
    find_framing(limits, head);
    find_coding(head);
    find_manners(head);
    return head;
}

std::string transport_head(const Head& head) {
    std::string out = head.method == "HEAD" ? "HEAD / HTTP/1.1\r\n" : "GET / HTTP/1.1\r\n";
    for (const auto& [name, value] : head.headers)
        if (name == "accept-encoding") out += name + ": " + value + "\r\n";
    return out + "\r\n";
}

std::string percent_decode(std::string_view text, bool plus_is_blank) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '+' && plus_is_blank) {
            out += ' ';
        } else if (text[i] != '%') {
            out += text[i];
        } else {
            const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
            const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
            if (high < 0 || low < 0 || (high == 0 && low == 0))
                refuse_head("The request target holds a broken %-escape.");
            out += static_cast<char>(high * 16 + low);
            i += 2;
        }
    }
    return out;
}

Fields parse_query(std::string_view text) {
    Fields fields;
    while (!text.empty()) {
        const auto end = std::min(text.find('&'), text.size());
        const auto pair = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (pair.empty()) continue;
        const auto equals = pair.find('=');
        const auto value =
            equals == std::string_view::npos ? std::string_view{} : pair.substr(equals + 1);
        fields.emplace_back(percent_decode(pair.substr(0, equals), true),
                            percent_decode(value, true));
    }
    return fields;
}

}  // namespace lpf::http
