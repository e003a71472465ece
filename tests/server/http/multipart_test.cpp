#include "server/http/multipart.h"

#include <gtest/gtest.h>

#include <vector>

#include "api/problem.h"

namespace lpf::http {
namespace {

struct Received {
    Part head;
    std::string data;
};

/// A form taken apart, given in pieces of `step` bytes.
struct Split {
    std::vector<Received> parts;
    bool finished = false;
    std::string mistake;  ///< why it was refused; empty if it was not
};

Split split(const std::string& body, std::size_t step, const std::string& boundary = "b",
            const MultipartLimits& limits = {}) {
    Split out;
    MultipartSplitter splitter(
        boundary, limits,
        [&](const Part& part) {
            out.parts.push_back({part, ""});
            return true;
        },
        [&](std::string_view bytes) {
            out.parts.back().data += bytes;
            return true;
        });
    try {
        for (std::size_t i = 0; i < body.size(); i += step)
            splitter.add(std::string_view(body).substr(i, step));
    } catch (const ProblemException& error) {
        EXPECT_EQ(error.problem().status(), 400);
        out.mistake = error.what();
    }
    out.finished = splitter.finished();
    return out;
}

std::string part(const std::string& head, const std::string& data) {
    return "--b\r\n" + head + "\r\n\r\n" + data + "\r\n";
}

const std::string kName = "Content-Disposition: form-data; name=\"n\"";

class InPieces : public testing::TestWithParam<std::size_t> {};

TEST_P(InPieces, DataHoldsWhatLooksLikeABoundaryButIsNone) {
    const std::string tricky = "\r\n--a\r\n-\r\n--\r\r\n-b--b\n--b\r\n\r\r\n";
    const auto out = split("preamble\r\n" + part(kName, tricky) + part(kName, "") + "--b \t\r\n" +
                               kName + "\r\n\r\nx\r\n--b--\r\nepilogue",
                           GetParam());
    EXPECT_EQ(out.mistake, "");
    ASSERT_EQ(out.parts.size(), 3U);
    EXPECT_EQ(out.parts[0].data, tricky);
    EXPECT_EQ(out.parts[1].data, "");
    EXPECT_EQ(out.parts[2].data, "x");
    EXPECT_TRUE(out.finished);
}

TEST_P(InPieces, EveryByteOfAFileIsKept) {
    std::string data;
    for (int i = 0; i < 3000; ++i) data += static_cast<char>(i * 7);
    const auto out = split(part(kName, data) + "--b--", GetParam());
    ASSERT_EQ(out.parts.size(), 1U);
    EXPECT_EQ(out.parts[0].data, data);
    EXPECT_TRUE(out.finished);
}

TEST_P(InPieces, AFormThatIsCutIsNotFinished) {
    const std::string whole = part(kName, "data") + "--b--";
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(split(whole.substr(0, length), GetParam()).finished) << length;
}

INSTANTIATE_TEST_SUITE_P(Steps, InPieces, testing::Values(1, 2, 3, 7, 64, 100'000));

struct Disposition {
    std::string text;
    std::string name;
    std::string filename;
};

TEST(Multipart, ParametersComeInAnyOrderWithOrWithoutQuotes) {
    for (const Disposition& wanted : {
             Disposition{"form-data; name=\"file\"; filename=\"a.ply\"", "file", "a.ply"},
             Disposition{"form-data; filename=\"a.ply\"; name=\"file\"", "file", "a.ply"},
             Disposition{"form-data; name=file; filename=a.ply", "file", "a.ply"},
             Disposition{"Form-Data;name=file ;filename=a.ply", "file", "a.ply"},
             Disposition{"form-data; NAME=file; FileName=a.ply", "file", "a.ply"},
             Disposition{"form-data; name=\"a;b=\\\"c\"; filename=\"\"", "a;b=\"c", ""},
             Disposition{"form-data; filename*=UTF-8''na%C3%AFve.ply; name=file", "file",
                         "na\xC3\xAFve.ply"},
             Disposition{"form-data; name=file; filename=x; filename*=utf-8'en'a%20b", "file",
                         "a b"},
         }) {
        const Part part = parse_part_head("content-disposition:" + wanted.text + "\r\n", {});
        EXPECT_EQ(part.name, wanted.name) << wanted.text;
        EXPECT_EQ(part.filename, wanted.filename) << wanted.text;
    }
}

TEST(Multipart, HeadersBesideTheDispositionAreRead) {
    const Part part = parse_part_head(
        "Content-Type: application/ply\r\nX-Other: 1\r\nContent-Transfer-Encoding: BINARY\r\n" +
            kName + "\r\n",
        {});
    EXPECT_EQ(part.name, "n");
    EXPECT_EQ(part.content_type, "application/ply");
}

TEST(Multipart, WhatIsNoFormIsRefused) {
    const std::string end = "--b--";
    for (const std::string& body : {
             part("Content-Type: text/plain", "x") + end,
             part("Content-Disposition: form-data; filename=\"a\"", "x") + end,
             part("Content-Disposition: attachment; name=\"n\"", "x") + end,
             part("Content-Disposition: form-data; name=a; filename*=latin1''a", "x") + end,
             part("Content-Disposition: form-data; name=a; filename*=UTF-8''%4", "x") + end,
             part("Content-Disposition: form-data;\r\n name=\"n\"", "x") + end,
             part("Content-Disposition : form-data; name=\"n\"", "x") + end,
             part(kName + "\r\n" + kName, "x") + end,
             part(kName + "\r\nContent-Transfer-Encoding: base64", "x") + end,
             part(kName + "\r\nA: " + std::string(20'000, 'a'), "x") + end,
             part(kName + std::string("\r\nA: \0b", 7), "x") + end,
             "--b\r\n\r\nx\r\n" + end,
             "--b\n" + kName + "\n\nx\n--b--",
             "--bc\r\n" + kName + "\r\n\r\nx\r\n" + end,
             part(kName, "x") + "--b-\r\n",
             std::string(100'000, 'x'),
         }) {
        EXPECT_NE(split(body, 1000).mistake, "") << body.substr(0, 100);
    }
}

TEST(Multipart, PartsHeadersAndPaddingAreCounted) {
    std::string many;
    for (int i = 0; i < 4; ++i) many += part(kName, "");
    EXPECT_EQ(split(many + "--b--", 100, "b", {.parts = 4}).mistake, "");
    EXPECT_NE(split(many + "--b--", 100, "b", {.parts = 3}).mistake, "");
    const std::string heads = kName + "\r\nA: 1\r\nB: 2";
    EXPECT_EQ(split(part(heads, ""), 100, "b", {.part_head_fields = 3}).mistake, "");
    EXPECT_NE(split(part(heads, ""), 100, "b", {.part_head_fields = 2}).mistake, "");
    const std::string padded = part(kName, "") + "--b--" + std::string(1000, 'x');
    EXPECT_EQ(split(padded, 100, "b", {.padding_bytes = 1000}).mistake, "");
    EXPECT_NE(split(padded, 100, "b", {.padding_bytes = 900}).mistake, "");
}

TEST(Multipart, ASinkThatHasEnoughStopsTheReading) {
    int pieces = 0;
    MultipartSplitter splitter(
        "b", {}, [](const Part&) { return true; }, [&](std::string_view) { return ++pieces < 2; });
    EXPECT_TRUE(splitter.add(part(kName, "1")));
    EXPECT_FALSE(splitter.add(part(kName, "2") + part(kName, "3")));
    EXPECT_FALSE(splitter.add("more"));
    EXPECT_EQ(pieces, 2);
}

TEST(Multipart, TheBoundaryIsThatOfTheContentType) {
    EXPECT_EQ(multipart_boundary("multipart/form-data; boundary=abc"), "abc");
    EXPECT_EQ(multipart_boundary("multipart/form-data; charset=x; BOUNDARY=\"a b:c\""), "a b:c");
    for (const std::string& wrong :
         {std::string("multipart/form-data"), std::string("multipart/form-data; boundary="),
          std::string("multipart/form-data; boundary=\"a \""),
          std::string("multipart/form-data; boundary=\"a<b\""),
          "multipart/form-data; boundary=" + std::string(71, 'a')}) {
        EXPECT_THROW((void)multipart_boundary(wrong), ProblemException) << wrong;
    }
}

}  // namespace
}  // namespace lpf::http
