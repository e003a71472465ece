#include "server/work/preparation.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/shape/extent.h"
#include "core/shape/normals.h"
#include "core/shape/outliers.h"

namespace lpf::server {
namespace {

constexpr double kOutlierDeviations = 6.0;  // far out: an ordinary scan loses next to nothing
constexpr int kNormalNeighbours = 16;
constexpr std::array<const char*, 3> kNormalNames{"nx", "ny", "nz"};

using Flags = std::vector<std::uint8_t>;

std::uint64_t count(const Flags& flags) {
    return static_cast<std::uint64_t>(std::count(flags.begin(), flags.end(), 1));
}

/// The document with only the points that are not flagged.
Document without(const Document& document, const Flags& flags, const Execution& execution) {
    std::vector<std::uint32_t> rows;
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (!flags[i]) rows.push_back(static_cast<std::uint32_t>(i));
    const PointCloud& cloud = document.shape.cloud;
    PointCloud kept{selected(cloud.points, rows, execution), {}};
    for (const Attribute& attribute : cloud.attributes) {
        throw_if_cancelled(execution);
        kept.attributes.push_back(gather(attribute, rows));
    }
    return with_points(document, std::move(kept), false);
}

void remove_attribute(PointCloud& cloud, const std::string& name) {
    std::erase_if(cloud.attributes, [&](const Attribute& a) { return a.name == name; });
}

void mark(PointCloud& cloud, const Flags& flags) {
    remove_attribute(cloud, "outlier");
    Attribute attribute{
        .name = "outlier", .type = ScalarType::UInt8, .data = {}, .list_offsets = {}};
    attribute.data.resize(flags.size());
    std::memcpy(attribute.data.data(), flags.data(), flags.size());
    cloud.attributes.push_back(std::move(attribute));
}

void replace_normals(PointCloud& cloud, const Execution& execution) {
    const Eigen::Matrix3Xf normals = estimate_normals(cloud.points, kNormalNeighbours, execution);
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::VectorXf row = normals.row(axis);
        remove_attribute(cloud, kNormalNames[static_cast<std::size_t>(axis)]);
        cloud.attributes.push_back(
            float_attribute(kNormalNames[static_cast<std::size_t>(axis)],
                            {row.data(), static_cast<std::size_t>(row.size())}));
    }
}

void apply_normals(PointCloud& cloud, NormalPolicy policy, const Execution& execution) {
    if (policy == NormalPolicy::Estimate) replace_normals(cloud, execution);
    if (policy == NormalPolicy::Drop)
        for (const char* name : kNormalNames) remove_attribute(cloud, name);
}

std::vector<Attribute> carried(const PointCloud& source, const Computation& result,
                               const Execution& execution) {
    if (result.keeps_vertices()) return source.attributes;
    std::vector<Attribute> attributes;
    for (const Attribute& attribute : source.attributes) {
        throw_if_cancelled(execution);
        attributes.push_back(gather(attribute, result.source));
    }
    return attributes;
}

Document remove_duplicates(Document document, const JobInputs& inputs, const Execution& execution,
                           RunningJob& job, Report& report) {
    const Flags flags = find_duplicates(document.shape.cloud.points, execution);
    report.duplicates = count(flags);
    if (report.duplicates == 0) return document;
    const DuplicatePolicy policy = inputs.duplicates.value_or(DuplicatePolicy::Keep);
    tell_duplicates(report.duplicates, policy, job);
    return policy == DuplicatePolicy::Remove ? without(document, flags, execution) : document;
}

Document treat_outliers(Document document, const JobInputs& inputs, const Execution& execution,
                        RunningJob& job, Report& report) {
    const OutlierPolicy policy = inputs.outliers.value_or(OutlierPolicy::Keep);
    if (policy == OutlierPolicy::Keep) return document;
    const Flags flags = find_outliers(document.shape.cloud.points, kOutlierDeviations, execution);
    report.outliers = count(flags);
    if (policy == OutlierPolicy::Mark) {
        mark(document.shape.cloud, flags);
        return document;
    }
    if (report.outliers == 0) return document;
    job.warn("outliers-removed",
             std::to_string(report.outliers) + " isolated points were removed.");
    return without(document, flags, execution);
}

Report report_of(const StatusInfo& job, const std::string& version, int threads) {
    Report report;
    report.version = version;
    report.job_id = job.job_id;
    report.process = job.process;
    report.threads = threads;
    return report;
}

/// Warnings that this step added to a document, told to the job.
Document tell_new_warnings(Document document, std::size_t known, RunningJob& job) {
    for (std::size_t i = known; i < document.warnings.size(); ++i)
        job.warn(document.warnings[i].code, document.warnings[i].detail);
    return document;
}

}  // namespace

Report start_report(const StatusInfo& job, const Document& document, const std::string& version,
                    int threads) {
    Report report = report_of(job, version, threads);
    report.input_points = document.shape.size() + document.dropped_points;
    report.input_faces = document.face_count();
    report.non_finite = document.dropped_points;
    if (document.shape.size() > 0) report.input_bounds = bounds_of(document.shape.cloud.points);
    return report;
}

Report start_report(const StatusInfo& job, const ShapeInfo& shape, std::size_t rows,
                    const std::string& version, int threads) {
    Report report = report_of(job, version, threads);
    report.input_points = rows;
    report.non_finite = rows - std::min<std::size_t>(rows, shape.points);
    report.input_bounds = shape.bounds;
    return report;
}

void tell_duplicates(std::uint64_t count, DuplicatePolicy policy, RunningJob& job) {
    if (count == 0) return;
    job.warn("duplicate-points",
             std::to_string(count) + " points repeat the position of an earlier one; they were " +
                 (policy == DuplicatePolicy::Remove ? "removed."
                                                    : "kept (duplicates=remove drops them)."));
}

Document apply_policies(Document document, const JobInputs& inputs, const Execution& execution,
                        RunningJob& job, Report& report) {
    const std::size_t known = document.warnings.size();
    document =
        remove_duplicates(std::move(document), inputs, part_of(execution, 0, 0.4), job, report);
    document = treat_outliers(std::move(document), inputs, part_of(execution, 0.4, 1), job, report);
    return tell_new_warnings(std::move(document), known, job);
}

Document carry_attributes(Document document, Computation& result, const JobInputs& inputs,
                          const Execution& execution, RunningJob& job, Report& report) {
    const std::size_t known = document.warnings.size();
    if (result.keeps_vertices()) {
        report.displacement = displacement_statistics(document.shape.cloud.points, *result.points);
    }
    PointCloud cloud;
    cloud.points = std::move(*result.points);
    if (inputs.attributes != AttributePolicy::Drop)
        cloud.attributes = carried(document.shape.cloud, result, execution);
    apply_normals(cloud, inputs.normals.value_or(NormalPolicy::Keep), execution);
    report.output_points = cloud.size();
    report.output_bounds = bounds_of(cloud.points);
    document = with_points(document, std::move(cloud), result.keeps_vertices());
    return tell_new_warnings(std::move(document), known, job);
}

void finish_report(Report& report, const AnalysisResult& analysis,
                   const std::vector<double>& rms_moves, const StatusInfo& job) {
    report.fields = analysis.frames.size();
    report.energy = analysis.energy;
    report.rms_moves = rms_moves;
    report.resolved_parameters = job.resolved_parameters;
    report.warnings = job.warnings;
}

}  // namespace lpf::server
