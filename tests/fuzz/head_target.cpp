// Any bytes as the head of a request: parsed or refused with a status, and what is passed on to
// the transport library below can be read in one way only.

#include <algorithm>

#include "api/problem.h"
#include "server/http/head.h"
#include "tests/fuzz/target.h"

namespace lpf::fuzz {
namespace {

std::size_t count(std::string_view text, std::string_view part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size()))
        ++found;
    return found;
}

bool has_line_break(std::string_view text) { return text.find_first_of("\r\n") != text.npos; }

void require_one_meaning(const http::Head& head) {
    require(!(head.chunked && head.content_length), "a body is framed in one way");
    require(!head.path.empty() && head.path[0] == '/', "a path begins with a slash");
    require(head.path.find('\0') == std::string::npos, "a path holds no NUL");
    require(std::none_of(head.headers.begin(), head.headers.end(),
                         [](const auto& field) {
                             return has_line_break(field.first) || has_line_break(field.second);
                         }),
            "a field is one line");
    const std::string passed_on = http::transport_head(head);
    require(http::end_of_head(passed_on) == passed_on.size(), "one head is passed on, no more");
    require(count(passed_on, "\ncontent-length:") <= 1, "a length is passed on once");
    require(count(passed_on, "\ntransfer-encoding:") <= 1, "a coding is passed on once");
}

}  // namespace

std::vector<std::string> seeds() {
    return {"GET / HTTP/1.1\r\nHost: a\r\n\r\n",
            "POST /v1/shapes?x=%2F+&y HTTP/1.1\r\nHost: a\r\nContent-Length: 12\r\n"
            "Content-Type: application/octet-stream\r\nExpect: 100-continue\r\n\r\n",
            "POST /v1/processes/denoise/execution?radius=1 HTTP/1.1\r\nHost: a\r\n"
            "Transfer-Encoding: chunked\r\nContent-Encoding: gzip\r\nPrefer: wait=5\r\n\r\n",
            "GET http://host/v1/jobs/1/results/points HTTP/1.0\r\nRange: bytes=0-9\r\n"
            "Accept: */*;q=0.5\r\nIf-None-Match: \"a\"\r\nConnection: close\r\n\r\n"};
}

}  // namespace lpf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lpf;
    std::string text(fuzz::text_of(data, size));
    try {
        const std::size_t end = http::end_of_head(text);
        // Most mutations lose the empty line, without which nothing is parsed in the server either.
        text = end == std::string::npos ? text + "\r\n\r\n" : text.substr(0, end);
        fuzz::require_one_meaning(http::parse_head(text, Limits{}));
    } catch (const ProblemException& refused) {
        fuzz::require(!refused.problem().detail.empty(), "a refusal says why");
    }
    return 0;
}
