// Any bytes as the value of a header field, Range above all: what is sent lies inside what there
// is, and no value breaks out of the line that it is answered in.

#include <array>

#include "api/http_text.h"
#include "tests/fuzz/target.h"

namespace lpf::fuzz {
namespace {

void try_range(std::string_view value, std::uint64_t size) {
    const ByteRange range = parse_range(value, size);
    if (range.kind == ByteRange::Kind::Part) {
        require(range.first <= range.last && range.last < size, "a range lies inside the bytes");
    }
    if (range.kind != ByteRange::Kind::Whole) {
        require(content_range(range, size).starts_with("bytes "), "a range is answered in bytes");
    }
}

void try_other_fields(std::string_view value) {
    const auto wait = prefer_wait(value, 60);
    require(!wait || *wait <= 60, "a wait is bounded");
    (void)prefers_async(value);
    constexpr std::array<std::string_view, 3> kOffers{"application/json", "text/html", "a/b"};
    const auto offer = best_offer(value, kOffers);
    require(!offer || *offer < kOffers.size(), "what is chosen was offered");
    (void)bare_media_type(value);
    (void)header_parameter(value, "boundary");
    (void)etag_matches(value, "\"a\"", true);
    (void)parse_number(value);
    const std::string disposition = content_disposition(value);
    require(disposition.find_first_of("\r\n") == std::string::npos, "a disposition is one line");
}

}  // namespace

std::vector<std::string> seeds() {
    return {"bytes=0-99",
            "bytes=-5",
            "bytes=7-",
            "bytes=0-0,5-9",
            "bytes=18446744073709551615-18446744073709551616",
            "wait=10, respond-async",
            "text/html;q=0.5, application/json; q=1, */*;q=0",
            "multipart/form-data; boundary=\"a b\"; x=y",
            "W/\"a\", \"b\", *",
            "scan \"1\"\xc3\xa9/../x.ply"};
}

}  // namespace lpf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lpf::fuzz;
    const std::string_view value = text_of(data, size);
    for (const std::uint64_t bytes : {0ULL, 1ULL, 10ULL, 1ULL << 40U, ~0ULL}) {
        try_range(value, bytes);
    }
    try_other_fields(value);
    return 0;
}
