#include "core/resampling/proposals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "core/base/random.h"
#include "core/resampling/support.h"

namespace lpf {
namespace {

constexpr std::size_t kFieldsPerChunk = 32;

/// The places of one LPF lie this close at least [tau_p]. With all the LPFs that overlap, the
/// packing is nearly saturated then.
constexpr double kStep = 0.9;
constexpr double kStepOfSearch = 1.0;
constexpr double kStepOfExactSearch = 1.3;
constexpr int kMostSubdivisions = 16;
constexpr int kMostAround = 64;  // a tube

/// Of fewer points, a piece is made by chance.
constexpr std::size_t kFewestOnCurve = 12;
constexpr std::size_t kFewestOnSurface = 16;

/// A gap of so many local spacings belongs to the shape still.
constexpr double kSupportSpacings = 1.2;

using Places = std::vector<Eigen::Vector2f>;

void order_from_centre(Places& places) {
    std::ranges::stable_sort(places, {}, [](const Eigen::Vector2f& p) { return p.squaredNorm(); });
}

/// Places of a lattice in the disk. @param step [radius]
Places lattice(float step) {
    const int half = static_cast<int>(1 / step);
    Places places;
    for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
            const Eigen::Vector2f place(step * static_cast<float>(i), step * static_cast<float>(j));
            if (place.norm() < 1) places.push_back(place);
        }
    }
    return places;
}

/// Places at which an LPF proposes a point, at most `apart` from each other [radius], from the
/// centre outwards: the nodes of the pattern or, where they are too far apart, a finer grid.
Places places_of_nodes(const Pattern& pattern, double apart) {
    const double step = static_cast<double>(pattern.step());
    const int cuts =
        std::clamp(static_cast<int>(std::ceil(step / apart - 1e-9)), 1, kMostSubdivisions);
    Places places;
    if (cuts == 1) {
        for (const int i : pattern.by_distance()) places.push_back(pattern.point(i).head<2>());
        return places;
    }
    places = lattice(pattern.step() / static_cast<float>(cuts));
    order_from_centre(places);
    return places;
}

/// Each is shaken by up to half of `apart` [radius], so that the number of points does not jump
/// where the spacing that is searched for passes a step of the lattice.
void shake(Places& places, double apart) {
    Random random(places.size(), 0x5ba4e);
    for (Eigen::Vector2f& place : places) {
        Eigen::Vector2f shaken = place;
        for (float& x : shaken) x += static_cast<float>(apart * random.uniform(-0.5, 0.5));
        if (shaken.norm() < 1) place = shaken;
    }
    order_from_centre(places);
}

/// Places for points that are searched for by their number, tau apart [radius]: a lattice with as
/// many as they need. What is exact, as a mesh, is known best at the nodes.
Places places_of_search(const Pattern& pattern, double tau, bool is_exact) {
    const double finest = static_cast<double>(pattern.step()) / kMostSubdivisions;
    const double apart = std::max(finest, tau * (is_exact ? kStepOfExactSearch : kStepOfSearch));
    Places places = is_exact ? places_of_nodes(pattern, apart) : lattice(static_cast<float>(apart));
    shake(places, apart);
    return places;
}

/// A field that jumps further between neighbouring nodes leaps from one part of the shape to
/// another; what lies between belongs to neither [steps of the pattern].
constexpr float kLargestJump = 4.0F;

/// Where a field moves a place of the plane; nothing where the field jumps.
std::optional<Eigen::Vector3f> displace(const Pattern& pattern, std::span<const float> field,
                                        const Eigen::Vector2f& place,
                                        const Pattern::Stencil& stencil) {
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

/// What leads to the shape from the middle of two sheets or the axis of a tube at (x, y); nothing
/// but one zero where there is neither.
/// @param apart distance of points around a tube, at most [radius]
void ways_to_sheets(const Piece& piece, float x, float y, double apart,
                    std::vector<Eigen::Vector3f>& ways) {
    const float gap = piece.half_gap(x, y);
    if (gap == 0) {
        ways = {Eigen::Vector3f::Zero()};
    } else if (!piece.is_tube()) {
        ways = {{0, 0, gap}, {0, 0, -gap}};
    } else {
        ways.clear();
        const double turn = 2 * std::numbers::pi;
        const int sides = std::clamp(
            static_cast<int>(std::ceil(turn * static_cast<double>(gap) / apart)), 2, kMostAround);
        for (int k = 0; k < sides; ++k) {
            const auto angle =
                static_cast<float>(turn * k / sides + static_cast<double>(x) / apart);
            ways.emplace_back(0.0F, gap * std::cos(angle), gap * std::sin(angle));
        }
    }
}

}  // namespace

Proposer::Proposer(const FieldSet& fields, const AnalysisResult& analysis,
                   const ResampleParams& params, double spacing)
    : fields_(fields), analysis_(analysis), params_(params), spacing_(spacing) {
    const Pattern& pattern = fields.pattern();
    for (const Frame& frame : fields.frames) {
        const auto [at, is_new] = places_.try_emplace(frame.radius);
        if (!is_new) continue;
        const double tau = spacing / frame.radius;
        const Places places = params.target_points > 0
                                  ? places_of_search(pattern, tau, !params.denoise)
                                  : places_of_nodes(pattern, kStep * tau);
        for (const Eigen::Vector2f& place : places) {
            at->second.push_back({place, pattern.stencil(place.x(), place.y())});
        }
    }
}

double Proposer::mean_places() const {
    double sum = 0.0;
    for (const Frame& frame : fields_.frames) {
        sum += static_cast<double>(places_.at(frame.radius).size());
    }
    return sum / static_cast<double>(fields_.size());
}

Candidates Proposer::propose(std::span<const std::uint32_t> numbers, const Eigen::AlignedBox3d& box,
                             const Execution& execution) const {
    std::vector<Proposals> chunks(chunk_count(numbers.size(), kFieldsPerChunk));
    parallel_for(execution, "propose", "fields", numbers.size(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     FieldSet::Worker worker = fields_.make_worker();
                     for (std::size_t i = begin; i < end; ++i) {
                         propose(numbers[i], box, worker, chunks[chunk]);
                     }
                 });
    std::vector<std::size_t> first(chunks.size() + 1, 0);
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        first[c + 1] = first[c] + chunks[c].field.size();
    }
    Candidates all{Points(3, static_cast<Eigen::Index>(first.back())), {}};
    all.field.resize(first.back());
    parallel_for(execution, chunks.size(), 1, [&](std::size_t c, std::size_t, std::size_t) {
        for (std::size_t i = 0; i < chunks[c].field.size(); ++i) {
            all.points.col(static_cast<Eigen::Index>(first[c] + i)) = chunks[c].points[i];
            all.field[first[c] + i] = chunks[c].field[i];
        }
        chunks[c] = {};
    });
    return all;
}

void Proposer::propose(std::uint32_t j, const Eigen::AlignedBox3d& box, FieldSet::Worker& worker,
                       Proposals& proposals) const {
    TargetArea& target = worker.probe.target;
    fields_.gather(j, target);
    if (!knows_field(j, target)) {
        // It proposes the points themselves, so that nothing sparse is lost.
        for (std::size_t i = 0; i < target.size; ++i) {
            const Eigen::Vector3d point = fields_.grid().point(target.index[i]);
            if (box.contains(point)) proposals.points.push_back(point);
        }
    } else {
        reconstruct(j, worker);
        move_places(j, box, worker, proposals);
    }
    proposals.field.resize(proposals.points.size(), j);
}

/// Whether the field of an LPF says more than its points do.
/// @param target what is gathered of the shape
bool Proposer::knows_field(std::uint32_t j, const TargetArea& target) const {
    if (fields_.dimensions[j] == kTooFewPoints) return false;
    const Piece& piece = fields_.pieces[j];
    if (!piece.exists()) return true;
    return target.size >= (piece.is_curve() ? kFewestOnCurve : kFewestOnSurface);
}

/// Leaves the field that the points are read from in `worker.decoded`.
void Proposer::reconstruct(std::uint32_t j, FieldSet::Worker& worker) const {
    analysis_.dictionary.decode(analysis_.codes[j], worker.decoded);
    if (params_.detail <= 0) return;
    fields_.probe(j, worker.probe, worker.field.data());
    for (std::size_t i = 0; i < worker.decoded.size(); ++i) {
        worker.decoded[i] +=
            static_cast<float>(params_.detail) * (worker.field[i] - worker.decoded[i]);
    }
    fields_.gather(j, worker.probe.target);  // probing has worked on it
}

void Proposer::move_places(std::uint32_t j, const Eigen::AlignedBox3d& box,
                           FieldSet::Worker& worker, Proposals& proposals) const {
    const Frame& frame = fields_.frames[j];
    const Piece& piece = fields_.pieces[j];
    std::optional<Support> support;
    std::vector<Eigen::Vector3f> ways;
    const auto is_supported = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& on_piece) {
        if (params_.support <= 0) return true;
        if (!support) {
            support.emplace(piece, worker.probe.target,
                            support_distance(worker.probe.target, frame.radius));
        }
        return support->covers(p.head<2>(), on_piece);
    };
    for (const Place& place : places_.at(frame.radius)) {
        const auto p = displace(fields_.pattern(), worker.decoded, place.at, place.stencil);
        if (!p) continue;
        Eigen::Vector3f on_piece = *p + piece.shape(p->x(), p->y());
        if (piece.is_curve()) on_piece.y() -= place.at.y();
        ways_to_sheets(piece, p->x(), p->y(), spacing_ / frame.radius, ways);
        std::optional<bool> is_on_shape;
        for (const Eigen::Vector3f& way : ways) {
            const Eigen::Vector3d point = frame.to_world(on_piece + way);
            if (!box.contains(point)) continue;
            if (!is_on_shape) is_on_shape = is_supported(*p, on_piece);
            if (*is_on_shape) proposals.points.push_back(point);
        }
    }
}

/// How far the shape goes on between the points of one target area [radius]: at least the distance
/// given, more where the points are sparser than elsewhere, never more than half the radius.
float Proposer::support_distance(const TargetArea& target, double radius) const {
    const double points = std::max(1.0, static_cast<double>(target.size));
    const double local = std::min(0.5, kSupportSpacings * std::sqrt(std::numbers::pi / points));
    return static_cast<float>(std::max({params_.support / radius, spacing_ / 2 / radius, local}));
}

}  // namespace lpf
