#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string header(bool big_endian, const std::string& elements) {
    return std::string("ply\nformat ") +
           (big_endian ? "binary_big_endian" : "binary_little_endian") + " 1.0\n" + elements +
           "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

class PlyBinary : public testing::TestWithParam<bool> {
protected:
    [[nodiscard]] bool big_endian() const { return GetParam(); }
};

TEST_P(PlyBinary, ReadsEveryTypeFromPackedRows) {
    std::string file =
        header(big_endian(), "element vertex 2\nproperty char a\n" + kXyz +
                                 "property ushort b\nproperty short c\nproperty uint d\n"
                                 "property int e\nproperty double f\nproperty uchar g\n");
    for (int row = 0; row < 2; ++row) {
        append(file, static_cast<std::int8_t>(-1 - row), big_endian());
        for (int axis = 0; axis < 3; ++axis) {
            append(file, static_cast<float>(10 * row + axis) + 0.5F, big_endian());
        }
        append(file, static_cast<std::uint16_t>(65000 + row), big_endian());
        append(file, static_cast<std::int16_t>(-300 - row), big_endian());
        append(file, 4000000000U + static_cast<unsigned>(row), big_endian());
        append(file, -70000 - row, big_endian());
        append(file, 0.1 + row, big_endian());
        append(file, static_cast<std::uint8_t>(200 + row), big_endian());
    }
    const Document document = read(file);
    EXPECT_EQ(document.shape.cloud.points.col(1), Eigen::Vector3d(10.5, 11.5, 12.5));
    const auto values = [&](const char* name) { return values_of(attribute_of(document, name)); };
    EXPECT_THAT(values("a"), ElementsAre(-1, -2));
    EXPECT_THAT(values("b"), ElementsAre(65000, 65001));
    EXPECT_THAT(values("c"), ElementsAre(-300, -301));
    EXPECT_THAT(values("d"), ElementsAre(4000000000.0, 4000000001.0));
    EXPECT_THAT(values("e"), ElementsAre(-70000, -70001));
    EXPECT_THAT(values("f"), ElementsAre(0.1, 1.1));
    EXPECT_THAT(values("g"), ElementsAre(200, 201));
}

TEST_P(PlyBinary, ReadsMoreRowsThanOneBlock) {
    constexpr int kRows = 5003;
    std::string file =
        header(big_endian(), "element vertex 5003\n" + kXyz + "property ushort id\n");
    for (int row = 0; row < kRows; ++row) {
        for (int axis = 0; axis < 3; ++axis) {
            append(file, static_cast<float>(row * (axis + 1)), big_endian());
        }
        append(file, static_cast<std::uint16_t>(row), big_endian());
    }
    const Document document = read(file);
    const std::vector<double> ids = values_of(attribute_of(document, "id"));
    for (int row = 0; row < kRows; ++row) {
        ASSERT_EQ(ids.at(static_cast<std::size_t>(row)), row);
        ASSERT_EQ(document.shape.cloud.points.col(row), Eigen::Vector3d(row, 2 * row, 3 * row));
    }
}

TEST_P(PlyBinary, WalksListsToReachTheVerticesBehindThem) {
    std::string file = header(big_endian(),
                              "element face 2\nproperty uchar a\n"
                              "property list ushort int vertex_index\nproperty double b\n"
                              "element vertex 4\n" +
                                  kXyz + "element extra 1\nproperty double offset\n");
    for (const std::vector<int>& face : {std::vector{0, 1, 2, 3}, std::vector{2, 1, 0}}) {
        append(file, static_cast<std::uint8_t>(face.size()), big_endian());
        append(file, static_cast<std::uint16_t>(face.size()), big_endian());
        for (const int vertex : face) append(file, vertex, big_endian());
        append(file, 0.25, big_endian());
    }
    for (int i = 0; i < 12; ++i) append(file, static_cast<float>(i), big_endian());
    append(file, 12.1, big_endian());
    file += "\n";  // one byte too many, as some writers leave
    const Document document = read(file);
    EXPECT_EQ(document.shape.size(), 4U);
    EXPECT_THAT(document.polygons.vertices, ElementsAre(0, 1, 2, 3, 2, 1, 0));
    ASSERT_EQ(document.face_attributes.size(), 2U);
    EXPECT_THAT(values_of(document.face_attributes[0]), ElementsAre(4, 3));
    EXPECT_THAT(values_of(document.face_attributes[1]), ElementsAre(0.25, 0.25));
    ASSERT_EQ(document.elements.size(), 1U);
    EXPECT_THAT(values_of(document.elements[0].attributes.at(0)), ElementsAre(12.1));
}

TEST_P(PlyBinary, RefusesANegativeListLength) {
    std::string file =
        header(big_endian(), "element vertex 1\n" + kXyz + "property list int char l\n");
    for (int i = 0; i < 3; ++i) append(file, 1.0F, big_endian());
    append(file, -2, big_endian());
    file += std::string(100, 'a');
    const auto error = refusal(file);
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("claims -2 values"));
}

TEST_P(PlyBinary, RefusesAListLengthOverTheLimit) {
    for (const std::uint32_t length : {65537U, 0x7fffffffU, 0xffffffffU}) {
        std::string file =
            header(big_endian(), "element vertex 1\n" + kXyz + "property list uint char l\n");
        for (int i = 0; i < 3; ++i) append(file, 1.0F, big_endian());
        append(file, length, big_endian());
        file += std::string(70000, 'a');
        const auto error = refusal(file);
        ASSERT_TRUE(error.has_value());
        EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
        EXPECT_THAT(error->what(), HasSubstr("the limit is 65536"));
    }
}

TEST_P(PlyBinary, NamesTheByteWhereAListIsCutOff) {
    std::string file =
        header(big_endian(), "element vertex 1\n" + kXyz + "property list uchar double l\n");
    for (int i = 0; i < 3; ++i) append(file, 1.0F, big_endian());
    append(file, std::uint8_t{2}, big_endian());
    append(file, 1.0, big_endian());
    const auto error = refusal(file);
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("ends at byte " + std::to_string(file.size())));
}

INSTANTIATE_TEST_SUITE_P(ByteOrder, PlyBinary, testing::Bool(), [](const auto& test) {
    return test.param ? "BigEndian" : "LittleEndian";
});

}  // namespace
}  // namespace lpf
