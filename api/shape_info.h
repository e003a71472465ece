#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/job.h"
#include "api/time_text.h"
#include "core/shape/shape.h"

namespace lpf {

/// A vertex attribute, as it is told to the client.
struct AttributeInfo {
    std::string name;
    std::string type;   ///< "uint8", "float32", ...
    bool list = false;  ///< a list of such values a point

    bool operator==(const AttributeInfo&) const = default;
};

/// "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64".
[[nodiscard]] std::string_view scalar_type_name(ScalarType type);

[[nodiscard]] std::vector<AttributeInfo> attribute_infos(const PointCloud& cloud);

/// Axis-aligned box [input length].
struct Bounds {
    Eigen::Vector3d minimum = Eigen::Vector3d::Zero();
    Eigen::Vector3d maximum = Eigen::Vector3d::Zero();
};

/// @pre points.cols() > 0
[[nodiscard]] Bounds bounds_of(const Points& points);

/// {"min":[x,y,z],"max":[x,y,z]}
[[nodiscard]] nlohmann::json to_json(const Bounds& bounds);

/// An uploaded shape: stored by the server, answered by GET /v1/shapes/{id}.
struct ShapeInfo {
    std::string id;      ///< UUIDv7
    std::string format;  ///< "ply" or "drc"
    std::uint64_t bytes = 0;
    std::string sha256;  ///< 64 hexadecimal digits
    std::uint64_t points = 0;
    std::uint64_t faces = 0;
    std::vector<AttributeInfo> attributes;
    std::optional<Bounds> bounds;        ///< none for a shape without points
    std::optional<double> mean_spacing;  ///< none where it cannot be measured
    UnixMillis created = 0;
    std::optional<UnixMillis> expires;
    std::vector<Warning> warnings;  ///< e.g. points that were not finite
};

[[nodiscard]] nlohmann::json to_json(const ShapeInfo& info);

/// The inverse. @throws lpf::Error{StorageFailure} if a needed member is missing or of the wrong
/// type
[[nodiscard]] ShapeInfo shape_from_json(const nlohmann::json& json);

}  // namespace lpf
