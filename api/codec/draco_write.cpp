#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "api/codec/draco.h"
#include "api/codec/draco_child.h"
#include "api/codec/draco_columns.h"
#include "api/codec/ply_header.h"
#include "api/codec/positions.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

using Columns = std::vector<const Attribute*>;

/// Points and faces that are encoded within a tenth of a second, so that nobody need be able to
/// stop it.
constexpr std::size_t kQuicklyEncoded = 100'000;

draco::DataType draco_type(ScalarType type) {
    switch (type) {
        case ScalarType::Int8: return draco::DT_INT8;
        case ScalarType::UInt8: return draco::DT_UINT8;
        case ScalarType::Int16: return draco::DT_INT16;
        case ScalarType::UInt16: return draco::DT_UINT16;
        case ScalarType::Int32: return draco::DT_INT32;
        case ScalarType::UInt32: return draco::DT_UINT32;
        case ScalarType::Float32: return draco::DT_FLOAT32;
        case ScalarType::Float64: return draco::DT_FLOAT64;
    }
    return draco::DT_INVALID;
}

/// Draco's integer coder works on differences and fails on 32-bit integers that are spread wider.
bool too_wide_for_draco(const Attribute& column) {
    constexpr double kWidest = 1 << 29;
    if (column.type != ScalarType::Int32 && column.type != ScalarType::UInt32) return false;
    for (std::size_t i = 0; i < column.rows(); ++i) {
        if (std::abs(value_at(column, i)) >= kWidest) return true;
    }
    return false;
}

Attribute widened(const Attribute& column) {
    Attribute wide{column.name, ScalarType::Float64, {}, {}, column.count_type};
    wide.data.resize(column.rows() * sizeof(double));
    for (std::size_t i = 0; i < column.rows(); ++i) {
        const double value = value_at(column, i);
        std::memcpy(wide.data.data() + i * sizeof value, &value, sizeof value);
    }
    return wide;
}

/// Draco's decoder refuses sequential meshes with more points than the faces have corners.
bool fits_draco_mesh(const Shape& shape) {
    return shape.is_mesh() && shape.size() <= 3 * static_cast<std::size_t>(shape.triangles.cols());
}

class DracoWriter {
public:
    DracoWriter(const Document& document, const EncodeOptions& options, std::vector<Warning>& lost)
        : document_(document),
          options_(options),
          lost_(lost),
          mesh_(fits_draco_mesh(document.shape) ? std::make_unique<draco::Mesh>() : nullptr),
          cloud_(mesh_ ? nullptr : std::make_unique<draco::PointCloud>()),
          geometry_(mesh_ ? *mesh_ : *cloud_),
          points_(static_cast<std::uint32_t>(document.shape.size())) {}

    std::string write() {
        geometry_.set_num_points(points_);
        check_rows();
        add_text();
        add_positions();
        add_columns();
        if (mesh_) add_faces();
        report_what_draco_has_no_place_for();
        return encoded();
    }

private:
    void add_text();
    void add_positions();
    void check_rows() const;
    void add_columns();
    void add_group(draco::GeometryAttribute::Type type, const Columns& columns);
    void add_generic(const Attribute& column);
    void add_faces();
    void report_what_draco_has_no_place_for();
    void lose(const char* code, const std::string& detail) { lost_.push_back({code, detail}); }
    int add(draco::GeometryAttribute::Type type, ScalarType scalar, std::size_t components,
            const std::byte* rows);
    void note(int attribute, const char* entry, const std::string& text);
    std::string encoded();

    template <std::size_t N>
    [[nodiscard]] Columns group_of(const std::array<std::string_view, N>& names,
                                   std::size_t at_least) const;

    const Document& document_;
    const EncodeOptions& options_;
    std::vector<Warning>& lost_;
    std::unique_ptr<draco::Mesh> mesh_;
    std::unique_ptr<draco::PointCloud> cloud_;
    draco::PointCloud& geometry_;
    std::uint32_t points_;
    int position_ = -1;
};

/// Adds one attribute whose values lie row by row; value i belongs to point i.
int DracoWriter::add(draco::GeometryAttribute::Type type, ScalarType scalar, std::size_t components,
                     const std::byte* rows) {
    auto attribute = std::make_unique<draco::PointAttribute>();
    attribute->Init(type, static_cast<std::int8_t>(components), draco_type(scalar),
                    type == draco::GeometryAttribute::COLOR && scalar == ScalarType::UInt8,
                    points_);
    const std::size_t bytes = points_ * components * size_of(scalar);
    if (bytes > 0) attribute->buffer()->Write(0, rows, bytes);
    return geometry_.AddAttribute(std::move(attribute));
}

void DracoWriter::note(int attribute, const char* entry, const std::string& text) {
    const std::uint32_t id = geometry_.attribute(attribute)->unique_id();
    draco::AttributeMetadata* known =
        geometry_.metadata() == nullptr
            ? nullptr
            : geometry_.metadata()->attribute_metadata(static_cast<std::int32_t>(id));
    if (known != nullptr) {
        known->AddEntryString(entry, text);
        return;
    }
    auto metadata = std::make_unique<draco::AttributeMetadata>();
    metadata->AddEntryString(entry, text);
    geometry_.AddAttributeMetadata(attribute, std::move(metadata));
}

std::string joined(const std::vector<std::string>& first, const std::vector<std::string>& second) {
    std::string text;
    for (const std::vector<std::string>* lines : {&first, &second}) {
        for (const std::string& line : *lines) text += line + "\n";
    }
    return text;
}

void DracoWriter::add_text() {
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    const std::string comments = joined(options_.comments, document_.comments);
    const std::string obj_info = joined(document_.obj_info, {});
    if (!comments.empty()) metadata->AddEntryString(kDracoCommentEntry, comments);
    if (!obj_info.empty()) metadata->AddEntryString(kDracoObjInfoEntry, obj_info);
    if (metadata->num_entries() > 0) geometry_.AddMetadata(std::move(metadata));
}

void DracoWriter::add_positions() {
    const Points& points = document_.shape.cloud.points;
    const bool quantized = options_.quantization_bits > 0;
    const bool beyond_float = exceed_float32(points);
    if (beyond_float || (options_.double_positions && !quantized)) {
        if (quantized) lose("not-quantized", "coordinates beyond float32 are written exactly");
        position_ = add(draco::GeometryAttribute::POSITION, ScalarType::Float64, 3,
                        reinterpret_cast<const std::byte*>(points.data()));
        return;
    }
    const std::vector<float> values = float_positions(points);
    position_ = add(draco::GeometryAttribute::POSITION, ScalarType::Float32, 3,
                    reinterpret_cast<const std::byte*>(values.data()));
    const double rounding = rounding_of(points);
    if (document_.double_positions && rounding > 0) {
        lose("positions-rounded", message_of("coordinates are written as float32, which moves them "
                                             "by up to ",
                                             rounding));
    }
}

/// The columns of these names, from the first on, if they can be components of one attribute.
template <std::size_t N>
Columns DracoWriter::group_of(const std::array<std::string_view, N>& names,
                              std::size_t at_least) const {
    Columns group;
    const std::vector<Attribute>& all = document_.shape.cloud.attributes;
    for (const std::string_view name : names) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const Attribute& attribute) {
            return attribute.name == name && !attribute.is_list() &&
                   (group.empty() || attribute.type == group.front()->type);
        });
        if (found == all.end()) break;
        group.push_back(&*found);
    }
    const bool usable = group.size() >= at_least && (group.front()->type == ScalarType::Float32 ||
                                                     group.front()->type == ScalarType::UInt8 ||
                                                     group.front()->type == ScalarType::UInt16);
    return usable ? group : Columns{};
}

void DracoWriter::check_rows() const {
    for (const Attribute& column : document_.shape.cloud.attributes) {
        if (column.rows() == points_) continue;
        fail(ErrorCode::Internal, "attribute ", quoted(column.name), " has ", column.rows(),
             " rows, but there are ", points_, " points");
    }
}

void DracoWriter::add_columns() {
    const Columns normal = group_of(kNormalColumns, 3);
    const Columns color = group_of(kColorColumns, 3);
    const Columns tex_coord = group_of(kTexCoordColumns, 2);
    const auto in = [](const Columns& group, const Attribute& column) {
        return std::find(group.begin(), group.end(), &column) != group.end();
    };
    for (const Attribute& column : document_.shape.cloud.attributes) {
        const auto starts = [&](const Columns& group) {
            return !group.empty() && group.front() == &column;
        };
        if (starts(normal)) add_group(draco::GeometryAttribute::NORMAL, normal);
        if (starts(color)) add_group(draco::GeometryAttribute::COLOR, color);
        if (starts(tex_coord)) add_group(draco::GeometryAttribute::TEX_COORD, tex_coord);
        if (in(normal, column) || in(color, column) || in(tex_coord, column)) continue;
        add_generic(column);
    }
}

void DracoWriter::add_group(draco::GeometryAttribute::Type type, const Columns& columns) {
    const std::size_t size = size_of(columns.front()->type);
    std::vector<std::byte> rows(points_ * columns.size() * size);
    for (std::size_t component = 0; component < columns.size(); ++component) {
        const std::byte* source = columns[component]->data.data();
        std::byte* target = rows.data() + component * size;
        for (std::uint32_t i = 0; i < points_; ++i) {
            std::memcpy(target + i * columns.size() * size, source + i * size, size);
        }
    }
    add(type, columns.front()->type, columns.size(), rows.data());
}

void DracoWriter::add_generic(const Attribute& column) {
    if (column.is_list()) {
        lose("attribute-dropped", message_of("attribute ", quoted(column.name),
                                             " is a list a point, which Draco cannot hold"));
        return;
    }
    const bool widen = too_wide_for_draco(column);
    const std::optional<Attribute> wide = widen ? std::optional(widened(column)) : std::nullopt;
    const Attribute& written = wide ? *wide : column;
    const int id = add(draco::GeometryAttribute::GENERIC, written.type, 1, written.data.data());
    note(id, kDracoNameEntry, column.name);
    if (!widen) return;
    note(id, kDracoTypeEntry, std::string(ply_type_name(column.type)));
    lose("attribute-type-changed",
         message_of("attribute ", quoted(column.name), " is written as double: Draco cannot hold ",
                    ply_type_name(column.type), " values of 2^29 and above"));
}

void DracoWriter::add_faces() {
    const Triangles& triangles = document_.shape.triangles;
    mesh_->SetNumFaces(static_cast<std::size_t>(triangles.cols()));
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
        mesh_->SetFace(draco::FaceIndex(static_cast<std::uint32_t>(f)),
                       {draco::PointIndex(triangles(0, f)), draco::PointIndex(triangles(1, f)),
                        draco::PointIndex(triangles(2, f))});
    }
}

void DracoWriter::report_what_draco_has_no_place_for() {
    if (document_.shape.is_mesh() && !mesh_) {
        lose("faces-dropped",
             message_of("a Draco mesh cannot hold the ", points_, " points with only ",
                        document_.face_count(), " faces; the points are written without them"));
    } else if (!document_.polygons.empty()) {
        lose("faces-triangulated",
             message_of(document_.polygons.size(), " polygons are written as ",
                        document_.shape.triangles.cols(), " triangles"));
    }
    for (const Attribute& attribute : document_.face_attributes) {
        lose("face-attributes-dropped",
             message_of("face property ", quoted(attribute.name), " has no place in a Draco file"));
    }
    for (const Element& element : document_.elements) {
        lose("element-dropped",
             message_of("element ", quoted(element.name), " has no place in a Draco file"));
    }
}

std::string DracoWriter::encoded() {
    auto encoder = mesh_ ? std::make_unique<draco::ExpertEncoder>(*mesh_)
                         : std::make_unique<draco::ExpertEncoder>(*cloud_);
    encoder->SetEncodingMethod(mesh_ ? static_cast<int>(draco::MESH_SEQUENTIAL_ENCODING)
                                     : static_cast<int>(draco::POINT_CLOUD_SEQUENTIAL_ENCODING));
    const bool is_float = geometry_.attribute(position_)->data_type() == draco::DT_FLOAT32;
    if (options_.quantization_bits > 0 && is_float) {
        encoder->SetAttributeQuantization(position_, options_.quantization_bits);
    }
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder->EncodeToBuffer(&buffer);
    if (!status.ok()) {
        fail(ErrorCode::Internal, "Draco encoding failed: ", status.error_msg_string());
    }
    return {buffer.data(), buffer.size()};
}

}  // namespace

std::string encode_draco_here(const Document& document, const EncodeOptions& options,
                              std::vector<Warning>& lost) {
    return DracoWriter(document, options, lost).write();
}

std::string encode_draco(const Document& document, const EncodeOptions& options,
                         std::vector<Warning>& lost, const Execution& execution) {
    throw_if_cancelled(execution);
    const std::size_t size = document.shape.size() + document.face_count();
    if (size <= kQuicklyEncoded || options.encode_helper.empty()) {
        return encode_draco_here(document, options, lost);
    }
    return encode_draco_in_child(document, options, lost, execution);
}

}  // namespace lpf
