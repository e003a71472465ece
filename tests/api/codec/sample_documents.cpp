#include "tests/api/codec/sample_documents.h"

#include <limits>

namespace lpf {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

Document read(std::string_view file, const DecodeLimits& limits) {
    return decode(bytes_of(file), limits);
}

std::optional<Error> refusal(std::string_view file, const DecodeLimits& limits) {
    try {
        (void)decode(bytes_of(file), limits);
    } catch (const Error& error) {
        return error;
    }
    return std::nullopt;
}

std::string written(const Document& document, const EncodeOptions& options,
                    std::vector<Warning>* lost) {
    std::vector<Warning> warnings;
    std::string file = encode(document, options, warnings);
    if (lost != nullptr) *lost = warnings;
    return file;
}

std::vector<double> values_of(const Attribute& attribute) {
    const Attribute flat{"", attribute.type, attribute.data, {}, ScalarType::UInt8};
    std::vector<double> values;
    for (std::size_t i = 0; i < flat.rows(); ++i) values.push_back(value_at(flat, i));
    return values;
}

const Attribute& attribute_of(const Document& document, std::string_view name) {
    static const Attribute kNone;
    for (const Attribute& attribute : document.shape.cloud.attributes) {
        if (attribute.name == name) return attribute;
    }
    ADD_FAILURE() << "no attribute " << name;
    return kNone;
}

bool has_warning(const std::vector<Warning>& warnings, std::string_view code) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const Warning& warning) { return warning.code == code; });
}

namespace {

template <typename T>
Attribute extremes(std::string name, ScalarType type) {
    using Limits = std::numeric_limits<T>;
    return column<T>(std::move(name), type, {Limits::lowest(), Limits::max(), T{0}, T{7}});
}

Points four_points() {
    Points points(3, 4);
    points << 0, 1, 1, 0,  //
        0, 0, 1, 1,        //
        0.5, -0.25, 2, 8;
    return points;
}

Attribute list_column() {
    Attribute list = column<std::int16_t>("neighbours", ScalarType::Int16, {1, -2, 3, 4, 5, 6});
    list.list_offsets = {0, 2, 2, 5, 6};
    list.count_type = ScalarType::UInt16;
    return list;
}

}  // namespace

Document points_with_every_type() {
    Document document;
    document.shape.cloud.points = four_points();
    document.shape.cloud.attributes = {extremes<std::int8_t>("i8", ScalarType::Int8),
                                       extremes<std::uint8_t>("u8", ScalarType::UInt8),
                                       extremes<std::int16_t>("i16", ScalarType::Int16),
                                       extremes<std::uint16_t>("u16", ScalarType::UInt16),
                                       extremes<std::int32_t>("i32", ScalarType::Int32),
                                       extremes<std::uint32_t>("u32", ScalarType::UInt32),
                                       extremes<float>("f32", ScalarType::Float32),
                                       extremes<double>("f64", ScalarType::Float64)};
    return document;
}

Document mesh_with_everything() {
    Document document = points_with_every_type();
    document.shape.cloud.attributes.push_back(list_column());
    document.shape.triangles.resize(3, 3);
    document.shape.triangles << 0, 0, 1,  //
        1, 2, 3,                          //
        2, 3, 2;
    document.polygons = {{0, 4, 7}, {0, 1, 2, 3, 1, 3, 2}};
    document.face_attributes = {column<std::uint8_t>("flags", ScalarType::UInt8, {7, 9})};
    document.elements = {
        {"edge", 1, {column<std::int32_t>("vertex1", ScalarType::Int32, {2})}},
        {"material", 2, {column<float>("shine", ScalarType::Float32, {0.5F, 1.5F})}}};
    document.comments = {"made by a test", "", "  two blanks first"};
    document.obj_info = {"num_cols 512"};
    return document;
}

void expect_same_attribute(const Attribute& got, const Attribute& expected) {
    EXPECT_EQ(got.name, expected.name);
    EXPECT_EQ(got.type, expected.type) << expected.name;
    EXPECT_EQ(got.list_offsets, expected.list_offsets) << expected.name;
    EXPECT_TRUE(got.data == expected.data) << expected.name;
    if (expected.is_list()) {
        EXPECT_EQ(got.count_type, expected.count_type) << expected.name;
    }
}

namespace {

void expect_same_attributes(const std::vector<Attribute>& got,
                            const std::vector<Attribute>& expected) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i) expect_same_attribute(got[i], expected[i]);
}

}  // namespace

void expect_same(const Document& got, const Document& expected) {
    EXPECT_EQ(got.shape.cloud.points, expected.shape.cloud.points);
    EXPECT_EQ(got.shape.triangles, expected.shape.triangles);
    expect_same_attributes(got.shape.cloud.attributes, expected.shape.cloud.attributes);
    EXPECT_EQ(got.polygons.offsets, expected.polygons.offsets);
    EXPECT_EQ(got.polygons.vertices, expected.polygons.vertices);
    expect_same_attributes(got.face_attributes, expected.face_attributes);
    ASSERT_EQ(got.elements.size(), expected.elements.size());
    for (std::size_t i = 0; i < got.elements.size(); ++i) {
        EXPECT_EQ(got.elements[i].name, expected.elements[i].name);
        EXPECT_EQ(got.elements[i].rows, expected.elements[i].rows);
        expect_same_attributes(got.elements[i].attributes, expected.elements[i].attributes);
    }
    EXPECT_EQ(got.comments, expected.comments);
    EXPECT_EQ(got.obj_info, expected.obj_info);
}

}  // namespace lpf
