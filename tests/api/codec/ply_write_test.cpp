#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

EncodeOptions ascii() {
    EncodeOptions options;
    options.format = FileFormat::PlyAscii;
    return options;
}

TEST(PlyWrite, WritesAHeaderThatEveryReaderKnows) {
    Document document;
    document.shape.cloud.points = Points::Constant(3, 1, 0.1);
    document.shape.cloud.attributes = {column<std::uint8_t>("red", ScalarType::UInt8, {200})};
    EncodeOptions options = ascii();
    options.double_positions = true;
    EXPECT_EQ(written(document, options),
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
              "property double z\nproperty uchar red\nend_header\n0.1 0.1 0.1 200\n");
}

TEST(PlyWrite, PutsTheCallersCommentsFirst) {
    Document document = mesh_with_everything();
    EncodeOptions options = ascii();
    options.comments = {"denoised"};
    EXPECT_THAT(written(document, options),
                StartsWith("ply\nformat ascii 1.0\ncomment denoised\ncomment made by a test\n"
                           "comment\ncomment   two blanks first\nobj_info num_cols 512\n"));
}

TEST(PlyWrite, CommentCannotAddHeaderLines) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 1);
    document.comments = {"a\nelement evil 99\rb"};
    const Document again = read(written(document, ascii()));
    EXPECT_THAT(again.comments, ElementsAre("a element evil 99 b"));
    EXPECT_TRUE(again.elements.empty());
}

TEST(PlyWrite, RenamesAttributesThatAHeaderCannotHold) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 1);
    document.shape.cloud.attributes = {column<float>("two words", ScalarType::Float32, {1}),
                                       column<float>("x", ScalarType::Float32, {2}),
                                       column<float>("", ScalarType::Float32, {3}),
                                       column<float>("a\nend_header", ScalarType::Float32, {4})};
    std::vector<Warning> lost;
    const Document again = read(written(document, ascii(), &lost));
    EXPECT_EQ(values_of(attribute_of(again, "two_words")).at(0), 1);
    EXPECT_EQ(values_of(attribute_of(again, "x_2")).at(0), 2);
    EXPECT_EQ(values_of(attribute_of(again, "unnamed")).at(0), 3);
    EXPECT_EQ(values_of(attribute_of(again, "a_end_header")).at(0), 4);
    EXPECT_EQ(lost.size(), 4U);
    EXPECT_TRUE(has_warning(lost, "attribute-renamed"));
}

TEST(PlyWrite, WritesDoublesWhereFloatsWouldOverflow) {
    Document document;
    document.shape.cloud.points = Points::Constant(3, 1, 1e200);
    EXPECT_EQ(read(written(document, ascii())).shape.cloud.points(0, 0), 1e200);
}

TEST(PlyWrite, RefusesAColumnOfAnotherLength) {
    Document document;
    document.shape.cloud.points = Points::Zero(3, 2);
    document.shape.cloud.attributes = {column<float>("a", ScalarType::Float32, {1})};
    try {
        (void)written(document, ascii());
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Internal);
        EXPECT_THAT(error.what(), HasSubstr("'a' has 1 rows"));
    }
}

TEST(PlyWrite, CountsBigPolygonsInAWiderType) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 300);
    document.polygons.offsets = {0, 300};
    for (std::uint32_t i = 0; i < 300; ++i) document.polygons.vertices.push_back(i);
    document.shape.triangles.resize(3, 298);
    const std::string text = written(document, ascii());
    EXPECT_THAT(text, HasSubstr("property list ushort int vertex_indices"));
    EXPECT_EQ(read(text).polygons.vertices, document.polygons.vertices);
}

TEST(PlyWrite, NoColumnBecomesAListOfVerticesByItsNewName) {
    Document document = points_with_every_type();
    document.elements = {
        {"face", 1, {column<std::int32_t>("vertex\x7findices", ScalarType::Int32, {99, 98, 97})}}};
    document.elements[0].attributes[0].list_offsets = {0, 3};
    std::vector<Warning> lost;
    const Document again = read(written(document, {}, &lost));
    EXPECT_TRUE(has_warning(lost, "attribute-renamed"));
    EXPECT_EQ(again.face_count(), 0U);
    ASSERT_EQ(again.elements.size(), 1U);
    EXPECT_EQ(again.elements[0].attributes.at(0).name, "vertex_indices_2");
}

}  // namespace
}  // namespace lpf
