#include "api/codec/summary.h"

#include <algorithm>
#include <utility>

#include "api/codec/draco.h"
#include "api/codec/draco_child.h"
#include "api/codec/faces.h"
#include "api/codec/ply.h"
#include "api/codec/ply_checks.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

// Rows that are in memory at a time. A row of lists can be long.
constexpr std::size_t kEqualRows = 16384;
constexpr std::size_t kListRows = 128;

Attribute without_rows(std::string name, ScalarType type, bool is_list) {
    return {std::move(name), type, {}, std::vector<std::uint64_t>(is_list ? 1 : 0), {}};
}

FileSummary summary_of(const Document& document, const SummaryOptions& options) {
    FileSummary summary;
    summary.format = document.format;
    summary.points = document.shape.size();
    summary.faces = document.face_count();
    summary.warnings = document.warnings;
    for (const Attribute& attribute : document.shape.cloud.attributes) {
        summary.columns.push_back(
            without_rows(attribute.name, attribute.type, attribute.is_list()));
    }
    const Points& points = document.shape.cloud.points;
    if (points.cols() == 0) return summary;
    summary.minimum = points.rowwise().minCoeff();
    summary.maximum = points.rowwise().maxCoeff();
    const auto most = static_cast<Eigen::Index>(std::max<std::size_t>(options.most_sampled, 1));
    const Eigen::Index stride = 1 + (points.cols() - 1) / most;
    summary.sample.resize(3, (points.cols() + stride - 1) / stride);
    for (Eigen::Index i = 0; i < summary.sample.cols(); ++i) {
        summary.sample.col(i) = points.col(i * stride);
    }
    return summary;
}

/// Walks over a PLY file block by block and keeps nothing but figures.
class PlySurvey {
public:
    PlySurvey(std::span<const std::byte> bytes, const DecodeLimits& limits,
              const SummaryOptions& options, const Execution& execution)
        : bytes_(bytes),
          limits_(limits),
          options_(options),
          execution_(execution),
          header_(parse_ply_header(bytes)) {
        check_ply_claims(header_, bytes.size(), limits);
        vertices_ = &ply_vertices(header_);
        stride_ = 1 + (vertices_->count - std::min<std::uint64_t>(vertices_->count, 1)) /
                          std::max<std::size_t>(options.most_sampled, 1);
        summary_.format = header_.format;
    }

    FileSummary run() {
        note_columns();
        sample_.reserve(3 * (vertices_->count / stride_ + 1));
        PlyPlace place{bytes_, header_.bytes};
        for (const PlyElement& element : header_.elements) walk(element, place);
        if (summary_.points < vertices_->count) {
            if (header_.elements.size() > 1) {
                return summary_of(decode_ply(bytes_, limits_, execution_), options_);
            }
            summary_.warnings.push_back(
                dropped_points_warning(vertices_->count - summary_.points, vertices_->count));
        }
        summary_.sample = Eigen::Map<const Points>(sample_.data(), 3,
                                                   static_cast<Eigen::Index>(sample_.size() / 3));
        return std::move(summary_);
    }

private:
    void note_columns();
    void walk(const PlyElement& element, PlyPlace& place);
    void look_at_points(const PlyTable& table);
    void look_at_faces(PlyTable& table, std::size_t first_face);

    std::span<const std::byte> bytes_;
    const DecodeLimits& limits_;
    const SummaryOptions& options_;
    const Execution& execution_;
    PlyHeader header_;
    const PlyElement* vertices_ = nullptr;
    std::size_t stride_ = 1;
    std::uint64_t triangles_ = 0;
    std::vector<double> sample_;
    FileSummary summary_;
};

void PlySurvey::note_columns() {
    for (const PlyProperty& property : vertices_->properties) {
        const bool coordinate =
            property.name == "x" || property.name == "y" || property.name == "z";
        if (coordinate) continue;
        summary_.columns.push_back(without_rows(property.name, property.type, property.is_list));
    }
}

void PlySurvey::walk(const PlyElement& element, PlyPlace& place) {
    const bool has_list = std::any_of(element.properties.begin(), element.properties.end(),
                                      [](const PlyProperty& property) { return property.is_list; });
    const std::size_t most = has_list ? kListRows : kEqualRows;
    place.row = 0;
    while (place.row < element.count) {
        throw_if_cancelled(execution_);
        const std::size_t first = place.row;
        PlyTable table =
            read_rows(header_.format, element, std::min<std::uint64_t>(most, element.count - first),
                      place, {.threads = 1, .stop = execution_.stop});
        if (&element == vertices_) look_at_points(table);
        if (element.name == "face") look_at_faces(table, first);
        if (options_.passed) options_.passed(place.at);
    }
}

void PlySurvey::look_at_points(const PlyTable& table) {
    Points points(3, static_cast<Eigen::Index>(table.rows));
    for (const PlyColumn& column : table.columns) {
        const std::string& name = column.property().name;
        if (name == "x") fill_coordinate(column, points, 0, {});
        if (name == "y") fill_coordinate(column, points, 1, {});
        if (name == "z") fill_coordinate(column, points, 2, {});
    }
    for (const auto point : points.colwise()) {
        if (!point.allFinite()) continue;
        if (summary_.points == 0) summary_.minimum = summary_.maximum = point;
        summary_.minimum = summary_.minimum.cwiseMin(point);
        summary_.maximum = summary_.maximum.cwiseMax(point);
        if (summary_.points % stride_ == 0) {
            sample_.insert(sample_.end(), point.data(), point.data() + 3);
        }
        ++summary_.points;
    }
}

/// Faces may stand before the vertices; how many of those there will be is in the header.
void PlySurvey::look_at_faces(PlyTable& table, std::size_t first_face) {
    const auto list =
        std::find_if(table.columns.begin(), table.columns.end(),
                     [](const PlyColumn& column) { return is_face_list(column.property()); });
    if (list == table.columns.end()) return;
    Polygons polygons;
    polygons.vertices = vertex_numbers(*list);
    polygons.offsets = list->take_offsets();
    check_vertex_numbers(polygons, first_face, vertices_->count);
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        const std::uint64_t corners = polygons.offsets[f + 1] - polygons.offsets[f];
        if (corners > 2) triangles_ += corners - 2;
    }
    check_triangle_count(triangles_, limits_.max_faces);
    summary_.faces += polygons.size();
}

FileSummary summarize_draco(std::span<const std::byte> bytes, const DecodeLimits& limits,
                            const SummaryOptions& options, const Execution& execution) {
    if (limits.decode_helper.empty()) {
        return summary_of(decode_draco(bytes, limits, execution), options);
    }
    const DracoClaim claim = read_draco_claim(bytes);
    check_draco_claim(claim, bytes.size(), limits);
    HelperStreams streams;
    decode_draco_to_ply(bytes, claim, limits, streams, execution);
    if (options.passed) options.passed(bytes.size());
    SummaryOptions of_result = options;
    of_result.passed = [&](std::size_t done) { streams.out.let_go(done); };
    FileSummary summary = PlySurvey(streams.out.map(), limits, of_result, execution).run();
    summary.format = FileFormat::Draco;
    return summary;
}

}  // namespace

FileSummary summarize(std::span<const std::byte> bytes, const DecodeLimits& limits,
                      const SummaryOptions& options, const Execution& execution) {
    const auto format = sniff(bytes);
    if (format == FileFormat::Draco) return summarize_draco(bytes, limits, options, execution);
    if (!format) return summary_of(decode(bytes, limits, execution), options);  // says what it is
    return PlySurvey(bytes, limits, options, execution).run();
}

}  // namespace lpf
