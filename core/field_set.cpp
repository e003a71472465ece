#include "core/field_set.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/kernels.h"
#include "core/field/seed_sizes.h"
#include "core/field/seeding.h"
#include "core/learn/pose.h"

namespace lpf {
namespace {

constexpr std::size_t kFieldsPerChunk = 32;

/// Cells of about the radius make a ball of 1.1 radii span few of them. Where LPFs may be smaller,
/// and large target areas are thinned in the order of the grid, finer ones are better.
constexpr double kCellPerRadius = 1.0;
constexpr double kFineCellPerRadius = 0.55;

/// A chunk for each turn: not one next to that of the turn before. Threads that take turns would
/// otherwise write to the same points.
std::size_t far_from_last(std::size_t turn, std::size_t chunks) {
    return turn / 2 + (turn % 2) * ((chunks + 1) / 2);
}

/// Samples of a mesh lie this close, so that no triangle of a target area is missed.
constexpr double kMeshSampleSpacing = 0.1;

MeshSamples mesh_samples(const Shape& shape, const AnalysisParams& params) {
    if (params.probing != ProbingKind::NearestTriangle) return {};
    if (!shape.is_mesh()) {
        throw Error(ErrorCode::InvalidParameter,
                    "Probing on the nearest triangle needs a mesh; this shape has no triangles.",
                    "probing");
    }
    return sample_mesh(shape, kMeshSampleSpacing * params.radius);
}

SeedingParams seeding_params(const AnalysisParams& params) {
    return {.radius = params.radius,
            .spacing = params.seed_spacing,
            .target_radius = params.target_radius,
            .noise = params.noise,
            .noise_map = params.noise_map,
            .adapt_radius = params.adapt_radius,
            .least_radius = params.least_radius,
            .random_seed = params.random_seed};
}

}  // namespace

Pattern make_pattern(const AnalysisParams& params) {
    if (params.initial_dictionary) return params.initial_dictionary->pattern();
    switch (params.pattern.kind) {
        case PatternKind::Grid: return Pattern::grid(Pattern::grid_size_for(params.pattern.points));
        case PatternKind::RandomDisk:
            return Pattern::random_disk(params.pattern.points, params.random_seed);
        case PatternKind::Custom: return Pattern::from_points(params.pattern.offsets);
    }
    throw Error(ErrorCode::Internal, "Unknown kind of pattern.");
}

double reach_of_fields(const AnalysisParams& params) {
    // An LPF moves what lies in its target area, and is made from all that lies there.
    return 2 * params.target_radius * largest_radius(seeding_params(params));
}

FieldSet::FieldSet(const Shape& shape, const AnalysisParams& params, const Execution& execution,
                   const Region& region)
    : pattern_(make_pattern(params)),
      samples_(mesh_samples(shape, params)),
      grid_(samples_.triangle.empty() ? shape.cloud.points : samples_.points,
            (params.noise > 0 ? kFineCellPerRadius : kCellPerRadius) * params.radius, execution),
      radius_(params.radius),
      target_radius_(static_cast<float>(params.target_radius)) {
    switch (params.probing) {
        case ProbingKind::AsOrthogonalAsPossible:
            operator_ = make_orthogonal_probing(pattern_);
            break;
        case ProbingKind::NoiseAware:
            operator_ = make_noise_aware_probing(pattern_, params.smoothing);
            break;
        case ProbingKind::NearestPoint: operator_ = make_nearest_point_probing(pattern_); break;
        case ProbingKind::NearestTriangle:
            operator_ = make_nearest_triangle_probing(pattern_, shape, samples_, grid_);
            break;
    }
    place(samples_.triangle.empty() ? shape.cloud.points : samples_.points, params, region,
          execution);
}

void FieldSet::place(const Points& targets, const AnalysisParams& params, const Region& region,
                     const Execution& execution) {
    SeedingParams seeding = seeding_params(params);
    seeding.region = region;
    Seeds seeds = place_seeds(targets, grid_, seeding, part_of(execution, 0.0, 0.5));
    frames = std::move(seeds.frames);
    pieces = std::move(seeds.pieces);
    noise_factors.clear();
    for (const Frame& frame : frames) {
        noise_factors.push_back(static_cast<float>(params.noise_map.factor_at(frame.centre)));
    }
    dimensions.assign(frames.size(), kTooFewPoints);

    parallel_for(part_of(execution, 0.5, 1.0), "place", "fields", size(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     TargetArea target;
                     for (std::size_t j = begin; j < end; ++j) {
                         if (pieces[j].exists()) {
                             dimensions[j] = pieces[j].dimension;
                             frames[j].origin = pieces[j].origin;
                             frames[j].axes = pieces[j].axes;
                             continue;
                         }
                         grid_.gather(frames[j].centre, frames[j].radius, target_radius_, target);
                         const PrincipalDirections principal = principal_directions(target);
                         dimensions[j] = local_dimension(principal, target.size);
                         if (params.principal_frames) {
                             align_with_principal_directions(principal, frames[j]);
                         } else {
                             Random random(params.random_seed, j);
                             rotate_randomly(random, frames[j]);
                         }
                     }
                 });
}

FieldSet::Worker FieldSet::make_worker() const {
    Worker worker;
    worker.field.resize(3 * static_cast<std::size_t>(pattern_.padded_size()));
    worker.decoded.resize(worker.field.size());
    return worker;
}

bool FieldSet::poses_are_fixed() const {
    for (std::size_t j = 0; j < size(); ++j) {
        if (dimensions[j] != kTooFewPoints && !pose_is_fixed(j)) return false;
    }
    return true;
}

std::size_t FieldSet::chunks() const { return chunk_count(size(), kFieldsPerChunk); }

void FieldSet::gather(std::size_t j, TargetArea& target) const {
    gather_around(j, target);
    to_members(j, target);
}

void FieldSet::gather_around(std::size_t j, TargetArea& target) const {
    grid_.gather(frames[j].centre, frames[j].radius, target_radius_, target);
}

void FieldSet::to_flat(std::size_t j, TargetArea& target) const {
    target.to_frame(frames[j]);
    flatten(pieces[j], target);
}

void FieldSet::to_members(std::size_t j, TargetArea& target) const {
    to_flat(j, target);
    keep_members(pieces[j], 1.0F, target);
}

void FieldSet::gather_ball(std::size_t j, const PointGrid& grid, TargetArea& target) const {
    grid.gather(frames[j].centre, frames[j].radius, target_radius_, target);
    to_flat(j, target);
}

void FieldSet::probe(std::size_t j, ProbeScratch& scratch, float* field) const {
    gather_around(j, scratch.target);
    probe_gathered(j, scratch, field);
}

void FieldSet::probe_gathered(std::size_t j, ProbeScratch& scratch, float* field) const {
    to_members(j, scratch.target);
    operator_->probe(frames[j], dimensions[j] == kCurve, scratch, field);
    if (pieces[j].is_curve()) {
        // The field starts from the curve, not from the plane: no atom is needed to get there.
        const auto padded = static_cast<std::size_t>(pattern_.padded_size());
        kernels::add_scaled(1.0F, pattern_.channel(1), field + padded, padded);
    }
}

void FieldSet::for_each_probed(std::string_view phase, const Execution& execution,
                               const Body& body) const {
    parallel_for(execution, phase, "fields", size(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     Worker worker = make_worker();
                     for (std::size_t j = begin; j < end; ++j) {
                         if (dimensions[j] == kTooFewPoints) continue;
                         probe(j, worker.probe, worker.field.data());
                         body(j, worker, chunk);
                     }
                 });
}

void FieldSet::for_each_target(std::string_view phase, const Execution& execution,
                               const Body& body) const {
    for_each_gathered(phase, execution, body, &FieldSet::gather);
}

void FieldSet::for_each_ball(std::string_view phase, const Execution& execution,
                             const Body& body) const {
    for_each_gathered(phase, execution, body, &FieldSet::gather_ball);
}

void FieldSet::for_each_gathered(std::string_view phase, const Execution& execution,
                                 const Body& body, Gather gather_points) const {
    parallel_for(execution, phase, "fields", size(), kFieldsPerChunk,
                 [&](std::size_t, std::size_t, std::size_t turn) {
                     const std::size_t chunk = far_from_last(turn, chunks());
                     const std::size_t begin = chunk * kFieldsPerChunk;
                     const std::size_t end = std::min(begin + kFieldsPerChunk, size());
                     Worker worker = make_worker();
                     for (std::size_t j = begin; j < end; ++j) {
                         (this->*gather_points)(j, worker.probe.target);
                         body(j, worker, chunk);
                     }
                 });
}

std::vector<std::size_t> FieldSet::usable() const {
    std::vector<std::size_t> usable;
    for (std::size_t j = 0; j < size(); ++j) {
        if (dimensions[j] != kTooFewPoints) usable.push_back(j);
    }
    return usable;
}

std::vector<std::size_t> FieldSet::draw_sample(int count, std::uint64_t random_seed) const {
    std::vector<std::size_t> sample = usable();
    const auto wanted = std::min(static_cast<std::size_t>(count), sample.size());
    Random random(random_seed, 0x5a3);
    for (std::size_t i = 0; i < wanted && wanted < sample.size(); ++i) {
        std::swap(sample[i], sample[i + random.below(sample.size() - i)]);
    }
    sample.resize(wanted);
    std::sort(sample.begin(), sample.end());
    return sample;
}

AlignedFloats FieldSet::probe_sample(const std::vector<std::size_t>& sample,
                                     const Execution& execution) const {
    const std::size_t stride = 3 * static_cast<std::size_t>(pattern_.padded_size());
    AlignedFloats fields(sample.size() * stride);
    parallel_for(execution, "learn", "fields", sample.size(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     Worker worker = make_worker();
                     for (std::size_t i = begin; i < end; ++i) {
                         probe(sample[i], worker.probe, worker.field.data());
                         std::ranges::copy(
                             worker.field,
                             fields.begin() + static_cast<std::ptrdiff_t>(i * stride));
                     }
                 });
    return fields;
}

void FieldSet::optimise_poses(int passes, const Execution& execution) {
    parallel_for(execution, "pose", "fields", size(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     Worker worker = make_worker();
                     TargetArea around;
                     for (std::size_t j = begin; j < end; ++j) {
                         if (dimensions[j] == kTooFewPoints || pose_is_fixed(j)) continue;
                         gather_around(j, around);
                         for (int pass = 0; pass < passes; ++pass) {
                             worker.probe.target.size = 0;
                             worker.probe.target.append(around, 0, around.size);
                             probe_gathered(j, worker.probe, worker.field.data());
                             apply_pose(
                                 fit_pose(pattern_, worker.field.data(), worker.decoded.data()),
                                 frames[j]);
                         }
                     }
                 });
}

}  // namespace lpf
