#include "api/codec/draco.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "api/codec/draco_child.h"
#include "api/codec/draco_claim.h"
#include "api/codec/draco_columns.h"
#include "api/codec/faces.h"
#include "api/codec/names.h"
#include "api/codec/ply_header.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

using DracoAttribute = draco::PointAttribute;

std::unique_ptr<draco::PointCloud> decode_geometry(std::span<const std::byte> bytes, bool is_mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    std::unique_ptr<draco::PointCloud> geometry;
    draco::Status status;
    if (is_mesh) {
        auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
        status = mesh.status();
        if (mesh.ok()) geometry = std::move(mesh).value();
    } else {
        auto cloud = decoder.DecodePointCloudFromBuffer(&buffer);
        status = cloud.status();
        if (cloud.ok()) geometry = std::move(cloud).value();
    }
    if (geometry == nullptr) {
        malformed("the Draco stream cannot be decoded: ", status.error_msg_string(),
                  "; it is damaged or truncated");
    }
    return geometry;
}

/// Hostile streams decode into attributes that lack values; reading them must stay inside.
void check_attribute(const DracoAttribute& attribute, std::uint32_t points) {
    const std::uint64_t values = attribute.size();
    const bool fits = attribute.buffer() != nullptr && attribute.byte_stride() > 0 &&
                      attribute.byte_offset() >= 0 &&
                      draco::DataTypeLength(attribute.data_type()) > 0 &&
                      attribute.byte_stride() >= attribute.num_components() *
                                                     draco::DataTypeLength(attribute.data_type()) &&
                      attribute.buffer()->data_size() >=
                          static_cast<std::uint64_t>(attribute.byte_offset()) +
                              values * static_cast<std::uint64_t>(attribute.byte_stride());
    bool mapped =
        attribute.is_mapping_identity() ? values >= points : attribute.indices_map_size() >= points;
    for (std::uint32_t i = 0; mapped && !attribute.is_mapping_identity() && i < points; ++i) {
        mapped = attribute.mapped_index(draco::PointIndex(i)).value() < values;
    }
    if (!fits || !mapped) {
        malformed("the Draco stream is damaged: attribute ", attribute.unique_id(),
                  " has fewer values than the points refer to");
    }
}

/// Where the value of component `component` of point `i` lies.
const std::uint8_t* value_address(const DracoAttribute& attribute, std::uint32_t i,
                                  std::size_t component, std::size_t size) {
    return attribute.GetAddressOfMappedIndex(draco::PointIndex(i)) + component * size;
}

template <typename From, typename To>
void copy_component(const DracoAttribute& attribute, std::size_t component, std::uint32_t points,
                    std::byte* target) {
    for (std::uint32_t i = 0; i < points; ++i) {
        From value;
        std::memcpy(&value, value_address(attribute, i, component, sizeof value), sizeof value);
        const To converted = static_cast<To>(value);
        std::memcpy(target + i * sizeof converted, &converted, sizeof converted);
    }
}

template <typename From, typename To = From>
std::vector<std::byte> component_bytes(const DracoAttribute& attribute, std::size_t component,
                                       std::uint32_t points) {
    std::vector<std::byte> bytes(points * sizeof(To));
    copy_component<From, To>(attribute, component, points, bytes.data());
    return bytes;
}

/// One component of an attribute as a column. 64-bit integers become float64, booleans uint8.
Attribute column_of(const DracoAttribute& source, std::size_t component, std::uint32_t points) {
    const auto made = [&](ScalarType type, std::vector<std::byte> data) {
        return Attribute{{}, type, std::move(data), {}, ScalarType::UInt8};
    };
    using enum ScalarType;
    switch (source.data_type()) {
        case draco::DT_INT8:
            return made(Int8, component_bytes<std::int8_t>(source, component, points));
        case draco::DT_UINT8:
            return made(UInt8, component_bytes<std::uint8_t>(source, component, points));
        case draco::DT_BOOL:
            return made(UInt8, component_bytes<std::uint8_t>(source, component, points));
        case draco::DT_INT16:
            return made(Int16, component_bytes<std::int16_t>(source, component, points));
        case draco::DT_UINT16:
            return made(UInt16, component_bytes<std::uint16_t>(source, component, points));
        case draco::DT_INT32:
            return made(Int32, component_bytes<std::int32_t>(source, component, points));
        case draco::DT_UINT32:
            return made(UInt32, component_bytes<std::uint32_t>(source, component, points));
        case draco::DT_INT64:
            return made(Float64, component_bytes<std::int64_t, double>(source, component, points));
        case draco::DT_UINT64:
            return made(Float64, component_bytes<std::uint64_t, double>(source, component, points));
        case draco::DT_FLOAT32:
            return made(Float32, component_bytes<float>(source, component, points));
        case draco::DT_FLOAT64:
            return made(Float64, component_bytes<double>(source, component, points));
        default:
            malformed("Draco attribute ", source.unique_id(), " has the unknown data type ",
                      static_cast<int>(source.data_type()));
    }
}

std::string metadata_text(const draco::Metadata* metadata, const char* entry) {
    std::string text;
    if (metadata != nullptr) (void)metadata->GetEntryString(entry, &text);
    return text;
}

template <std::size_t N>
std::string known_name(const std::array<std::string_view, N>& names, std::string_view base,
                       std::size_t component) {
    if (component < N) return std::string(names[component]);
    return message_of(base, "_", component);
}

std::string column_name(const DracoAttribute& attribute, const std::string& given,
                        std::size_t component) {
    switch (attribute.attribute_type()) {
        case draco::GeometryAttribute::NORMAL:
            return known_name(kNormalColumns, "normal", component);
        case draco::GeometryAttribute::COLOR: return known_name(kColorColumns, "color", component);
        case draco::GeometryAttribute::TEX_COORD:
            return known_name(kTexCoordColumns, "tex_coord", component);
        default: break;
    }
    const std::string base = given.empty() ? message_of("generic_", attribute.unique_id()) : given;
    return attribute.num_components() == 1 ? base : message_of(base, "_", component);
}

template <typename T>
std::vector<std::byte> narrowed(const Attribute& wide) {
    std::vector<std::byte> bytes(wide.rows() * sizeof(T));
    for (std::size_t i = 0; i < wide.rows(); ++i) {
        const double value = value_at(wide, i);
        const bool fits = value >= static_cast<double>(std::numeric_limits<T>::min()) &&
                          value <= static_cast<double>(std::numeric_limits<T>::max());
        const T narrow = fits ? static_cast<T>(value) : T{};
        std::memcpy(bytes.data() + i * sizeof narrow, &narrow, sizeof narrow);
    }
    return bytes;
}

/// Undoes the widening that the writer noted in the metadata.
void restore_type(Attribute& column, const std::string& noted) {
    if (column.type != ScalarType::Float64) return;
    if (noted == ply_type_name(ScalarType::Int32)) {
        column.data = narrowed<std::int32_t>(column);
        column.type = ScalarType::Int32;
    } else if (noted == ply_type_name(ScalarType::UInt32)) {
        column.data = narrowed<std::uint32_t>(column);
        column.type = ScalarType::UInt32;
    }
}

std::vector<std::string> split_lines(std::string_view text) {
    std::vector<std::string> lines;
    constexpr std::size_t kMostText = 16384;  // a PLY header must still hold it
    if (text.size() > kMostText) return lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.push_back(one_line(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

/// Turns a decoded Draco geometry into a document.
class DracoReader {
public:
    explicit DracoReader(const draco::PointCloud& geometry)
        : geometry_(geometry), points_(geometry.num_points()) {}

    Document read() {
        document_.format = FileFormat::Draco;
        const int position = geometry_.GetNamedAttributeId(draco::GeometryAttribute::POSITION);
        if (position < 0) malformed("the Draco stream has no POSITION attribute");
        read_positions(*geometry_.attribute(position));
        for (int id = 0; id < geometry_.num_attributes(); ++id) {
            if (id != position) read_attribute(*geometry_.attribute(id));
        }
        const draco::GeometryMetadata* metadata = geometry_.GetMetadata();
        document_.comments = split_lines(metadata_text(metadata, kDracoCommentEntry));
        document_.obj_info = split_lines(metadata_text(metadata, kDracoObjInfoEntry));
        return std::move(document_);
    }

    void read_faces(const draco::Mesh& mesh, Document& document) const;

private:
    void read_positions(const DracoAttribute& attribute);
    void read_attribute(const DracoAttribute& attribute);

    const draco::PointCloud& geometry_;
    std::uint32_t points_;
    NameSet names_{{"x", "y", "z"}};
    Document document_;
};

void DracoReader::read_positions(const DracoAttribute& attribute) {
    if (attribute.num_components() != 3) {
        malformed("the Draco POSITION attribute has ", int{attribute.num_components()},
                  " components; it must have 3");
    }
    check_attribute(attribute, points_);
    Points& points = document_.shape.cloud.points;
    points.resize(3, points_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Attribute column = column_of(attribute, axis, points_);
        for (std::uint32_t i = 0; i < points_; ++i) {
            points(static_cast<Eigen::Index>(axis), i) = value_at(column, i);
        }
        document_.double_positions |= size_of(column.type) == 8 ||
                                      column.type == ScalarType::Int32 ||
                                      column.type == ScalarType::UInt32;
    }
}

void DracoReader::read_attribute(const DracoAttribute& attribute) {
    check_attribute(attribute, points_);
    const auto components = static_cast<std::size_t>(attribute.num_components());
    std::vector<Attribute>& columns = document_.shape.cloud.attributes;
    if (columns.size() + components + 3 > kMaxPlyProperties) {
        fail(ErrorCode::LimitExceeded, "the Draco stream has more than ", kMaxPlyProperties,
             " values a point, the limit");
    }
    const draco::GeometryMetadata* all = geometry_.GetMetadata();
    const draco::AttributeMetadata* metadata =
        all == nullptr
            ? nullptr
            : all->GetAttributeMetadataByUniqueId(static_cast<std::int32_t>(attribute.unique_id()));
    const std::string given = metadata_text(metadata, kDracoNameEntry).substr(0, 64);
    for (std::size_t component = 0; component < components; ++component) {
        Attribute column = column_of(attribute, component, points_);
        column.name = names_.claim(column_name(attribute, given, component));
        restore_type(column, metadata_text(metadata, kDracoTypeEntry));
        columns.push_back(std::move(column));
    }
}

void DracoReader::read_faces(const draco::Mesh& mesh, Document& document) const {
    Triangles& triangles = document.shape.triangles;
    triangles.resize(3, mesh.num_faces());
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
        const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = face[corner].value();
            if (vertex >= points_) {
                malformed("the Draco stream is damaged: face ", f, " refers to point ", vertex,
                          " of ", points_);
            }
            triangles(static_cast<Eigen::Index>(corner), f) = vertex;
        }
    }
}

void check_decoded_size(const draco::PointCloud& geometry, const DecodeLimits& limits) {
    if (geometry.num_points() > limits.max_points) {
        fail(ErrorCode::LimitExceeded, "the Draco stream has ", geometry.num_points(),
             " points; the limit is ", limits.max_points);
    }
}

}  // namespace

Document decode_draco_unprotected(std::span<const std::byte> bytes, const DecodeLimits& limits) {
    const bool is_mesh = read_draco_claim(bytes).is_mesh;
    const std::unique_ptr<draco::PointCloud> geometry = decode_geometry(bytes, is_mesh);
    check_decoded_size(*geometry, limits);
    DracoReader reader(*geometry);
    Document document = reader.read();
    if (is_mesh) reader.read_faces(static_cast<const draco::Mesh&>(*geometry), document);
    return document;
}

Document decode_draco(std::span<const std::byte> bytes, const DecodeLimits& limits,
                      const Execution& execution) {
    const DracoClaim claim = read_draco_claim(bytes);
    check_draco_claim(claim, bytes.size(), limits);
    if (limits.decode_helper.empty() && !claim.is_current()) {
        fail(ErrorCode::UnsupportedFormat, "Draco bitstream version ", claim.major, ".",
             claim.minor,
             " is too old to be decoded without the helper program lpf-decode; "
             "encode the shape again with a current Draco release");
    }
    Document document = limits.decode_helper.empty()
                            ? decode_draco_unprotected(bytes, limits)
                            : decode_draco_in_child(bytes, claim, limits, execution);
    drop_non_finite_points(document, execution);
    return document;
}

}  // namespace lpf
