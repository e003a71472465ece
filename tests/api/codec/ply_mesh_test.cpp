#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Five points in a row of the x axis and the faces that are given.
std::string mesh(int faces, const std::string& properties, const std::string& rows,
                 const std::string& z_of_last = "0") {
    return "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
           "property float z\nelement face " +
           std::to_string(faces) + "\n" + properties +
           "end_header\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n4 0 " + z_of_last + "\n" + rows;
}

std::vector<std::uint32_t> corners(const Document& document) {
    const Triangles& triangles = document.shape.triangles;
    return {triangles.data(), triangles.data() + triangles.size()};
}

class FaceListName : public testing::TestWithParam<std::string> {};

TEST_P(FaceListName, IsRead) {
    const Document document =
        read(mesh(2, "property list uchar int " + GetParam() + "\n", "3 0 1 2\n3 2 1 4\n"));
    EXPECT_THAT(corners(document), ElementsAre(0, 1, 2, 2, 1, 4));
    EXPECT_TRUE(document.polygons.empty());
    EXPECT_EQ(document.face_count(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Names, FaceListName, testing::Values("vertex_index", "vertex_indices"));

class FaceIndexType : public testing::TestWithParam<std::string> {};

TEST_P(FaceIndexType, IsRead) {
    const Document document =
        read(mesh(1, "property list uchar " + GetParam() + " vertex_indices\n", "3 4 1 2\n"));
    EXPECT_THAT(corners(document), ElementsAre(4, 1, 2));
}

INSTANTIATE_TEST_SUITE_P(Types, FaceIndexType,
                         testing::Values("char", "uchar", "short", "ushort", "int", "uint"));

TEST(PlyMesh, PolygonsBecomeFansAndStayPolygons) {
    const Document document = read(
        mesh(3, "property list uchar int vertex_indices\n", "4 0 1 2 3\n3 2 1 4\n5 0 1 2 3 4\n"));
    EXPECT_THAT(corners(document),
                ElementsAre(0, 1, 2, 0, 2, 3, 2, 1, 4, 0, 1, 2, 0, 2, 3, 0, 3, 4));
    EXPECT_THAT(document.polygons.offsets, ElementsAre(0, 4, 7, 12));
    EXPECT_EQ(document.face_count(), 3U);
}

TEST(PlyMesh, FacesOfFewerThanThreeCornersMakeNoTriangle) {
    const Document document =
        read(mesh(3, "property list uchar int vertex_indices\n", "2 0 1\n0\n3 0 1 2\n"));
    EXPECT_THAT(corners(document), ElementsAre(0, 1, 2));
    EXPECT_EQ(document.face_count(), 3U);
}

TEST(PlyMesh, KeepsFacePropertiesAndListsOfFloats) {
    const Document document =
        read(mesh(2,
                  "property char flags\nproperty list uchar int vertex_indices\n"
                  "property list uchar float texcoord\n",
                  "-1 3 0 1 2 2 0.5 0.25\n-2 3 2 1 4 0\n"));
    ASSERT_EQ(document.face_attributes.size(), 2U);
    EXPECT_THAT(values_of(document.face_attributes[0]), ElementsAre(-1, -2));
    EXPECT_THAT(document.face_attributes[1].list_offsets, ElementsAre(0, 2, 2));
}

TEST(PlyMesh, FaceElementWithoutVertexListIsKeptAsItIs) {
    const Document document = read(mesh(1, "property uchar a\n", "7\n"));
    EXPECT_FALSE(document.shape.is_mesh());
    ASSERT_EQ(document.elements.size(), 1U);
    EXPECT_EQ(document.elements[0].name, "face");
}

TEST(PlyMesh, EmptyFaceElementIsAPointCloud) {
    EXPECT_FALSE(read(mesh(0, "property list uchar int vertex_indices\n", "")).shape.is_mesh());
}

TEST(PlyMesh, RefusesVertexNumbersOutOfRange) {
    for (const char* row : {"3 0 1 5\n", "3 0 1 -1\n", "4 0 1 2 2147483647\n"}) {
        const auto error = refusal(
            mesh(2, "property list uchar int vertex_indices\n", "3 0 1 2\n" + std::string(row)));
        ASSERT_TRUE(error.has_value()) << row;
        EXPECT_EQ(error->code(), ErrorCode::MalformedFile);
        EXPECT_THAT(error->what(), HasSubstr("face 1 refers to vertex"));
        EXPECT_THAT(error->what(), HasSubstr("5 vertices"));
    }
}

TEST(PlyMesh, RefusesVertexNumbersThatAreNoIntegers) {
    const auto error = refusal(mesh(1, "property list uchar float vertex_indices\n", "3 0 1 2\n"));
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("whole numbers"));
}

TEST(PlyMesh, FacesOfDroppedPointsGoAndTheRestIsRenumbered) {
    std::string text = mesh(2, "property list uchar int vertex_indices\nproperty uchar id\n",
                            "3 0 1 2 10\n3 2 3 4 20\n");
    text.replace(text.find("0 0 0\n"), 6, "nan 0 0\n");
    const Document document = read(text);
    EXPECT_EQ(document.shape.size(), 4U);
    EXPECT_THAT(corners(document), ElementsAre(1, 2, 3));
    EXPECT_THAT(values_of(document.face_attributes.at(0)), ElementsAre(20));
    EXPECT_TRUE(has_warning(document.warnings, "faces-dropped"));
}

TEST(PlyMesh, TrianglesAloneAreNoPolygonsWhenTheOthersWereDropped) {
    std::string text = mesh(2, "property list uchar int vertex_indices\n", "4 0 1 2 3\n3 2 3 4\n");
    text.replace(text.find("0 0 0\n"), 6, "nan 0 0\n");
    const Document document = read(text);
    EXPECT_THAT(corners(document), ElementsAre(1, 2, 3));
    EXPECT_TRUE(document.polygons.empty());
    EXPECT_EQ(document.face_count(), 1U);
}

TEST(PlyMesh, PolygonsOfDroppedPointsGoWithTheirProperties) {
    const Document document =
        read(mesh(3, "property list uchar int vertex_indices\nproperty uchar id\n",
                  "4 0 1 2 3 10\n3 2 3 4 20\n4 3 2 1 0 30\n", "inf"));
    EXPECT_EQ(document.dropped_points, 1U);
    EXPECT_THAT(document.polygons.vertices, ElementsAre(0, 1, 2, 3, 3, 2, 1, 0));
    EXPECT_EQ(document.shape.triangles.cols(), 4);
    EXPECT_THAT(values_of(document.face_attributes.at(0)), ElementsAre(10, 30));
}

TEST(PlyMesh, ElementsThatNumberPointsGoWhenNumbersChange) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
        "element camera 1\nproperty float focus\nend_header\nnan 0 0\n1 2 3\n0 1\n35\n";
    const Document document = read(text);
    ASSERT_EQ(document.elements.size(), 1U);
    EXPECT_EQ(document.elements[0].name, "camera");
    EXPECT_TRUE(has_warning(document.warnings, "element-dropped"));
}

TEST(PlyMesh, FanOfManyTrianglesCountsAgainstTheFaceLimit) {
    DecodeLimits limits;
    limits.max_faces = 2;
    const auto error =
        refusal(mesh(1, "property list uchar int vertex_indices\n", "5 0 1 2 3 4\n"), limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
    EXPECT_THAT(error->what(), HasSubstr("the limit is 2"));
}

}  // namespace
}  // namespace lpf
