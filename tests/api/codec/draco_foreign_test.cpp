// Streams as other programs write them: kd-tree and edgebreaker encoding, attributes with values of
// their own number, several components, no names. Made with the library itself.

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using draco::AttributeValueIndex;
using draco::GeometryAttribute;
using draco::PointIndex;
using testing::ElementsAre;

template <typename T>
std::unique_ptr<draco::PointAttribute> attribute(GeometryAttribute::Type type,
                                                 draco::DataType data_type, int components,
                                                 const std::vector<T>& values) {
    auto result = std::make_unique<draco::PointAttribute>();
    const std::size_t rows = values.size() / static_cast<std::size_t>(components);
    result->Init(type, static_cast<std::int8_t>(components), data_type, false, rows);
    result->buffer()->Write(0, values.data(), values.size() * sizeof(T));
    return result;
}

std::unique_ptr<draco::PointAttribute> grid_positions(int n) {
    std::vector<float> values;
    for (int i = 0; i < n; ++i) {
        values.insert(values.end(), {static_cast<float>(i), static_cast<float>(i % 3), 0.5F});
    }
    return attribute(GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, values);
}

std::string encoded(draco::ExpertEncoder& encoder, int method) {
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    EXPECT_TRUE(status.ok()) << status.error_msg_string();
    return {buffer.data(), buffer.size()};
}

std::string sequential(const draco::PointCloud& cloud) {
    draco::ExpertEncoder encoder(cloud);
    return encoded(encoder, draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
}

TEST(DracoForeign, ValuesSharedByPointsReachEachOfThem) {
    draco::PointCloud cloud;
    cloud.set_num_points(4);
    cloud.AddAttribute(grid_positions(4));
    auto shared = attribute<std::uint8_t>(GeometryAttribute::COLOR, draco::DT_UINT8, 3,
                                          {10, 20, 30, 40, 50, 60});
    shared->SetExplicitMapping(4);
    for (std::uint32_t i = 0; i < 4; ++i) {
        shared->SetPointMapEntry(PointIndex(i), AttributeValueIndex(i == 2 ? 0 : 1));
    }
    cloud.AddAttribute(std::move(shared));
    const Document document = read(sequential(cloud));
    EXPECT_THAT(values_of(attribute_of(document, "red")), ElementsAre(40, 40, 10, 40));
    EXPECT_THAT(values_of(attribute_of(document, "blue")), ElementsAre(60, 60, 30, 60));
}

TEST(DracoForeign, AttributesWithoutNamesGetTheirNumber) {
    draco::PointCloud cloud;
    cloud.set_num_points(2);
    cloud.AddAttribute(grid_positions(2));
    const int one = cloud.AddAttribute(
        attribute<float>(GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, {1, 2}));
    const int two = cloud.AddAttribute(
        attribute<std::int16_t>(GeometryAttribute::GENERIC, draco::DT_INT16, 2, {3, 4, 5, 6}));
    const Document document = read(sequential(cloud));
    const auto name = [&](int id) {
        return "generic_" + std::to_string(cloud.attribute(id)->unique_id());
    };
    EXPECT_THAT(values_of(attribute_of(document, name(one))), ElementsAre(1, 2));
    EXPECT_THAT(values_of(attribute_of(document, name(two) + "_0")), ElementsAre(3, 5));
    EXPECT_THAT(values_of(attribute_of(document, name(two) + "_1")), ElementsAre(4, 6));
}

TEST(DracoForeign, NamesThatClashOrHoldBlanksAreMadeUnique) {
    draco::PointCloud cloud;
    cloud.set_num_points(1);
    cloud.AddAttribute(grid_positions(1));
    for (const char* name : {"x", "two words", "two words"}) {
        const int id = cloud.AddAttribute(
            attribute<float>(GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, {1}));
        auto metadata = std::make_unique<draco::AttributeMetadata>();
        metadata->AddEntryString("name", name);
        cloud.AddAttributeMetadata(id, std::move(metadata));
    }
    const Document document = read(sequential(cloud));
    for (const char* name : {"x_2", "two_words", "two_words_2"}) {
        EXPECT_EQ(attribute_of(document, name).rows(), 1U);
    }
}

TEST(DracoForeign, WideIntegersAndBooleansKeepTheirValues) {
    draco::PointCloud cloud;
    cloud.set_num_points(2);
    cloud.AddAttribute(grid_positions(2));
    cloud.AddAttribute(
        attribute<std::int64_t>(GeometryAttribute::GENERIC, draco::DT_INT64, 1, {-5000000000, 7}));
    cloud.AddAttribute(
        attribute<std::uint8_t>(GeometryAttribute::GENERIC, draco::DT_BOOL, 1, {1, 0}));
    const Document document = read(sequential(cloud));
    ASSERT_EQ(document.shape.cloud.attributes.size(), 2U);
    EXPECT_EQ(document.shape.cloud.attributes[0].type, ScalarType::Float64);
    EXPECT_THAT(values_of(document.shape.cloud.attributes[0]), ElementsAre(-5000000000.0, 7));
    EXPECT_EQ(document.shape.cloud.attributes[1].type, ScalarType::UInt8);
    EXPECT_THAT(values_of(document.shape.cloud.attributes[1]), ElementsAre(1, 0));
}

TEST(DracoForeign, StreamWithoutPositionsIsRefused) {
    draco::PointCloud cloud;
    cloud.set_num_points(2);
    cloud.AddAttribute(attribute<float>(GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, {1, 2}));
    const auto error = refusal(sequential(cloud));
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::MalformedFile);
    EXPECT_THAT(error->what(), testing::HasSubstr("POSITION"));
}

TEST(DracoForeign, KdTreeCloudKeepsColoursWithTheirPoints) {
    constexpr int kPoints = 200;
    draco::PointCloud cloud;
    cloud.set_num_points(kPoints);
    const int position = cloud.AddAttribute(grid_positions(kPoints));
    std::vector<std::uint8_t> colours;
    for (int i = 0; i < kPoints; ++i) {
        colours.insert(colours.end(), {static_cast<std::uint8_t>(i), 1, 2});
    }
    cloud.AddAttribute(attribute(GeometryAttribute::COLOR, draco::DT_UINT8, 3, colours));
    draco::ExpertEncoder encoder(cloud);
    encoder.SetAttributeQuantization(position, 16);
    const Document document = read(encoded(encoder, draco::POINT_CLOUD_KD_TREE_ENCODING));
    ASSERT_EQ(document.shape.size(), 200U);
    const std::vector<double> red = values_of(attribute_of(document, "red"));
    for (Eigen::Index i = 0; i < kPoints; ++i) {
        EXPECT_NEAR(document.shape.cloud.points(0, i), red[static_cast<std::size_t>(i)], 0.01);
    }
}

/// Two triangles over four positions, with a normal of its own for each of the six corners.
std::unique_ptr<draco::Mesh> mesh_with_a_seam() {
    auto mesh = std::make_unique<draco::Mesh>();
    mesh->set_num_points(6);
    mesh->SetNumFaces(2);
    mesh->SetFace(draco::FaceIndex(0), {PointIndex(0), PointIndex(1), PointIndex(2)});
    mesh->SetFace(draco::FaceIndex(1), {PointIndex(3), PointIndex(4), PointIndex(5)});
    auto positions = grid_positions(4);
    positions->SetExplicitMapping(6);
    const std::array<std::uint32_t, 6> vertex{0, 1, 2, 2, 1, 3};
    for (std::uint32_t i = 0; i < 6; ++i) {
        positions->SetPointMapEntry(PointIndex(i), AttributeValueIndex(vertex[i]));
    }
    mesh->AddAttribute(std::move(positions));
    mesh->AddAttribute(
        attribute<float>(GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, {0, 0, 0, 1, 1, 1}));
    return mesh;
}

TEST(DracoForeign, EdgebreakerMeshKeepsTheSeamBetweenItsFaces) {
    const auto mesh = mesh_with_a_seam();
    draco::ExpertEncoder encoder(*mesh);
    const Document document = read(encoded(encoder, draco::MESH_EDGEBREAKER_ENCODING));
    ASSERT_EQ(document.shape.triangles.cols(), 2);
    ASSERT_EQ(document.shape.size(), 6U);
    ASSERT_EQ(document.shape.cloud.attributes.size(), 1U);
    for (Eigen::Index face = 0; face < 2; ++face) {
        double sum_x = 0;
        std::vector<double> side;
        for (Eigen::Index corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = document.shape.triangles(corner, face);
            sum_x += document.shape.cloud.points(0, vertex);
            side.push_back(value_at(document.shape.cloud.attributes[0], vertex));
        }
        // x is the number of the vertex: 0 + 1 + 2 in the first face, 1 + 2 + 3 in the second.
        EXPECT_EQ(sum_x, side[0] == 0 ? 3 : 6);
        EXPECT_THAT(side, testing::Each(side[0]));
    }
}

}  // namespace
}  // namespace lpf
