#include "api/codec/ply_header.h"

#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::string_view kStart = "ply\nformat ascii 1.0\n";
constexpr std::string_view kVertex =
    "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";

std::string with_start(std::string_view rest) { return std::string(kStart) + std::string(rest); }

struct BadHeader {
    std::string name;
    std::string text;
    std::string said;  ///< a part of the message
};

void PrintTo(const BadHeader& header, std::ostream* out) { *out << header.name; }

class PlyHeaderMistake : public testing::TestWithParam<BadHeader> {};

TEST_P(PlyHeaderMistake, IsRefusedAndTheMessageNamesIt) {
    const auto error = refusal(GetParam().text);
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->code(), AnyOf(ErrorCode::MalformedFile, ErrorCode::LimitExceeded));
    EXPECT_THAT(error->what(), HasSubstr(GetParam().said));
}

std::string elements(int n) {
    std::string text = with_start(kVertex);
    for (int i = 1; i < n; ++i) text += "element e" + std::to_string(i) + " 0\nproperty int a\n";
    return text + "end_header\n0 0 0\n";
}

std::string properties(int n) {
    std::string text = with_start(kVertex);
    for (int i = 3; i < n; ++i) text += "property int p" + std::to_string(i) + "\n";
    text += "end_header\n";
    for (int i = 0; i < n; ++i) text += "0 ";
    return text;
}

INSTANTIATE_TEST_SUITE_P(
    Text, PlyHeaderMistake,
    testing::Values(
        BadHeader{"MagicWithMore", "plyy\nformat ascii 1.0\nend_header\n", "line 1: it is 'plyy'"},
        BadHeader{"TextAfterMagic", "ply 1.0\nformat ascii 1.0\nend_header\n", "line 1"},
        BadHeader{"EmptySecondLine", "ply\n\nformat ascii 1.0\nend_header\n",
                  "line 2: it is empty"},
        BadHeader{"FormatWithoutKind", "ply\nformat 1.0\nend_header\n",
                  "needs a kind and a version"},
        BadHeader{"ElementBeforeFormat", "ply\nelement vertex 1\n", "line 2: found 'element'"},
        BadHeader{"UnknownKind", "ply\nformat asciii 1.0\nend_header\n", "'asciii'"},
        BadHeader{"UnknownVersion", "ply\nformat ascii 2.0\nend_header\n", "version '2.0'"},
        BadHeader{"TwoFormats", with_start("format ascii 1.0\nend_header\n"), "second 'format'"},
        BadHeader{"NoFormat", "ply\nend_header\n", "before 'format'"},
        BadHeader{"OnlyComments", "ply\ncomment a\n", "without 'end_header'"},
        BadHeader{"EndsEarly", with_start(kVertex), "without 'end_header'"},
        BadHeader{"ElementWithoutCount", with_start("element vertex\nend_header\n"), "line 3"},
        BadHeader{"CountIsAWord", with_start("element vertex x\nend_header\n"), "count 'x'"},
        BadHeader{"CountIsNegative", with_start("element vertex -1\nend_header\n"), "count '-1'"},
        BadHeader{"CountIsAFraction", with_start("element vertex 1.5\nend_header\n"), "'1.5'"},
        BadHeader{"CountIsTwoToThe64",
                  with_start("element vertex 18446744073709551616\nend_header\n"), "2^64 - 1"},
        BadHeader{"TextAfterCount", with_start("element vertex 1 2\nend_header\n"), "line 3"},
        BadHeader{"PropertyWithoutName", with_start("element vertex 1\nproperty float\n"),
                  "line 4"},
        BadHeader{"ListIncomplete", with_start("element face 1\nproperty list float\n"),
                  "two types and one name"},
        BadHeader{"UnknownType", with_start("element vertex 1\nproperty floatt x\n"), "'floatt'"},
        BadHeader{"TwoNames", with_start("element vertex 1\nproperty float x y\n"), "line 4"},
        BadHeader{"UnknownCountType", with_start("element face 1\nproperty list ucharr int i\n"),
                  "'ucharr'"},
        BadHeader{"CountTypeFloat", with_start("element face 1\nproperty list float int i\n"),
                  "cannot be counted in 'float'"},
        BadHeader{"CountTypeDouble", with_start("element face 1\nproperty list float64 int i\n"),
                  "cannot be counted in 'float64'"},
        BadHeader{"TextAfterEnd", with_start(kVertex) + "end_header xxx\n0 0 0\n", "'xxx'"},
        BadHeader{"PropertyFirst", with_start("property float x\n"), "before the first 'element'"},
        BadHeader{"UnknownKeyword", with_start("elephant vertex 1\n"), "'elephant'"},
        BadHeader{"TwoVertexElements", with_start(kVertex) + "element vertex 1\n",
                  "second element 'vertex'"},
        BadHeader{"PropertyTwice", with_start(kVertex) + "property double x\n",
                  "second property 'x'"},
        BadHeader{"ElementWithoutProperty", with_start("element vertex 5\nend_header\n"),
                  "no property"},
        BadHeader{"NulByte", with_start(std::string("comment a\0b\n", 12)), "NUL byte"},
        BadHeader{"TooManyElements", elements(17), "more than 16 elements"},
        BadHeader{"TooManyProperties", properties(257), "more than 256 properties"},
        BadHeader{"NoVertex", with_start("element point 1\nproperty int a\nend_header\n1\n"),
                  "no element 'vertex'"},
        BadHeader{"NoZ",
                  with_start("element vertex 1\nproperty int x\nproperty int y\nend_header\n1 2\n"),
                  "no property 'z'"},
        BadHeader{"ListAsCoordinate",
                  with_start("element vertex 1\nproperty list uchar float x\nproperty int y\n"
                             "property int z\nend_header\n1 0 0 0\n"),
                  "'x' of element 'vertex' is a list"}),
    [](const auto& test) { return test.param.name; });

TEST(PlyHeader, AtItsLimitsIsAccepted) {
    EXPECT_EQ(refusal(elements(16)), std::nullopt);
    EXPECT_EQ(refusal(properties(256)), std::nullopt);
}

TEST(PlyHeader, LongerThan64KiBIsRefusedWithoutReadingOn) {
    const std::string one_line = "ply\nformat ascii 1.0\ncomment " + std::string(1 << 20, 'a');
    std::string many_lines = "ply\nformat ascii 1.0\n";
    for (int i = 0; i < 10000; ++i) many_lines += "comment abc\n";
    for (const std::string& text : {one_line, many_lines + "end_header\n"}) {
        const auto error = refusal(text);
        ASSERT_TRUE(error.has_value());
        EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
        EXPECT_THAT(error->what(), HasSubstr("65536"));
    }
}

TEST(PlyHeader, KeepsCommentsAndObjInfoWordForWord) {
    const PlyHeader header = parse_ply_header(
        bytes_of("ply\ncomment before\nformat ascii 1.0\ncomment\nobj_info a  b\ncomment  two\n"
                 "end_header\n"));
    EXPECT_THAT(header.comments, ElementsAre("before", "", " two"));
    EXPECT_THAT(header.obj_info, ElementsAre("a  b"));
}

TEST(PlyHeader, ReadsTabsRunsOfBlanksAndLeadingBlanks) {
    const PlyHeader header = parse_ply_header(
        bytes_of("ply \nformat\tascii   1.0 \n\t element \t vertex  3\n  property\tfloat\t x\t\n"
                 "end_header \n"));
    ASSERT_EQ(header.elements.size(), 1U);
    EXPECT_EQ(header.elements[0].count, 3U);
    EXPECT_EQ(header.elements[0].properties.at(0).name, "x");
}

TEST(PlyHeader, KnowsAllSixteenTypeNames) {
    const std::vector<std::pair<std::string, ScalarType>> names{
        {"char", ScalarType::Int8},      {"int8", ScalarType::Int8},
        {"uchar", ScalarType::UInt8},    {"uint8", ScalarType::UInt8},
        {"short", ScalarType::Int16},    {"int16", ScalarType::Int16},
        {"ushort", ScalarType::UInt16},  {"uint16", ScalarType::UInt16},
        {"int", ScalarType::Int32},      {"int32", ScalarType::Int32},
        {"uint", ScalarType::UInt32},    {"uint32", ScalarType::UInt32},
        {"float", ScalarType::Float32},  {"float32", ScalarType::Float32},
        {"double", ScalarType::Float64}, {"float64", ScalarType::Float64}};
    for (const auto& [name, type] : names) {
        const PlyHeader header = parse_ply_header(
            bytes_of(with_start("element e 1\nproperty " + name + " a\nend_header\n")));
        EXPECT_EQ(header.elements.at(0).properties.at(0).type, type) << name;
    }
}

struct LineEnds {
    std::string name;
    std::string inside;
    std::string last;  ///< behind end_header
};

class PlyLineEnds : public testing::TestWithParam<LineEnds> {};

/// The data begin with the bytes of both line ends, which must not be taken for the header's.
TEST_P(PlyLineEnds, LeaveTheFirstByteOfTheDataAlone) {
    for (const char first : {'\r', 'A'}) {
        std::string text;
        for (const char* line : {"ply", "format binary_little_endian 1.0", "element vertex 1",
                                 "property uchar x", "property uchar y", "property uchar z"}) {
            text += line + GetParam().inside;
        }
        text += "end_header" + GetParam().last;
        text += {first, '\n', '\r'};
        const Document document = read(text);
        ASSERT_EQ(document.shape.size(), 1U);
        EXPECT_EQ(document.shape.cloud.points(0, 0), first);
        EXPECT_EQ(document.shape.cloud.points(2, 0), '\r');
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PlyLineEnds,
                         testing::Values(LineEnds{"Lf", "\n", "\n"},
                                         LineEnds{"CrLf", "\r\n", "\r\n"},
                                         LineEnds{"Cr", "\r", "\r"},
                                         LineEnds{"LfThenCrLf", "\n", "\r\n"},
                                         LineEnds{"CrLfThenLf", "\r\n", "\n"}),
                         [](const auto& test) { return test.param.name; });

TEST(PlyHeader, OldMacFileMayBeginItsDataWithALineFeed) {
    const std::string text =
        "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\r"
        "property uchar y\rproperty uchar z\rend_header\r\n\x02\x03";
    EXPECT_EQ(read(text).shape.cloud.points.col(0), Eigen::Vector3d(10, 2, 3));
}

}  // namespace
}  // namespace lpf
