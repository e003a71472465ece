#include "api/codec/draco.h"

#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

EncodeOptions draco(int bits = 0, bool double_positions = false) {
    EncodeOptions options;
    options.format = FileFormat::Draco;
    options.quantization_bits = bits;
    options.double_positions = double_positions;
    return options;
}

/// Decoding in this process and in the helper must agree.
class DracoRoundTrip : public testing::TestWithParam<bool> {
protected:
    [[nodiscard]] Document again(const std::string& file) const {
        DecodeLimits limits;
        if (!GetParam()) limits.decode_helper.clear();
        return read(file, limits);
    }
};

TEST_P(DracoRoundTrip, KeepsEveryTypeExactly) {
    const Document document = points_with_every_type();
    const Document result = again(written(document, draco()));
    expect_same(result, document);
    EXPECT_EQ(result.format, FileFormat::Draco);
}

TEST_P(DracoRoundTrip, KeepsNamedAttributesInOrder) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 100).cast<float>().cast<double>();
    std::vector<std::uint8_t> bytes(100);
    std::vector<float> floats(100);
    for (std::size_t i = 0; i < 100; ++i) {
        bytes[i] = static_cast<std::uint8_t>(2 * i + 1);
        floats[i] = 0.1F * static_cast<float>(i);
    }
    for (const char* name : {"nx", "ny", "nz", "intensity", "s", "t"}) {
        document.shape.cloud.attributes.push_back(column(name, ScalarType::Float32, floats));
    }
    for (const char* name : {"red", "green", "blue", "alpha", "classification"}) {
        document.shape.cloud.attributes.push_back(column(name, ScalarType::UInt8, bytes));
    }
    std::vector<Warning> lost;
    expect_same(again(written(document, draco(), &lost)), document);
    EXPECT_TRUE(lost.empty());
}

TEST_P(DracoRoundTrip, KeepsTrianglesAndTheirOrder) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 30).cast<float>().cast<double>();
    document.shape.triangles.resize(3, 28);
    for (std::uint32_t f = 0; f < 28; ++f) {
        document.shape.triangles.col(f) << 29 - f, f, f + 1;
    }
    document.shape.cloud.attributes = {
        column("q", ScalarType::UInt16, std::vector<std::uint16_t>(30, 500))};
    expect_same(again(written(document, draco())), document);
}

TEST_P(DracoRoundTrip, KeepsDuplicatePointsAndTheirOrder) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 20);
    document.shape.cloud.points(0, 7) = 1;
    std::vector<std::int32_t> ids(20);
    for (std::size_t i = 0; i < 20; ++i) ids[i] = static_cast<std::int32_t>(i % 3);
    document.shape.cloud.attributes = {column("id", ScalarType::Int32, ids)};
    expect_same(again(written(document, draco())), document);
}

TEST_P(DracoRoundTrip, KeepsDoublePositionsWhereAsked) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 10) * 5648349.895035;
    document.double_positions = true;
    std::vector<Warning> lost;
    const Document result = again(written(document, draco(0, true), &lost));
    EXPECT_EQ(result.shape.cloud.points, document.shape.cloud.points);
    EXPECT_TRUE(result.double_positions);
    EXPECT_TRUE(lost.empty());
}

TEST_P(DracoRoundTrip, KeepsComments) {
    Document document = points_with_every_type();
    document.comments = {"first", "second line"};
    document.obj_info = {"scanner 7"};
    EncodeOptions options = draco();
    options.comments = {"by the caller"};
    const Document result = again(written(document, options));
    EXPECT_THAT(result.comments, ElementsAre("by the caller", "first", "second line"));
    EXPECT_THAT(result.obj_info, ElementsAre("scanner 7"));
}

TEST_P(DracoRoundTrip, KeepsOnePointAndNone) {
    for (const Eigen::Index n : {1, 0}) {
        Document document;
        document.shape.cloud.points = Points::Constant(3, n, 2.5);
        EXPECT_EQ(again(written(document, draco())).shape.cloud.points,
                  document.shape.cloud.points);
    }
}

TEST_P(DracoRoundTrip, DropsNonFinitePoints) {
    Document document = points_with_every_type();
    document.shape.cloud.points(1, 2) = std::numeric_limits<double>::quiet_NaN();
    const Document result = again(written(document, draco()));
    EXPECT_EQ(result.shape.size(), 3U);
    EXPECT_EQ(result.dropped_points, 1U);
    EXPECT_TRUE(has_warning(result.warnings, "non-finite-points-dropped"));
}

INSTANTIATE_TEST_SUITE_P(Where, DracoRoundTrip, testing::Bool(), [](const auto& test) {
    return test.param ? "InTheHelper" : "InThisProcess";
});

class DracoQuantization : public testing::TestWithParam<int> {};

TEST_P(DracoQuantization, KeepsPositionsWithinHalfAStep) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 500);
    const Document result = read(written(document, draco(GetParam())));
    const Points difference = result.shape.cloud.points - document.shape.cloud.points;
    const double step = 2.0 / ((1 << GetParam()) - 1);
    EXPECT_LE(difference.cwiseAbs().maxCoeff(), 0.51 * step + 1e-6);
}

TEST_P(DracoQuantization, OfCoincidingPointsIsExact) {
    Document document;
    document.shape.cloud.points = Points::Constant(3, 5, 0.75);
    const Document result = read(written(document, draco(GetParam())));
    EXPECT_EQ(result.shape.cloud.points, document.shape.cloud.points);
}

INSTANTIATE_TEST_SUITE_P(Bits, DracoQuantization, testing::Values(8, 11, 14, 20));

TEST(DracoQuantization, MakesFilesSmaller) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 2000);
    EXPECT_LT(written(document, draco(11)).size(), written(document, draco(0)).size() / 2);
}

TEST(DracoWrite, NamesEverythingThatIsLost) {
    std::vector<Warning> lost;
    const Document result = read(written(mesh_with_everything(), draco(), &lost));
    for (const char* code : {"faces-triangulated", "face-attributes-dropped", "element-dropped",
                             "attribute-dropped", "attribute-type-changed"}) {
        EXPECT_TRUE(has_warning(lost, code)) << code;
    }
    EXPECT_EQ(result.shape.triangles, mesh_with_everything().shape.triangles);
    EXPECT_EQ(result.shape.cloud.attributes.size(), 8U);
}

TEST(DracoWrite, SaysHowFarRoundingMovesPoints) {
    Document document;
    document.shape.cloud.points = Points::Constant(3, 1, 5648349.895035);
    document.double_positions = true;
    std::vector<Warning> lost;
    (void)written(document, draco(), &lost);
    ASSERT_TRUE(has_warning(lost, "positions-rounded"));
    EXPECT_THAT(lost[0].detail, HasSubstr("0.10"));
}

TEST(DracoWrite, KeepsCoordinatesBeyondFloat32) {
    Document document;
    document.shape.cloud.points = Points::Constant(3, 2, -1e200);
    EXPECT_EQ(read(written(document, draco(11))).shape.cloud.points, document.shape.cloud.points);
}

TEST(DracoWrite, IncompleteColorIsKeptColumnByColumn) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 2);
    document.shape.cloud.attributes = {column<std::uint8_t>("red", ScalarType::UInt8, {1, 2}),
                                       column<std::uint16_t>("green", ScalarType::UInt16, {3, 4}),
                                       column<std::uint8_t>("blue", ScalarType::UInt8, {5, 6})};
    expect_same(read(written(document, draco())), document);
}

TEST(Draco, MeshWithManyPointsOutsideItsFacesKeepsThePoints) {
    EncodeOptions options;
    options.format = FileFormat::Draco;
    for (const Eigen::Index points : {6, 7}) {
        Document document;
        document.shape.cloud.points = Points::Ones(3, points);
        document.shape.triangles = Triangles::Constant(3, 2, 1);
        std::vector<Warning> lost;
        const Document again = read(written(document, options, &lost));
        EXPECT_EQ(again.shape.cloud.points, document.shape.cloud.points);
        EXPECT_EQ(again.shape.is_mesh(), points == 6);
        EXPECT_EQ(has_warning(lost, "faces-dropped"), points == 7);
    }
}

}  // namespace
}  // namespace lpf
