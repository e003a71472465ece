#include "api/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "api/analysis_json.h"
#include "api/measurements_json.h"
#include "api/parameters.h"
#include "api/stored_json.h"

namespace lpf {
namespace {

using nlohmann::json;

/// The smallest value that at least `share` of all values do not exceed; values are put in order
/// about it. @pre not empty
template <typename Length>
double quantile(std::span<Length> values, double share) {
    const auto rank = std::ceil(share * static_cast<double>(values.size()));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::ranges::nth_element(values, at);
    return static_cast<double>(*at);
}

/// @param lengths will be put in another order
template <typename Length>
DisplacementStatistics statistics_of(std::span<Length> lengths) {
    if (lengths.empty()) return {};
    const auto n = static_cast<double>(lengths.size());
    double sum = 0.0;
    double squares = 0.0;
    for (const Length value : lengths) {
        const auto length = static_cast<double>(value);
        sum += length;
        squares += length * length;
    }
    return {.rms = std::sqrt(squares / n),
            .mean = sum / n,
            .p50 = quantile(lengths, 0.5),
            .p90 = quantile(lengths, 0.9),
            .p99 = quantile(lengths, 0.99),
            .max = static_cast<double>(*std::ranges::max_element(lengths))};
}

json shape_to_json(std::uint64_t points, const std::optional<Bounds>& bounds) {
    json result = {{"points", points}};
    if (bounds) result["bounds"] = to_json(*bounds);
    return result;
}

json phases_to_json(const std::vector<std::pair<std::string, double>>& phases) {
    json result = json::array();
    for (const auto& [phase, seconds] : phases) {
        result.push_back({{"phase", phase}, {"seconds", seconds}});
    }
    return result;
}

json displacement_to_json(const DisplacementStatistics& d) {
    return {{"rms", d.rms}, {"mean", d.mean}, {"p50", d.p50},
            {"p90", d.p90}, {"p99", d.p99},   {"max", d.max}};
}

}  // namespace

DisplacementStatistics displacement_statistics(const Points& before, const Points& after) {
    std::vector<double> lengths(static_cast<std::size_t>(before.cols()));
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
        lengths[static_cast<std::size_t>(i)] = (after.col(i) - before.col(i)).norm();
    }
    return statistics_of(std::span(lengths));
}

DisplacementStatistics displacement_statistics(std::vector<float> lengths) {
    return statistics_of(std::span(lengths));
}

json to_json(const Report& report) {
    json input = shape_to_json(report.input_points, report.input_bounds);
    input["faces"] = report.input_faces;
    json result = {{"version", report.version},
                   {"jobID", report.job_id},
                   {"processID", process_id(report.process)},
                   {"input", std::move(input)},
                   {"measurements", to_json(report.measurements)},
                   {"resolvedParameters", to_json(report.resolved_parameters)},
                   {"fields", report.fields},
                   {"energy", energy_to_json(report.energy)},
                   {"energySteps", energy_steps_to_json(report.energy)},
                   {"outliers", report.outliers},
                   {"duplicates", report.duplicates},
                   {"nonFinite", report.non_finite},
                   {"phases", phases_to_json(report.phase_seconds)},
                   {"seconds", report.total_seconds},
                   {"threads", report.threads},
                   {"warnings", stored::warnings_to_json(report.warnings)}};
    if (report.process != Task::Analyze) {
        result["output"] = shape_to_json(report.output_points, report.output_bounds);
    }
    if (report.process == Task::Denoise) result["rmsMoves"] = report.rms_moves;
    if (report.displacement) result["displacement"] = displacement_to_json(*report.displacement);
    if (report.peak_memory_bytes) result["peakMemoryBytes"] = *report.peak_memory_bytes;
    return result;
}

}  // namespace lpf
