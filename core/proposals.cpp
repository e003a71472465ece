#include "core/proposals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/random.h"

namespace lpf {
namespace {

/// The places of one LPF lie this close at least [tau_p]. With all the LPFs that overlap, the
/// packing is nearly saturated then. A search for a number of points makes do with fewer.
constexpr double kCandidateStep = 0.9;
constexpr double kCandidateStepOfSearch = 1.3;
constexpr int kMostSubdivisions = 16;

/// A gap of so many local spacings belongs to the shape still.
constexpr double kSupportSpacings = 1.2;

/// Places of the plane at which an LPF proposes a point, at most `apart` from each other [input
/// length], ordered from the centre outwards: the nodes of the pattern or, where they are too far
/// apart, a finer grid.
std::vector<Eigen::Vector2f> proposal_places(const Pattern& pattern, double radius, double apart) {
    const double step = static_cast<double>(pattern.step()) * radius;
    const int cuts =
        std::clamp(static_cast<int>(std::ceil(step / apart - 1e-9)), 1, kMostSubdivisions);
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

/// The same places, each shaken by up to half of `apart`: on a grid, the number of points would
/// jump where the spacing that is searched for passes the step of the grid.
void shake(std::vector<Eigen::Vector2f>& places, double apart) {
    Random random(places.size(), 0x5ba4e);
    for (Eigen::Vector2f& place : places) {
        const Eigen::Vector2f shaken =
            place + Eigen::Vector2f(static_cast<float>(random.uniform(-0.5, 0.5) * apart),
                                    static_cast<float>(random.uniform(-0.5, 0.5) * apart));
        if (shaken.norm() < 1) place = shaken;
    }
}

/// Beyond a straight border, the unit vectors to the points near by sum up to this share of their
/// number or more; among points they cancel out.
constexpr float kOneSided = 0.75F;

/// A place so near a point needs no others around it [support distances].
constexpr float kVeryNear = 0.25F;

/// On a slope, the nearest point may be further off than it is in the plane, up to this many times.
/// What a piece says beyond that, where it bends away from its last points, is no part of the
/// shape.
constexpr float kSlope = 1.2F;

/// Whether target points lie around places of the plane: sorted into cells of one support distance.
class Support {
public:
    /// @param target flattened, as the piece says
    Support(const Piece& piece, const TargetArea& target, float distance) : distance_(distance) {
        side_ = static_cast<int>(std::min(256.0F, std::ceil(2 * kReach / distance))) + 1;
        std::vector<int> cell(target.size);
        first_.assign(static_cast<std::size_t>(side_ * side_) + 2, 0);
        for (std::size_t i = 0; i < target.size; ++i) {
            cell[i] = cell_of(target.y[i]) * side_ + cell_of(target.x[i]);
            ++first_[static_cast<std::size_t>(cell[i]) + 2];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        points_.resize(target.size);
        for (std::size_t i = 0; i < target.size; ++i) {
            const std::size_t at = first_[static_cast<std::size_t>(cell[i]) + 1]++;
            points_[at] = {{target.x[i], target.y[i]},
                           Eigen::Vector3f(target.x[i], target.y[i], target.z[i]) +
                               piece.mean(target.x[i], target.y[i])};
        }
    }

    /// A place is on the shape if a point is very near, or if one is within the distance and points
    /// within twice of it do not all lie to one side.
    /// @param on_piece where the piece has the place
    [[nodiscard]] bool covers(const Eigen::Vector2f& place, const Eigen::Vector3f& on_piece) const {
        float nearest = std::numeric_limits<float>::infinity();
        float nearest_in_space = nearest;
        for_each_near(place, 1, [&](const Eigen::Vector2f& apart, const Eigen::Vector3f& point) {
            nearest = std::min(nearest, apart.squaredNorm());
            nearest_in_space = std::min(nearest_in_space, (point - on_piece).squaredNorm());
        });
        if (nearest > distance_ * distance_) return false;
        if (nearest_in_space > kSlope * kSlope * distance_ * distance_) return false;
        if (nearest <= kVeryNear * kVeryNear * distance_ * distance_) return true;
        float count = 0;
        Eigen::Vector2f directions = Eigen::Vector2f::Zero();
        for_each_near(place, 2, [&](const Eigen::Vector2f& apart, const Eigen::Vector3f&) {
            const float squared = apart.squaredNorm();
            if (squared > 4 * distance_ * distance_) return;
            directions += apart / std::sqrt(std::max(squared, 1e-12F));
            count += 1;
        });
        return directions.norm() < kOneSided * count;
    }

private:
    static constexpr float kReach = 2.0F;  // target areas are no wider

    struct Point {
        Eigen::Vector2f in_plane;
        Eigen::Vector3f in_space;
    };

    [[nodiscard]] int cell_of(float coordinate) const {
        const float cell = std::max(distance_, 2 * kReach / 256.0F);
        return std::clamp(static_cast<int>((coordinate + kReach) / cell), 0, side_ - 1);
    }

    /// Visits the points in the cells up to `reach` away from that of the place: from it to each,
    /// and where that is in space.
    template <typename Visit>
    void for_each_near(const Eigen::Vector2f& place, int reach, const Visit& visit) const {
        const int column = cell_of(place.x());
        const int row = cell_of(place.y());
        for (int j = std::max(0, row - reach); j <= std::min(side_ - 1, row + reach); ++j) {
            const auto begin = static_cast<std::size_t>(j * side_ + std::max(0, column - reach));
            const auto last =
                static_cast<std::size_t>(j * side_ + std::min(side_ - 1, column + reach));
            for (std::size_t i = first_[begin]; i < first_[last + 1]; ++i) {
                visit(points_[i].in_plane - place, points_[i].in_space);
            }
        }
    }

    float distance_;
    int side_ = 1;
    std::vector<std::size_t> first_;  // of each cell, into points_
    std::vector<Point> points_;       // cell by cell
};

/// A field that jumps further between neighbouring nodes leaps from one part of the shape to
/// another; what lies between belongs to neither [steps of the pattern].
constexpr float kLargestJump = 4.0F;

/// The place, moved by the field there; nothing where the field jumps.
std::optional<Eigen::Vector3f> displace(const Pattern& pattern, const std::vector<float>& field,
                                        const Eigen::Vector2f& place) {
    const Pattern::Stencil stencil = pattern.stencil(place.x(), place.y());
    const int stride = pattern.padded_size();
    Eigen::Vector3f value(place.x(), place.y(), 0.0F);
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (int k = 0; k < 4; ++k) {
        const float* node = field.data() + stencil.node[k];
        value += stencil.weight[k] * Eigen::Vector3f(node[0], node[stride], node[2 * stride]);
        low = std::min(low, node[2 * stride]);
        high = std::max(high, node[2 * stride]);
    }
    if (high - low > kLargestJump * pattern.step()) return std::nullopt;
    return value;
}

/// How far the shape goes on between the points of one target area [radius]: at least the distance
/// given, more where the points are sparser than elsewhere, never more than half the radius.
float support_distance(const TargetArea& target, double support, double spacing, double radius) {
    const double points = std::max(1.0, static_cast<double>(target.size));
    const double local = std::min(0.5, kSupportSpacings * std::sqrt(std::numbers::pi / points));
    return static_cast<float>(std::max({support / radius, spacing / 2 / radius, local}));
}

/// Eq. 7 for one LPF: the places of its pattern, moved by its reconstructed field, on the piece
/// that it is about.
void propose(const Frame& frame, const Piece& piece, const Pattern& pattern,
             const TargetArea& target, const std::vector<float>& field,
             const std::vector<Eigen::Vector2f>& places, std::optional<float> support,
             std::vector<Eigen::Vector3d>& proposals) {
    std::optional<Support> supported;
    if (support) supported.emplace(piece, target, *support);
    for (const Eigen::Vector2f& place : places) {
        const auto p = displace(pattern, field, place);
        if (!p) continue;
        Eigen::Vector3f on_piece = *p + piece.shape(p->x(), p->y());
        if (piece.is_curve()) on_piece.y() -= place.y();
        if (supported && !supported->covers(p->head<2>(), on_piece)) continue;
        const Eigen::Vector3f gap(0, 0, piece.half_gap(p->x(), p->y()));
        proposals.push_back(frame.to_world(on_piece + gap));
        if (gap.z() > 0) proposals.push_back(frame.to_world(on_piece - gap));
    }
}

/// An LPF of too few points knows no field: it proposes the points themselves, so that nothing
/// sparse is lost.
void propose_points(const Frame& frame, const TargetArea& target,
                    std::vector<Eigen::Vector3d>& proposals) {
    for (std::size_t i = 0; i < target.size; ++i) {
        proposals.push_back(frame.to_world({target.x[i], target.y[i], target.z[i]}));
    }
}

/// LPF by LPF, each from its centre outwards; LPFs are in spatial order, so that the consensus
/// works on what lies together in memory.
Candidates collect(std::vector<std::vector<Eigen::Vector3d>> proposals) {
    std::size_t total = 0;
    for (const auto& of_field : proposals) total += of_field.size();
    Candidates candidates{Points(3, static_cast<Eigen::Index>(total)), {}};
    candidates.field.reserve(total);
    for (std::size_t j = 0; j < proposals.size(); ++j) {
        for (const Eigen::Vector3d& point : proposals[j]) {
            candidates.points.col(static_cast<Eigen::Index>(candidates.size())) = point;
            candidates.field.push_back(static_cast<std::uint32_t>(j));
        }
        std::vector<Eigen::Vector3d>().swap(proposals[j]);
    }
    return candidates;
}

}  // namespace

Candidates propose(const FieldSet& fields, const AnalysisResult& analysis,
                   const ResampleParams& params, double spacing, const Execution& execution) {
    const bool search = params.target_points > 0;
    const double apart = spacing * (search ? kCandidateStepOfSearch : kCandidateStep);
    std::map<double, std::vector<Eigen::Vector2f>> places;  // by the radius of the LPF
    for (const Frame& frame : fields.frames) {
        const auto [at, is_new] = places.try_emplace(frame.radius);
        if (!is_new) continue;
        at->second = proposal_places(fields.pattern(), frame.radius, apart);
        if (search) shake(at->second, apart / frame.radius);
    }
    std::vector<std::vector<Eigen::Vector3d>> proposals(fields.size());
    const auto propose_of = [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
        const TargetArea& target = worker.probe.target;
        const Frame& frame = fields.frames[j];
        if (fields.dimensions[j] == kTooFewPoints) {
            propose_points(frame, target, proposals[j]);
            return;
        }
        analysis.dictionary.decode(analysis.codes[j], worker.decoded);
        for (std::size_t i = 0; i < worker.decoded.size() && params.detail > 0; ++i) {
            worker.decoded[i] +=
                static_cast<float>(params.detail) * (worker.field[i] - worker.decoded[i]);
        }
        std::optional<float> distance;
        if (params.support > 0) {
            distance = support_distance(target, params.support, spacing, frame.radius);
        }
        propose(frame, fields.pieces[j], fields.pattern(), target, worker.decoded,
                places.at(frame.radius), distance, proposals[j]);
    };
    if (params.detail > 0) {
        fields.for_each_probed("propose", execution, 0, propose_of);
    } else {
        fields.for_each_target("propose", execution, propose_of);
    }
    return collect(std::move(proposals));
}

}  // namespace lpf
