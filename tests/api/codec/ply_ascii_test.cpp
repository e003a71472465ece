#include <gmock/gmock.h>

#include <cmath>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A file of points whose header goes on with `properties` and whose data is `rows`.
std::string ascii_points(int count, const std::string& properties, const std::string& rows) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
           "\nproperty float x\nproperty float y\nproperty float z\n" + properties +
           "end_header\n" + rows;
}

TEST(PlyAscii, ReadsPointsAndAttributes) {
    const Document document = read(ascii_points(2, "property uchar red\nproperty double time\n",
                                                "1 2 3 255 0.1\n-4.5 5e-1 6 0 1e300\n"));
    EXPECT_EQ(document.format, FileFormat::PlyAscii);
    EXPECT_EQ(document.shape.cloud.points.col(1), Eigen::Vector3d(-4.5, 0.5, 6));
    EXPECT_THAT(values_of(attribute_of(document, "red")), ElementsAre(255, 0));
    EXPECT_THAT(values_of(attribute_of(document, "time")), ElementsAre(0.1, 1e300));
    EXPECT_FALSE(document.double_positions);
}

TEST(PlyAscii, KeepsLargeDoublesExactly) {
    const Document document = read(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float64 x\nproperty float64 y\n"
        "property float64 z\nend_header\n1.23457 5648349.895035 1234567890.12345\n");
    EXPECT_EQ(document.shape.cloud.points(2, 0), 1234567890.12345);
    EXPECT_EQ(document.shape.cloud.points(1, 0), 5648349.895035);
    EXPECT_TRUE(document.double_positions);
}

TEST(PlyAscii, ReadsIntegerCoordinatesExactly) {
    const Document document = read(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\n"
        "property int z\nend_header\n2147483647 -2147483648 16777217\n");
    EXPECT_EQ(document.shape.cloud.points.col(0),
              Eigen::Vector3d(2147483647.0, -2147483648.0, 16777217.0));
    EXPECT_TRUE(document.double_positions);
}

TEST(PlyAscii, CoordinatesMayStandInAnyOrderBetweenOtherProperties) {
    const Document document = read(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar a\nproperty float z\n"
        "property float x\nproperty uchar b\nproperty float y\nend_header\n7 3 1 8 2\n");
    EXPECT_EQ(document.shape.cloud.points.col(0), Eigen::Vector3d(1, 2, 3));
    EXPECT_THAT(values_of(attribute_of(document, "b")), ElementsAre(8));
}

TEST(PlyAscii, ReadsBlanksTabsBlankLinesAndAMissingLastLineEnd) {
    const Document document = read(ascii_points(3, "", "  1\t 2   3 \n\n \t4 5 6\t\r\n\r\n7 8 9"));
    EXPECT_EQ(document.shape.cloud.points.col(0), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(document.shape.cloud.points.col(2), Eigen::Vector3d(7, 8, 9));
}

TEST(PlyAscii, ReadsRowsThatEndInCarriageReturns) {
    std::string text = ascii_points(2, "", "1 2 3\n4 5 6\n");
    std::replace(text.begin(), text.end(), '\n', '\r');
    EXPECT_EQ(read(text).shape.cloud.points.col(1), Eigen::Vector3d(4, 5, 6));
}

TEST(PlyAscii, IgnoresWhatFollowsTheLastRow) {
    EXPECT_EQ(read(ascii_points(1, "", "1 2 3\nanything\n")).shape.size(), 1U);
}

TEST(PlyAscii, ReadsListsInVertices) {
    const Document document =
        read(ascii_points(3, "property list ushort short n\nproperty uchar a\n",
                          "0 0 0 2 -1 300 9\n0 0 1 0 8\n0 1 0 1 5 7\n"));
    const Attribute& list = attribute_of(document, "n");
    EXPECT_THAT(list.list_offsets, ElementsAre(0, 2, 2, 3));
    EXPECT_THAT(values_of(list), ElementsAre(-1, 300, 5));
    EXPECT_EQ(list.count_type, ScalarType::UInt16);
    EXPECT_THAT(values_of(attribute_of(document, "a")), ElementsAre(9, 8, 7));
}

TEST(PlyAscii, TakesWholeNumbersWrittenAsDecimals) {
    const Document document =
        read(ascii_points(1, "property uchar red\nproperty int i\n", "0 0 0 255.0 -1e3\n"));
    EXPECT_THAT(values_of(attribute_of(document, "red")), ElementsAre(255));
    EXPECT_THAT(values_of(attribute_of(document, "i")), ElementsAre(-1000));
}

TEST(PlyAscii, ReadsTheEndsOfTheRangesOfFloats) {
    const Document document = read(
        ascii_points(1, "property float a\nproperty float b\nproperty double c\nproperty float d\n",
                     "+1 0 0 1e-46 1e39 4.9406564584124654e-324 3.4028235e38\n"));
    EXPECT_EQ(values_of(attribute_of(document, "a")).at(0), 0.0);
    EXPECT_TRUE(std::isinf(values_of(attribute_of(document, "b")).at(0)));
    EXPECT_EQ(values_of(attribute_of(document, "c")).at(0), 4.9406564584124654e-324);
    EXPECT_EQ(values_of(attribute_of(document, "d")).at(0), 3.4028234663852886e38);
}

TEST(PlyAscii, ReadsEverySpellingOfNotANumberAndInfinity) {
    const Document document =
        read(ascii_points(1,
                          "property float a\nproperty float b\nproperty double c\n"
                          "property float d\nproperty double e\nproperty float f\n",
                          "0 0 0 nan -inf Infinity 1.#QNAN -1.#INF00 +inf\n"));
    const auto value = [&](const char* name) { return values_of(attribute_of(document, name))[0]; };
    EXPECT_TRUE(std::isnan(value("a")));
    EXPECT_EQ(value("b"), -HUGE_VAL);
    EXPECT_EQ(value("c"), HUGE_VAL);
    EXPECT_TRUE(std::isnan(value("d")));
    EXPECT_EQ(value("e"), -HUGE_VAL);
    EXPECT_EQ(value("f"), HUGE_VAL);
}

struct BadRows {
    std::string name;
    int count;
    std::string properties;
    std::string rows;
    std::string said;
};

void PrintTo(const BadRows& rows, std::ostream* out) { *out << rows.name; }

class PlyAsciiMistake : public testing::TestWithParam<BadRows> {};

TEST_P(PlyAsciiMistake, IsRefusedWithItsLine) {
    const BadRows& bad = GetParam();
    const auto error = refusal(ascii_points(bad.count, bad.properties, bad.rows));
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr(bad.said));
    EXPECT_NE(error->code(), ErrorCode::UnsupportedFormat);
}

INSTANTIATE_TEST_SUITE_P(
    Rows, PlyAsciiMistake,
    testing::Values(
        BadRows{"FractionForAnInteger", 1, "property int i\n", "0 0 0 3.3\n", "line 9"},
        BadRows{"TooLargeForItsType", 1, "property uchar i\n", "0 0 0 256\n",
                "'256' is not a value of type uchar"},
        BadRows{"NegativeForUnsigned", 1, "property uint i\n", "0 0 0 -1\n", "type uint"},
        BadRows{"NanForAnInteger", 1, "property int i\n", "0 0 0 nan\n", "type int"},
        BadRows{"Word", 1, "", "0 zero 0\n",
                "'zero' is not a value of type float for property 'y'"},
        BadRows{"DecimalComma", 1, "", "0 1,5 0\n", "'1,5'"},
        BadRows{"Hexadecimal", 1, "", "0 0x10 0\n", "'0x10'"},
        BadRows{"TwoSigns", 1, "", "0 +-1 0\n", "'+-1'"},
        BadRows{"TooFewValues", 2, "", "0 0\n0 0 0 0 0 0\n", "line 8 (row 0 of 2"},
        BadRows{"TooManyValues", 1, "", "0 0 0 0\n", "more values than the 3 properties"},
        BadRows{"RowMissing", 2, "", "0 0 0            \n", "file ends before this row"},
        BadRows{"RowMissingInAShortFile", 2, "", "0 0 0\n", "promises 2 rows"},
        BadRows{"EndsInsideARow", 1, "", "0 0     ", "line ends before property 'z'"},
        BadRows{"ListTooShort", 1, "property list uchar int l\n", "0 0 0 3 1 2\n     ",
                "line ends"},
        BadRows{"ListTooLong", 1, "property list uchar int l\n", "0 0 0 1 1 2\n", "more values"},
        BadRows{"ListLengthNegative", 1, "property list char int l\n", "0 0 0 -1\n",
                "negative length -1"},
        BadRows{"ListLengthOverItsType", 1, "property list uchar int l\n", "0 0 0 300\n",
                "type uchar"},
        BadRows{"ListLengthOverTheLimit", 1, "property list int int l\n", "0 0 0 65537\n", "65536"},
        BadRows{"ListLongerThanTheFile", 1, "property list int int l\n", "0 0 0 60000 1\n",
                "bytes are left"},
        BadRows{"NulByte", 1, "", std::string("0 0 \0\n", 6), "'\\x00'"}),
    [](const auto& test) { return test.param.name; });

TEST(PlyAscii, NonFinitePointsAreDroppedAndCounted) {
    const Document document = read(ascii_points(4, "property uchar id\nproperty list uchar int l\n",
                                                "0 0 nan 1 1 10\n1 0 0 2 2 20 21\n"
                                                "inf 0 0 3 0\n0 1 0 4 1 40\n"));
    EXPECT_EQ(document.shape.size(), 2U);
    EXPECT_EQ(document.dropped_points, 2U);
    ASSERT_TRUE(has_warning(document.warnings, "non-finite-points-dropped"));
    EXPECT_THAT(document.warnings[0].detail, HasSubstr("2 of 4"));
    EXPECT_THAT(values_of(attribute_of(document, "id")), ElementsAre(2, 4));
    EXPECT_THAT(values_of(attribute_of(document, "l")), ElementsAre(20, 21, 40));
    EXPECT_THAT(attribute_of(document, "l").list_offsets, ElementsAre(0, 2, 3));
}

TEST(PlyAscii, FileWithOnlyNonFinitePointsIsRefused) {
    const auto error = refusal(ascii_points(2, "", "nan 0 0\n0 inf 0\n"));
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::MalformedFile);
    EXPECT_THAT(error->what(), HasSubstr("all 2 points"));
}

TEST(PlyAscii, FileWithoutPointsIsAnEmptyDocument) {
    const Document document = read(ascii_points(0, "property float nx\n", ""));
    EXPECT_EQ(document.shape.size(), 0U);
    EXPECT_EQ(document.dropped_points, 0U);
    EXPECT_EQ(attribute_of(document, "nx").rows(), 0U);
}

}  // namespace
}  // namespace lpf
