#include "api/http_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace lpf {
namespace {

using Kind = ByteRange::Kind;

constexpr std::string_view kOffers[] = {"application/ply", "application/vnd.draco", "text/plain"};

TEST(PreferWait, ReadsSeconds) {
    EXPECT_EQ(prefer_wait("wait=10", 60), 10U);
    EXPECT_EQ(prefer_wait("wait=0", 60), 0U);
    EXPECT_EQ(prefer_wait("  Wait = \"7\" ", 60), 7U);
    EXPECT_EQ(prefer_wait("respond-async, wait=5; x=1, handling=lenient", 60), 5U);
}

TEST(PreferWait, IsCutAtTheMaximum) {
    EXPECT_EQ(prefer_wait("wait=61", 60), 60U);
    EXPECT_EQ(prefer_wait("wait=99999999999999999999999999", 60), 60U);
}

TEST(PreferWait, PassesOverWhatItDoesNotUnderstand) {
    for (const char* header : {"", "wait", "wait=", "wait=-1", "wait=1.5", "wait=x", "await=3",
                               "respond-async", "x=\"wait=3\""}) {
        EXPECT_FALSE(prefer_wait(header, 60)) << header;
    }
}

TEST(PrefersAsync, FindsTheToken) {
    EXPECT_TRUE(prefers_async("wait=3, Respond-Async"));
    EXPECT_FALSE(prefers_async("wait=3"));
}

TEST(BestOffer, WithoutWishesTheFavouriteIsSent) {
    EXPECT_EQ(best_offer("", kOffers), 0U);
    EXPECT_EQ(best_offer("*/*", kOffers), 0U);
    EXPECT_EQ(best_offer("nonsense", kOffers), 0U);
    EXPECT_EQ(best_offer("application/ply;q=7", kOffers), 0U);
}

TEST(BestOffer, QualityDecides) {
    EXPECT_EQ(best_offer("application/vnd.draco", kOffers), 1U);
    EXPECT_EQ(best_offer("application/ply;q=0.5, application/vnd.draco;q=0.8", kOffers), 1U);
    EXPECT_EQ(best_offer("application/*;q=0.2, TEXT/*", kOffers), 2U);
    EXPECT_EQ(best_offer("text/html, */*;q=0.1", kOffers), 0U);
}

TEST(BestOffer, TheMostExactRangeCounts) {
    EXPECT_EQ(best_offer("application/ply;q=0, */*", kOffers), 1U);
    EXPECT_EQ(best_offer("*/*, application/*;q=0", kOffers), 2U);
}

TEST(BestOffer, NothingMayBeAcceptable) {
    EXPECT_FALSE(best_offer("image/png", kOffers));
    EXPECT_FALSE(best_offer("*/*;q=0", kOffers));
    EXPECT_FALSE(best_offer("", {}));
}

TEST(BareMediaType, DropsParametersAndCase) {
    EXPECT_EQ(bare_media_type("Application/JSON; charset=utf-8"), "application/json");
    EXPECT_EQ(bare_media_type(" text/plain "), "text/plain");
    EXPECT_EQ(bare_media_type(""), "");
}

TEST(HeaderParameter, FindsPlainAndQuotedValues) {
    const std::string_view header = R"(multipart/form-data; Boundary="a;\"b\""; x=y)";
    EXPECT_EQ(header_parameter(header, "boundary"), "a;\"b\"");
    EXPECT_EQ(header_parameter(header, "X"), "y");
    EXPECT_FALSE(header_parameter(header, "z"));
    EXPECT_FALSE(header_parameter("", "boundary"));
}

TEST(Range, ReadsTheThreeForms) {
    EXPECT_EQ(parse_range("bytes=0-99", 1000), (ByteRange{Kind::Part, 0, 99}));
    EXPECT_EQ(parse_range("bytes=900-", 1000), (ByteRange{Kind::Part, 900, 999}));
    EXPECT_EQ(parse_range("bytes=-10", 1000), (ByteRange{Kind::Part, 990, 999}));
    EXPECT_EQ(parse_range("Bytes= 5-5 ", 1000), (ByteRange{Kind::Part, 5, 5}));
}

TEST(Range, IsCutAtTheEnd) {
    EXPECT_EQ(parse_range("bytes=990-5000", 1000), (ByteRange{Kind::Part, 990, 999}));
    EXPECT_EQ(parse_range("bytes=-5000", 1000), (ByteRange{Kind::Part, 0, 999}));
    EXPECT_EQ(parse_range("bytes=0-18446744073709551615", 10), (ByteRange{Kind::Part, 0, 9}));
}

TEST(Range, BehindTheEndIsUnsatisfiable) {
    for (const char* header : {"bytes=1000-", "bytes=1000-2000", "bytes=-0"}) {
        EXPECT_EQ(parse_range(header, 1000).kind, Kind::Unsatisfiable) << header;
    }
    EXPECT_EQ(parse_range("bytes=0-", 0).kind, Kind::Unsatisfiable);
    EXPECT_EQ(parse_range("bytes=-5", 0).kind, Kind::Unsatisfiable);
}

TEST(Range, SeveralAndMalformedOnesAreIgnored) {
    for (const char* header :
         {"", "bytes=0-1,5-6", "lines=0-5", "bytes=", "bytes=-", "bytes=5-2", "bytes=a-b",
          "bytes=1-2-3", "bytes=--5", "bytes=+1-2", "bytes=99999999999999999999-", "0-5"}) {
        EXPECT_EQ(parse_range(header, 1000), ByteRange{}) << header;
    }
}

TEST(Range, ContentRangeNamesBytesAndSize) {
    EXPECT_EQ(content_range(parse_range("bytes=0-99", 1234), 1234), "bytes 0-99/1234");
    EXPECT_EQ(content_range(parse_range("bytes=9999-", 1234), 1234), "bytes */1234");
}

TEST(ETag, ListIsSearched) {
    EXPECT_TRUE(etag_matches("\"a\", \"b\"", "\"b\"", false));
    EXPECT_TRUE(etag_matches("*", "\"b\"", false));
    EXPECT_TRUE(etag_matches("\"a,b\"", "\"a,b\"", false));
    EXPECT_FALSE(etag_matches("\"a\"", "\"b\"", true));
    EXPECT_FALSE(etag_matches("", "\"b\"", true));
}

TEST(ETag, WeakTagsMatchWeaklyOnly) {
    EXPECT_TRUE(etag_matches("W/\"a\"", "\"a\"", true));
    EXPECT_FALSE(etag_matches("W/\"a\"", "\"a\"", false));
    EXPECT_FALSE(etag_matches("W/\"a\"", "W/\"a\"", false));
}

TEST(ContentDisposition, NamesAreMadeHarmless) {
    EXPECT_EQ(content_disposition("points.ply"), "attachment; filename=\"points.ply\"");
    EXPECT_EQ(content_disposition("a\"\r\nb/..\\c"), "attachment; filename=\"a___b_.._c\"");
    EXPECT_EQ(content_disposition("b\xC3\xA4.ply"),
              "attachment; filename=\"b__.ply\"; filename*=UTF-8''b%C3%A4.ply");
}

TEST(ParseNumber, TakesDigitsOnly) {
    EXPECT_EQ(parse_number("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
    for (const char* text : {"", "-1", "+1", " 1", "1 ", "1e3", "18446744073709551616"}) {
        EXPECT_FALSE(parse_number(text)) << text;
    }
}

}  // namespace
}  // namespace lpf
