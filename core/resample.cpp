#include "core/resample.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/consensus.h"
#include "core/field_set.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr double kCountTolerance = 0.02;
constexpr int kMostSearchRounds = 8;

/// The places of one LPF lie this close at least [tau_p]. With all the LPFs that overlap, the
/// packing is nearly saturated then, and dense enough for a search to end at a smaller spacing.
constexpr double kCandidateStep = 0.9;
constexpr int kMostSubdivisions = 16;

/// A gap of so many local spacings belongs to the shape still.
constexpr double kSupportSpacings = 1.2;

/// Places of the plane at which an LPF proposes a point: the nodes of the pattern and, where they
/// are too far apart for the spacing, places between them. Ordered from the centre outwards.
std::vector<Eigen::Vector2f> proposal_places(const Pattern& pattern, double radius,
                                             double spacing) {
    const double step = static_cast<double>(pattern.step()) * radius;
    const int cuts =
        std::clamp(static_cast<int>(std::ceil(step / (kCandidateStep * spacing) - 1e-9)), 1,
                   kMostSubdivisions);
    std::vector<Eigen::Vector2f> places;
    if (cuts == 1) {
        for (const int i : pattern.by_distance()) places.push_back(pattern.point(i).head<2>());
        return places;
    }
    const float fine = pattern.step() / static_cast<float>(cuts);
    const int half = static_cast<int>(1.0F / fine);
    for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
            const Eigen::Vector2f place(fine * static_cast<float>(i), fine * static_cast<float>(j));
            if (place.norm() < 1) places.push_back(place);
        }
    }
    std::ranges::stable_sort(places, {}, [](const Eigen::Vector2f& p) { return p.squaredNorm(); });
    return places;
}

/// Whether target points lie near places of the plane: cells of one support distance.
class Support {
public:
    Support(const TargetArea& target, float distance) : distance_(distance) {
        side_ = static_cast<int>(std::min(256.0F, std::ceil(2 * kReach / distance))) + 1;
        cells_.resize(static_cast<std::size_t>(side_ * side_));
        for (std::size_t i = 0; i < target.size; ++i) {
            cells_[static_cast<std::size_t>(cell_of(target.y[i]) * side_ + cell_of(target.x[i]))]
                .emplace_back(target.x[i], target.y[i]);
        }
    }

    [[nodiscard]] bool covers(float x, float y) const {
        for (int j = std::max(0, cell_of(y) - 1); j <= std::min(side_ - 1, cell_of(y) + 1); ++j) {
            for (int i = std::max(0, cell_of(x) - 1); i <= std::min(side_ - 1, cell_of(x) + 1);
                 ++i) {
                for (const Eigen::Vector2f& p : cells_[static_cast<std::size_t>(j * side_ + i)]) {
                    if ((p - Eigen::Vector2f(x, y)).squaredNorm() <= distance_ * distance_) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

private:
    static constexpr float kReach = 2.0F;  // target areas are no wider

    [[nodiscard]] int cell_of(float coordinate) const {
        const float cell = std::max(distance_, 2 * kReach / 256.0F);
        return std::clamp(static_cast<int>((coordinate + kReach) / cell), 0, side_ - 1);
    }

    float distance_;
    int side_ = 1;
    std::vector<std::vector<Eigen::Vector2f>> cells_;
};

Eigen::Vector3f interpolate(const Pattern& pattern, const std::vector<float>& field,
                            const Eigen::Vector2f& place) {
    const Pattern::Stencil stencil = pattern.stencil(place.x(), place.y());
    const int stride = pattern.padded_size();
    Eigen::Vector3f value(place.x(), place.y(), 0.0F);
    for (int k = 0; k < 4; ++k) {
        const float* node = field.data() + stencil.node[k];
        value += stencil.weight[k] * Eigen::Vector3f(node[0], node[stride], node[2 * stride]);
    }
    return value;
}

/// How far the shape goes on between the points of one target area [radius]: at least the distance
/// given, more where the points are sparser than elsewhere, never more than half the radius.
float support_distance(const TargetArea& target, double support, double spacing, double radius) {
    const double points = std::max(1.0, static_cast<double>(target.size));
    const double local = std::min(0.5, kSupportSpacings * std::sqrt(std::numbers::pi / points));
    return static_cast<float>(std::max({support / radius, spacing / 2 / radius, local}));
}

/// Eq. 7 for one LPF: the places of its pattern, moved by its reconstructed field. An LPF of too
/// few points knows no field: it proposes the points themselves, so that nothing sparse is lost.
void propose(const Frame& frame, const Pattern& pattern, const TargetArea& target,
             const std::vector<float>& field, const std::vector<Eigen::Vector2f>& places,
             float support, std::vector<Eigen::Vector3d>& proposals) {
    const Support supported(target, support);
    for (const Eigen::Vector2f& place : places) {
        const Eigen::Vector3f p = interpolate(pattern, field, place);
        if (supported.covers(p.x(), p.y())) proposals.push_back(frame.to_world(p));
    }
}

void propose_points(const Frame& frame, const TargetArea& target,
                    std::vector<Eigen::Vector3d>& proposals) {
    for (std::size_t i = 0; i < target.size; ++i) {
        proposals.push_back(frame.to_world({target.x[i], target.y[i], target.z[i]}));
    }
}

/// LPF by LPF, each from its centre outwards; LPFs are in spatial order, so that the consensus
/// works on what lies together in memory.
Candidates collect(const std::vector<std::vector<Eigen::Vector3d>>& proposals) {
    std::size_t total = 0;
    for (const auto& of_field : proposals) total += of_field.size();
    Candidates candidates{Points(3, static_cast<Eigen::Index>(total)), {}};
    candidates.field.reserve(total);
    for (std::size_t j = 0; j < proposals.size(); ++j) {
        for (const Eigen::Vector3d& point : proposals[j]) {
            candidates.points.col(static_cast<Eigen::Index>(candidates.size())) = point;
            candidates.field.push_back(static_cast<std::uint32_t>(j));
        }
    }
    return candidates;
}

Candidates propose(const FieldSet& fields, const AnalysisResult& analysis, double spacing,
                   double support, const Execution& execution) {
    constexpr float kEverywhere = 10.0F;
    const auto places = proposal_places(fields.pattern(), analysis.radius, spacing);
    std::vector<std::vector<Eigen::Vector3d>> proposals(fields.size());
    fields.for_each_target(
        "propose", execution, [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
            const TargetArea& target = worker.probe.target;
            const Frame& frame = fields.frames[j];
            if (fields.dimensions[j] == kTooFewPoints) {
                propose_points(frame, target, proposals[j]);
                return;
            }
            analysis.dictionary.decode(analysis.codes[j], worker.decoded);
            const float distance = support > 0
                                       ? support_distance(target, support, spacing, frame.radius)
                                       : kEverywhere;
            propose(frame, fields.pattern(), target, worker.decoded, places, distance,
                    proposals[j]);
        });
    return collect(proposals);
}

/// Spacing first, then count: the number of points falls with the square of the spacing on a
/// surface, linearly on a curve; the exponent is taken from the last two tries.
class SpacingSearch {
public:
    SpacingSearch(double first, std::size_t wanted)
        : spacing_(first), wanted_(static_cast<double>(wanted)) {}

    [[nodiscard]] double spacing() const { return spacing_; }

    /// @returns whether `count` points at the current spacing are near enough to those wanted
    bool accepts(std::size_t count) {
        const double found = std::max<double>(1, static_cast<double>(count));
        if (std::abs(found - wanted_) <= kCountTolerance / 2 * wanted_) return true;
        if (last_count_ > 0 && found != last_count_) {
            exponent_ = std::clamp(
                std::log(found / last_count_) / std::log(last_spacing_ / spacing_), 0.7, 3.0);
        }
        last_spacing_ = spacing_;
        last_count_ = found;
        spacing_ *= std::pow(found / wanted_, 1 / exponent_);
        return false;
    }

private:
    double spacing_;
    double wanted_;
    double exponent_ = 2.0;
    double last_spacing_ = 0.0;
    double last_count_ = 0.0;
};

std::vector<std::uint32_t> nearest_sources(const Points& input, const Points& points,
                                           const Execution& execution) {
    const SpatialIndex index(input);
    std::vector<std::uint32_t> source(static_cast<std::size_t>(points.cols()));
    parallel_for(execution, "attributes", "points", source.size(), 4096,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         source[i] =
                             index.nearest(points.col(static_cast<Eigen::Index>(i)), 1)[0].index;
                     }
                 });
    return source;
}

void validate(const ResampleParams& params) {
    validate(params.analysis);
    if ((params.target_spacing > 0) == (params.target_points > 0)) {
        throw Error(ErrorCode::InvalidParameter,
                    "Resampling needs either a target spacing or a target number of points.",
                    "targetSpacing");
    }
}

/// First guess of tau_p for a number of points, from the area that the disks of all LPFs suggest:
/// seeds are a packing themselves.
double guess_spacing(const FieldSet& fields, const AnalysisParams& params, std::size_t wanted) {
    const double seeds_apart = std::max(params.seed_spacing, 0.05);
    double area = 0.0;
    for (const Frame& frame : fields.frames) {
        area += seeds_apart * seeds_apart * frame.radius * frame.radius;
    }
    return std::sqrt(area / static_cast<double>(wanted));
}

}  // namespace

ResampleResult resample(const Shape& shape, const ResampleParams& params,
                        const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points);
    Shape smooth{{shape.cloud.points, {}}, shape.triangles};
    if (params.denoise) {
        smooth.cloud.points = denoise(shape, *params.denoise, part_of(execution, 0.0, 0.4)).points;
    }
    const Execution rest = part_of(execution, params.denoise ? 0.4 : 0.0, 1.0);
    FieldSet fields(smooth, params.analysis, part_of(rest, 0.0, 0.02));
    fields.optimise_poses(params.analysis.pose_iterations, part_of(rest, 0.02, 0.1));
    AnalysisResult analysis = analyze(fields, params.analysis, part_of(rest, 0.1, 0.5));

    const bool by_count = params.target_points > 0;
    SpacingSearch search(by_count ? guess_spacing(fields, params.analysis, params.target_points)
                                  : params.target_spacing,
                         params.target_points);
    Candidates candidates;
    Candidates found;
    double spacing = search.spacing();
    const int rounds = by_count ? kMostSearchRounds : 1;
    for (int round = 0; round < rounds; ++round) {
        const double low = 0.5 + 0.4 * round / rounds;
        const double high = 0.5 + 0.4 * (round + 1) / rounds;
        spacing = search.spacing();
        // A finer lattice of places makes a denser packing. After the second try of a search the
        // places stay, so that the number of points changes with the spacing alone.
        if (round < 2) {
            candidates = propose(fields, analysis, spacing, params.support,
                                 part_of(rest, low, (low + high) / 2));
        }
        found = find_consensus(candidates, spacing, part_of(rest, (low + high) / 2, high));
        if (by_count && search.accepts(found.size())) break;
    }

    ResampleResult result{
        std::move(found.points), {}, std::move(found.field), spacing, std::move(analysis)};
    result.source = nearest_sources(shape.cloud.points, result.points, part_of(rest, 0.9, 1.0));
    return result;
}

}  // namespace lpf
