#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

class PlyRoundTrip : public testing::TestWithParam<FileFormat> {
protected:
    [[nodiscard]] EncodeOptions options() const {
        EncodeOptions result;
        result.format = GetParam();
        return result;
    }
};

TEST_P(PlyRoundTrip, KeepsEveryTypeExactly) {
    const Document document = points_with_every_type();
    std::vector<Warning> lost;
    expect_same(read(written(document, options(), &lost)), document);
    EXPECT_TRUE(lost.empty());
}

TEST_P(PlyRoundTrip, KeepsPolygonsListsElementsAndComments) {
    const Document document = mesh_with_everything();
    std::vector<Warning> lost;
    const Document again = read(written(document, options(), &lost));
    expect_same(again, document);
    EXPECT_EQ(again.format, GetParam());
    EXPECT_TRUE(lost.empty());
}

TEST_P(PlyRoundTrip, KeepsATriangleMesh) {
    Document document = mesh_with_everything();
    document.polygons = {};
    document.face_attributes = {column<float>("area", ScalarType::Float32, {1, 2, 3})};
    const Document again = read(written(document, options()));
    expect_same(again, document);
    EXPECT_TRUE(again.polygons.empty());
}

TEST_P(PlyRoundTrip, KeepsDoublePositionsWhereAsked) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 50) * 5648349.895035;
    EncodeOptions exact = options();
    exact.double_positions = true;
    const Document again = read(written(document, exact));
    EXPECT_EQ(again.shape.cloud.points, document.shape.cloud.points);
    EXPECT_TRUE(again.double_positions);
    EXPECT_FALSE(read(written(document, options())).double_positions);
}

TEST_P(PlyRoundTrip, RoundsToFloatWithoutDoublePositions) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 50);
    const Document again = read(written(document, options()));
    EXPECT_EQ(again.shape.cloud.points, document.shape.cloud.points.cast<float>().cast<double>());
}

TEST_P(PlyRoundTrip, KeepsAnEmptyDocument) {
    Document document;
    document.shape.cloud.attributes = {column<float>("nx", ScalarType::Float32, {})};
    const Document again = read(written(document, options()));
    EXPECT_EQ(again.shape.size(), 0U);
    EXPECT_EQ(attribute_of(again, "nx").rows(), 0U);
}

TEST_P(PlyRoundTrip, KeepsManyRowsInOrder) {
    constexpr int kRows = 3001;
    Document document;
    document.shape.cloud.points.resize(3, kRows);
    std::vector<std::uint16_t> ids;
    for (int i = 0; i < kRows; ++i) {
        document.shape.cloud.points.col(i) << i, -i, 0.5 * i;
        ids.push_back(static_cast<std::uint16_t>(i));
    }
    document.shape.cloud.attributes = {column("id", ScalarType::UInt16, ids)};
    expect_same(read(written(document, options())), document);
}

TEST_P(PlyRoundTrip, KeepsListsLongerThan255) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 2);
    Attribute list = column("l", ScalarType::Int16, std::vector<std::int16_t>(40001, 5));
    list.list_offsets = {0, 40000, 40001};
    document.shape.cloud.attributes = {list};
    const Document again = read(written(document, options()));
    EXPECT_EQ(attribute_of(again, "l").list_offsets, list.list_offsets);
    EXPECT_EQ(attribute_of(again, "l").count_type, ScalarType::UInt16);
}

TEST_P(PlyRoundTrip, KeepsNotANumberInAttributes) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 3);
    document.shape.cloud.attributes = {
        column<float>("f", ScalarType::Float32, {NAN, INFINITY, -INFINITY})};
    const Document again = read(written(document, options()));
    const std::vector<double> values = values_of(attribute_of(again, "f"));
    EXPECT_TRUE(std::isnan(values[0]));
    EXPECT_EQ(values[1], HUGE_VAL);
    EXPECT_EQ(values[2], -HUGE_VAL);
    EXPECT_EQ(again.dropped_points, 0U);
}

INSTANTIATE_TEST_SUITE_P(Formats, PlyRoundTrip,
                         testing::Values(FileFormat::PlyBinary, FileFormat::PlyAscii,
                                         FileFormat::PlyBigEndian),
                         [](const auto& test) {
                             std::string name(format_name(test.param));
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace lpf
