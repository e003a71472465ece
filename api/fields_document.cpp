#include "api/fields_document.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <utility>

namespace lpf {
namespace {

template <typename T>
std::vector<std::byte> bytes_of(std::span<const T> values) {
    std::vector<std::byte> bytes(values.size_bytes());
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// A float column: one value per frame.
Attribute frame_column(std::string name, const std::vector<Frame>& frames, int row, int column) {
    std::vector<float> values;
    values.reserve(frames.size());
    for (const Frame& frame : frames) values.push_back(frame.axes(row, column));
    return float_attribute(std::move(name), values);
}

void add_frames(PointCloud& cloud, const std::vector<Frame>& frames) {
    constexpr const char* kNames[] = {"t1x", "t1y", "t1z", "t2x", "t2y", "t2z", "nx", "ny", "nz"};
    for (int i = 0; i < 9; ++i) {
        cloud.attributes.push_back(frame_column(kNames[i], frames, i % 3, i / 3));
    }
    std::vector<double> radii;
    radii.reserve(frames.size());
    for (const Frame& frame : frames) radii.push_back(frame.radius);
    cloud.attributes.push_back({.name = "radius",
                                .type = ScalarType::Float64,
                                .data = bytes_of<double>(radii),
                                .list_offsets = {}});
}

/// The codes as lists: which atoms an LPF uses, and how much of each.
void add_codes(PointCloud& cloud, const SparseCodes& codes) {
    std::vector<std::uint16_t> indices;
    std::vector<float> coefficients;
    std::vector<std::uint64_t> offsets{0};
    std::size_t longest = 0;
    for (std::size_t field = 0; field < cloud.size(); ++field) {
        const std::span<const float> code = codes[field];
        for (std::size_t k = 0; k < code.size(); ++k) {
            if (code[k] == 0.0F) continue;
            indices.push_back(static_cast<std::uint16_t>(k));
            coefficients.push_back(code[k]);
        }
        longest = std::max(longest, indices.size() - static_cast<std::size_t>(offsets.back()));
        offsets.push_back(indices.size());
    }
    const ScalarType count = longest <= 255 ? ScalarType::UInt8 : ScalarType::UInt16;
    cloud.attributes.push_back({.name = "atom_indices",
                                .type = ScalarType::UInt16,
                                .data = bytes_of<std::uint16_t>(indices),
                                .list_offsets = offsets,
                                .count_type = count});
    cloud.attributes.push_back({.name = "coefficients",
                                .type = ScalarType::Float32,
                                .data = bytes_of<float>(coefficients),
                                .list_offsets = std::move(offsets),
                                .count_type = count});
}

}  // namespace

Document fields_document(const AnalysisResult& analysis) {
    Document document;
    document.format = FileFormat::PlyBinary;
    document.double_positions = true;
    document.comments = {
        "local probing fields, one vertex each",
        "x y z seed; t1 t2 n frame; radius in the unit of x y z; residual in units of the radius",
        "dimension 0 too few points, 1 curve, 2 surface",
        "atom_indices, coefficients: sparse code over the dictionary of the same job"};
    PointCloud& cloud = document.shape.cloud;
    cloud.points.resize(3, static_cast<Eigen::Index>(analysis.frames.size()));
    for (std::size_t i = 0; i < analysis.frames.size(); ++i) {
        cloud.points.col(static_cast<Eigen::Index>(i)) = analysis.frames[i].seed();
    }
    add_frames(cloud, analysis.frames);
    cloud.attributes.push_back(float_attribute("residual", analysis.residuals));
    cloud.attributes.push_back({.name = "dimension",
                                .type = ScalarType::UInt8,
                                .data = bytes_of<std::uint8_t>(analysis.dimensions),
                                .list_offsets = {}});
    add_codes(cloud, analysis.codes);
    return document;
}

}  // namespace lpf
