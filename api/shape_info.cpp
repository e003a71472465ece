#include "api/shape_info.h"

#include <nlohmann/json.hpp>

#include "api/link.h"
#include "api/stored_json.h"

namespace lpf {
namespace {

using nlohmann::json;

json vector_to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d vector_from_json(const json& stored, const std::string& name) {
    const auto values = stored::need<std::vector<double>>(stored, name);
    if (values.size() != 3) stored::damaged(name);
    return {values[0], values[1], values[2]};
}

}  // namespace

std::string_view scalar_type_name(ScalarType type) {
    switch (type) {
        case ScalarType::Int8: return "int8";
        case ScalarType::UInt8: return "uint8";
        case ScalarType::Int16: return "int16";
        case ScalarType::UInt16: return "uint16";
        case ScalarType::Int32: return "int32";
        case ScalarType::UInt32: return "uint32";
        case ScalarType::Float32: return "float32";
        case ScalarType::Float64: return "float64";
    }
    return "";
}

std::vector<AttributeInfo> attribute_infos(const PointCloud& cloud) {
    std::vector<AttributeInfo> infos;
    for (const Attribute& attribute : cloud.attributes) {
        infos.push_back({.name = attribute.name,
                         .type = std::string(scalar_type_name(attribute.type)),
                         .list = attribute.is_list()});
    }
    return infos;
}

Bounds bounds_of(const Points& points) {
    return {.minimum = points.rowwise().minCoeff(), .maximum = points.rowwise().maxCoeff()};
}

json to_json(const Bounds& bounds) {
    return {{"min", vector_to_json(bounds.minimum)}, {"max", vector_to_json(bounds.maximum)}};
}

json to_json(const ShapeInfo& info) {
    const std::string self = "/v1/shapes/" + info.id;
    json attributes = json::array();
    for (const AttributeInfo& a : info.attributes) {
        attributes.push_back({{"name", a.name}, {"type", a.type}, {"list", a.list}});
    }
    json result = {{"id", info.id},
                   {"format", info.format},
                   {"bytes", info.bytes},
                   {"sha256", info.sha256},
                   {"points", info.points},
                   {"faces", info.faces},
                   {"attributes", std::move(attributes)},
                   {"created", to_rfc3339(info.created)},
                   {"warnings", stored::warnings_to_json(info.warnings)},
                   {"links",
                    {to_json(Link{.href = self, .rel = "self"}),
                     to_json(Link{.href = self + "/data",
                                  .rel = "enclosure",
                                  .type = "application/octet-stream",
                                  .title = "The bytes as they were uploaded"})}}};
    if (info.bounds) result["bounds"] = to_json(*info.bounds);
    if (info.mean_spacing) result["meanSpacing"] = *info.mean_spacing;
    if (info.expires) result["expires"] = to_rfc3339(*info.expires);
    return result;
}

ShapeInfo shape_from_json(const json& stored) {
    ShapeInfo info;
    info.id = stored::need<std::string>(stored, "id");
    info.format = stored::need<std::string>(stored, "format");
    info.bytes = stored::need<std::uint64_t>(stored, "bytes");
    info.sha256 = stored::need<std::string>(stored, "sha256");
    info.points = stored::need<std::uint64_t>(stored, "points");
    info.faces = stored::need<std::uint64_t>(stored, "faces");
    for (const auto& a : stored::need<json>(stored, "attributes")) {
        info.attributes.push_back({.name = stored::need<std::string>(a, "name"),
                                   .type = stored::need<std::string>(a, "type"),
                                   .list = stored::need<bool>(a, "list")});
    }
    if (const auto bounds = stored::maybe<json>(stored, "bounds")) {
        info.bounds = Bounds{.minimum = vector_from_json(*bounds, "min"),
                             .maximum = vector_from_json(*bounds, "max")};
    }
    info.mean_spacing = stored::maybe<double>(stored, "meanSpacing");
    info.created = stored::need_time(stored, "created");
    info.expires = stored::maybe_time(stored, "expires");
    info.warnings = stored::warnings_from_json(stored);
    return info;
}

}  // namespace lpf
