#include "api/validation.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "api/measurements_json.h"
#include "api/parameters.h"
#include "api/stored_json.h"

namespace lpf {
namespace {

using nlohmann::json;

constexpr std::uint32_t kFewNeighbours = 8;  // fewer do not make a surface
constexpr double kManyFieldsPerAtom = 4;
constexpr double kWideRadius = 0.25;  // of the diagonal
constexpr std::uint64_t kFewPoints = 500;
constexpr double kManyDuplicates = 0.01;  // of the points
constexpr double kManyOutliers = 0.0005;

template <typename... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    out.precision(4);
    (out << ... << parts);
    return out.str();
}

/// Collects the warnings about one job, one method a subject.
class Foresight {
public:
    Foresight(const Validation& validation, const OddPoints& odd) : v_(validation), odd_(odd) {}

    std::vector<Warning> about(const std::vector<std::string>& rules, const Allowance& allowed) {
        radius();
        if (warnings_.empty())
            for (const std::string& rule : rules) warn("parameters", rule);
        size();
        odd_points();
        options();
        limits(allowed);
        return std::move(warnings_);
    }

private:
    void warn(const char* code, std::string detail) {
        warnings_.push_back({code, std::move(detail)});
    }

    void radius() {
        const double r = v_.neighbours.radius;
        const std::uint32_t median = v_.neighbours.quantile(0.5);
        if (median < kFewNeighbours) {
            warn("radius-too-small",
                 text("Half of the points have ", median, " neighbours or fewer within the radius ",
                      r, " (the mean spacing is ", v_.measurements.mean_spacing,
                      "): there is no surface to learn from. Try radius=8, radiusUnit=spacing."));
        }
        if (r > kWideRadius * v_.measurements.diagonal) {
            warn("radius-too-large",
                 text("The radius ", r, " is more than a quarter of the diagonal ",
                      v_.measurements.diagonal, ": detail will be lost."));
        }
    }

    void size() {
        if (v_.points < kFewPoints) {
            warn("few-points", text("The shape has ", v_.points,
                                    " points; the method shows its strength on thousands."));
        }
        for (const ResolvedParameter& parameter : v_.resolved_parameters) {
            const auto* atoms = std::get_if<double>(&parameter.value);
            if (parameter.name != "atoms" || !atoms) continue;
            if (v_.work.fields < kManyFieldsPerAtom * *atoms) {
                warn("few-fields", text("Only ", std::round(v_.work.fields),
                                        " fields cover the shape, too few to learn ", *atoms,
                                        " atoms from. Take a smaller radius or fewer atoms."));
            }
        }
    }

    void odd_points() {
        const auto points = static_cast<double>(v_.points);
        const bool keeps_duplicates = v_.parameters.duplicates != DuplicatePolicy::Remove;
        if (keeps_duplicates && odd_.duplicates > kManyDuplicates * points) {
            warn("duplicate-points",
                 text("About ", std::round(odd_.duplicates), " of ", v_.points,
                      " points repeat the position of another. duplicates=remove drops them."));
        }
        const bool keeps =
            v_.parameters.outliers.value_or(OutlierPolicy::Keep) == OutlierPolicy::Keep;
        if (keeps && odd_.outliers > kManyOutliers * points) {
            warn("outliers", text("About ", std::round(odd_.outliers),
                                  " points lie apart from all others. outliers=remove drops them, "
                                  "outliers=mark names them."));
        }
    }

    void options() {
        if (v_.parameters.normals == NormalPolicy::Keep && !odd_.has_normals) {
            warn("no-normals", "There are no normals to keep; normals=estimate makes some.");
        }
        if (v_.parameters.radius_unit && !v_.parameters.radius)
            warn("unused-input", "radiusUnit has no effect without a radius.");
        if (v_.parameters.dictionary_mode && !v_.parameters.dictionary)
            warn("unused-input", "dictionaryMode has no effect without a dictionary.");
    }

    void limits(const Allowance& allowed) {
        if (v_.estimate.seconds > allowed.seconds) {
            warn("too-long",
                 text("The job would take about ", v_.estimate.seconds, " s; it is allowed ",
                      allowed.seconds, " s. Ask for less: a larger radius, fewer iterations."));
        }
        if (allowed.memory_bytes > 0 && v_.estimate.memory_bytes > allowed.memory_bytes) {
            warn("too-large",
                 text("The job would need about ", std::ceil(v_.estimate.memory_bytes / (1 << 20)),
                      " MiB of memory; all jobs together may use ",
                      std::floor(allowed.memory_bytes / (1 << 20)),
                      " MiB (memoryBytes). It would be refused."));
        }
    }

    const Validation& v_;
    const OddPoints& odd_;
    std::vector<Warning> warnings_;
};

/// Shares of the points by the number of their neighbours, in steps of a factor of two.
json histogram_of(const std::vector<std::uint32_t>& counts) {
    json bins = json::array();
    std::uint32_t from = 0;
    auto at = counts.begin();
    while (at != counts.end()) {
        const std::uint32_t below = from == 0 ? 1 : 2 * from;
        const auto next = std::lower_bound(at, counts.end(), below);
        const double share = static_cast<double>(next - at) / static_cast<double>(counts.size());
        bins.push_back({{"from", from}, {"to", below - 1}, {"share", share}});
        at = next;
        from = below;
    }
    return bins;
}

json to_json(const NeighbourCounts& neighbours) {
    return {{"radius", neighbours.radius},
            {"p10", neighbours.quantile(0.1)},
            {"median", neighbours.quantile(0.5)},
            {"p90", neighbours.quantile(0.9)},
            {"histogram", histogram_of(neighbours.counts)}};
}

}  // namespace

std::uint32_t NeighbourCounts::quantile(double share) const {
    if (counts.empty()) return 0;
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(counts.size()));
    return counts[std::min(rank, counts.size() - 1)];
}

std::vector<Warning> foresee(const Validation& validation, const OddPoints& odd,
                             const std::vector<std::string>& rules, const Allowance& allowed) {
    return Foresight(validation, odd).about(rules, allowed);
}

json to_json(const Validation& v) {
    json shape = {{"format", v.format},
                  {"points", v.points},
                  {"faces", v.faces},
                  {"examinedShare", v.examined_share}};
    if (!v.shape.empty()) shape["id"] = v.shape;
    return {{"processID", process_id(v.process)},
            {"shape", std::move(shape)},
            {"parameters", to_json(v.process, v.parameters)},
            {"resolvedParameters", to_json(v.resolved_parameters)},
            {"measurements", to_json(v.measurements)},
            {"neighbours", to_json(v.neighbours)},
            {"attributes", to_json(v.attributes)},
            {"estimate", to_json(v.estimate, v.work, v.threads)},
            {"warnings", stored::warnings_to_json(v.warnings)}};
}

}  // namespace lpf
