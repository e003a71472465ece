#include "api/codec/document.h"

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

TEST(WithPoints, KeepsFacesAndElementsWhereVerticesStay) {
    const Document source = mesh_with_everything();
    PointCloud moved = source.shape.cloud;
    moved.points.row(2).array() += 1.0;
    Document expected = source;
    expected.shape.cloud = moved;
    const Document result = with_points(source, moved, true);
    expect_same(result, expected);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(WithPoints, DropsWhatNumbersPointsWhereTheyAreNew) {
    PointCloud cloud;
    cloud.points = Points::Random(3, 7);
    const Document result = with_points(mesh_with_everything(), cloud, false);
    EXPECT_EQ(result.shape.size(), 7U);
    EXPECT_EQ(result.face_count(), 0U);
    EXPECT_TRUE(result.face_attributes.empty());
    ASSERT_EQ(result.elements.size(), 1U);
    EXPECT_EQ(result.elements[0].name, "material");
    EXPECT_EQ(result.comments, mesh_with_everything().comments);
    EXPECT_TRUE(has_warning(result.warnings, "faces-dropped"));
    EXPECT_TRUE(has_warning(result.warnings, "element-dropped"));
}

TEST(WithPoints, RefusesToKeepVerticesOfAnotherNumber) {
    EXPECT_THROW((void)with_points(mesh_with_everything(), PointCloud{}, true), Error);
}

}  // namespace
}  // namespace lpf
