#include "api/estimate.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/random.h"
#include "core/denoising/tiled_denoise.h"
#include "core/field_set.h"

namespace lpf {
namespace {

// Costs of one unit, measured on one core of a 2.x GHz server machine [seconds].
constexpr double kReferenceSeconds = 0.00245;  // reference_seconds() on that machine

constexpr double kDecodePoint = 0.15e-6;
constexpr double kDecodePointApart = 0.6e-6;
constexpr double kDecodeFace = 0.05e-6;
constexpr double kMeasureOnce = 0.05;
constexpr double kMeasurePoint = 0.08e-6;
constexpr double kOutlierPoint = 4e-6;
constexpr double kNormalPoint = 8e-6;
constexpr double kPlacePoint = 0.1e-6;
constexpr double kPlaceField = 2.5e-6;
constexpr double kGrowPoint = 1.2e-6;   // pieces of the shape
constexpr double kTriangleProbe = 1.0;  // of a mesh, for one of points
constexpr double kGatherPoint = 0.004e-6;
constexpr double kGatherShare = 0.35;       // of a probe; LPFs that are probed again do without
constexpr double kVote = 0.035e-6;          // two rounds
constexpr double kUsualIterations = 1.5;    // of denoising, where a second may not be worth it
constexpr double kOutputPoint = 10e-6;      // of a resampling: votes, sources
constexpr double kCandidateOfAll = 1.2e-6;  // proposed and settled, in all tries to meet a number
constexpr double kProposals = 3;            // such tries: a mesh is probed for each
constexpr double kEncodePoint = 0.3e-6;
constexpr double kEncodePointApart = 1.5e-6;
constexpr double kWriteByte = 4e-9;
constexpr double kJobOnce = 0.05;  // books and files

double probe_seconds(int pattern) {
    const double m = pattern;
    return 1e-6 * (1.7 + 0.0068 * m + 1.446e-4 * m * m);
}

double code_seconds(int pattern, int atoms) {
    return 1e-6 * (0.5 + 1.5 * std::pow(atoms / 16.0, 0.7) * pattern / 193.0);
}

/// Costs of the parts of a job, on one thread and on all.
struct Seconds {
    double alone = 0;
    double shared = 0;

    void operator+=(const Seconds& more) {
        alone += more.alone;
        shared += more.shared;
    }
    friend Seconds operator*(double factor, const Seconds& s) {
        return {factor * s.alone, factor * s.shared};
    }
};

/// Places at which each field proposes points.
double places_of_field(const Workload& w, const ResolvedParameters& p) {
    const double m = p.analysis.pattern.points;
    const double step = std::sqrt(std::numbers::pi / m);  // [radius]
    const double area = w.fields * 0.25 * p.analysis.radius * p.analysis.radius;
    const double spacing = p.resample.target_spacing > 0
                               ? p.resample.target_spacing
                               : std::sqrt(area / std::max(w.output_points, 1.0));
    const double cuts =
        std::clamp(std::ceil(step * p.analysis.radius / (1.1 * spacing)), 1.0, 16.0);
    return m * cuts * cuts;
}

Seconds placing(const Workload& w, const AnalysisParams& p) {
    return {kPlacePoint * w.probed_points + kPlaceField * w.fields,
            p.noise > 0 ? kGrowPoint * w.probed_points : 0.0};
}

/// Poses, joint loop and closing pass (`analyze` of core).
Seconds analysis(const Workload& w, const AnalysisParams& p) {
    const double kind = p.probing == ProbingKind::NearestTriangle ? kTriangleProbe : 1.0;
    const double probe = kind * probe_seconds(p.pattern.points) + kGatherPoint * w.points_per_field;
    const double again = (1 - kGatherShare) * probe;
    const double code = code_seconds(p.pattern.points, p.atoms);
    const double poses =
        p.pose_iterations > 0 ? w.fields * (probe + (p.pose_iterations - 1) * again) : 0.0;
    // The LPFs that are learned on are coded as they were probed for that.
    const double leaders = std::min<double>(p.learning_sample, w.fields);
    const double followers = w.fields - leaders;
    const double learn = leaders * (probe + (p.keep_dictionary ? 0 : p.learning_rounds) * code);
    const double pass = followers * again + w.fields * code;
    const double closing = leaders * probe + followers * again + 2 * w.fields * code;
    return {0, poses + followers * (probe - again) + p.iterations * (learn + pass) + closing};
}

Seconds denoising(const Workload& w, const DenoiseParams& p) {
    Seconds once = placing(w, p.analysis);
    once += analysis(w, p.analysis);
    once.shared += kVote * w.fields * w.points_per_field;
    return (p.least_bent > 0 ? kUsualIterations : p.iterations) * once;
}

Seconds proposing(const Workload& w, const ResolvedParameters& p) {
    const double probes =
        p.analysis.probing == ProbingKind::NearestTriangle
            ? kProposals * kTriangleProbe * probe_seconds(p.analysis.pattern.points)
            : 0.0;
    return {0, w.fields * (probes + kCandidateOfAll * places_of_field(w, p)) +
                   kOutputPoint * w.output_points};
}

Seconds method(const Workload& w, const ResolvedParameters& p) {
    if (w.task == Task::Denoise) return denoising(w, p.denoise);
    Seconds sum = placing(w, p.analysis);
    sum += analysis(w, p.analysis);
    if (w.task == Task::Analyze) return sum;
    if (p.resample.denoise) sum += denoising(w, *p.resample.denoise);
    sum += proposing(w, p);
    return sum;
}

Seconds around(const Workload& w) {
    const double made = w.task == Task::Analyze ? 0.0 : w.output_points;
    Seconds sum;
    sum.alone = kJobOnce + (w.decoded_apart ? kDecodePointApart : kDecodePoint) * w.points +
                kDecodeFace * w.faces + kMeasurePoint * w.points + kWriteByte * w.file_bytes +
                (w.decoded_apart ? kEncodePointApart : kEncodePoint) * made;
    sum.shared = kMeasureOnce + (w.finds_outliers ? kOutlierPoint * w.points : 0.0) +
                 (w.estimates_normals ? kNormalPoint * made : 0.0);
    return sum;
}

/// Time of the processor that this thread had: what others do on the machine does not count.
double processor_seconds() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Bytes of one unit.
constexpr double kPosition = 24;
constexpr double kFace = 12;
constexpr double kApartOnce = 10e6;
constexpr double kApartPoint = 150;
constexpr double kApartFace = 200;
constexpr double kTreePoint = 44;
constexpr double kGridPoint = 66;
constexpr double kMeshSample = 28;     // of a mesh that is probed
constexpr double kAnalysisOnce = 4e6;  // dictionaries on the way, rooms of the threads
constexpr double kBallotPoint = 56;    // sums, and the moves of two rounds
constexpr double kBentPoint = 30;      // copies of what is deconvolved, if that is all of a cloud
constexpr double kTilePoint = 180;
constexpr double kPointsAround = 1.3;  // those of a tile with those around it, for its own
constexpr double kStreamedPoint = 18;  // moves, and numbers of the points of tiles
constexpr double kField = 300;
constexpr double kCandidate = 90;
constexpr double kMostCandidates = 6e6;       // more are made block by block
constexpr double kBlockOfCandidates = 170e6;  // of one
constexpr double kAgreedPoint = 36;           // in its cell, with its LPF
constexpr double kJobBytes = 5e6;
constexpr double kSafety = 1.15;

double method_bytes(const Workload& w, const ResolvedParameters& p) {
    const AnalysisParams& a = p.analysis;
    const double padded = 16.0 * std::ceil(a.pattern.points / 16.0);
    const double sample = std::min<double>(a.learning_sample, w.fields);
    const double learning = sample * (12.0 * padded + 8.0 * a.atoms);
    const double fields = w.fields * (kField + 4.0 * a.atoms);
    const bool has_samples = a.probing == ProbingKind::NearestTriangle;
    const double grid = (kGridPoint + (has_samples ? kMeshSample : 0.0)) * w.probed_points;
    double bytes = kAnalysisOnce + learning + fields + grid;
    if (w.task == Task::Denoise) bytes += (kPosition + kBallotPoint + kBentPoint) * w.points;
    if (w.task == Task::Resample) {
        const double candidates = w.fields * places_of_field(w, p);
        const double noisy =
            p.resample.denoise ? (kPosition + kBallotPoint + kBentPoint) * w.points : 0;
        const double consenting =
            std::min(kCandidate * candidates, kBlockOfCandidates) + kAgreedPoint * w.output_points;
        bytes += std::max(noisy, consenting);
    }
    return bytes;
}

/// A cloud that is worked on tile by tile (core/denoising/tiled_denoise.h).
double streamed_bytes(const Workload& w, const ResolvedParameters& p, int threads) {
    const double tile = kTilePoint * kPointsAround * static_cast<double>(TilingParams{}.points);
    const double at_once = std::min<double>(threads, kTilesAtOnce);
    return kStreamedPoint * w.points + at_once * tile +
           w.fields * 2 * (kField + 4.0 * p.analysis.atoms);
}

}  // namespace

Estimate estimate(const Workload& work, const ResolvedParameters& parameters, double speed,
                  int threads) {
    Seconds seconds = around(work);
    seconds += method(work, parameters);
    const double all = (seconds.alone + seconds.shared / std::max(1, threads)) / speed;
    if (work.streamed)
        return {all, kJobBytes + kSafety * streamed_bytes(work, parameters, threads)};
    const double row = kPosition + work.row_bytes;
    const double document = document_bytes(work);
    const double decoding = work.file_bytes + document + work.file_bytes + apart_bytes(work);
    const double measuring = document + kTreePoint * work.points;
    const double working = document + method_bytes(work, parameters);
    const double writing =
        document + 3 * row * work.output_points + work.fields * (kField + 24.0) + apart_bytes(work);
    return {all, kJobBytes + kSafety * std::max({decoding, measuring, working, writing})};
}

double document_bytes(const Workload& work) {
    return (kPosition + work.row_bytes) * work.points + kFace * work.faces;
}

double apart_bytes(const Workload& work) {
    if (!work.decoded_apart) return 0;
    return kApartOnce + (kApartPoint + work.row_bytes) * std::max(work.points, work.output_points) +
           kApartFace * work.faces;
}

double attribute_row_bytes(const PointCloud& cloud) {
    double bytes = 0;
    for (const Attribute& attribute : cloud.attributes)
        bytes += static_cast<double>(attribute.data.size() + 8 * attribute.list_offsets.size());
    return cloud.size() ? bytes / static_cast<double>(cloud.size()) : 0.0;
}

double expected_points(Task task, double points, double fields,
                       const ResolvedParameters& parameters) {
    if (task != Task::Resample) return points;
    const ResampleParams& r = parameters.resample;
    if (r.target_points > 0) return static_cast<double>(r.target_points);
    // Seeds half a radius apart are a packing themselves; points are one of another spacing.
    const double ratio = 0.5 * r.analysis.radius / r.target_spacing;
    return std::max(1.0, fields * ratio * ratio);
}

double reference_seconds() {
    constexpr int kPoints = 2000;
    Shape shape;
    shape.cloud.points.resize(3, kPoints);
    Random random(1);
    for (Eigen::Index i = 0; i < kPoints; ++i) {
        const double x = random.uniform(-1, 1);
        const double y = random.uniform(-1, 1);
        shape.cloud.points.col(i) = Eigen::Vector3d(x, y, 0.2 * std::sin(4 * x) * y);
    }
    AnalysisParams params;
    params.radius = 0.25;
    params.probing = ProbingKind::NoiseAware;
    FieldSet fields(shape, params, {});
    double best = 1e9;
    for (int i = 0; i < 8; ++i) {
        const double start = processor_seconds();
        fields.optimise_poses(2, {});
        best = std::min(best, processor_seconds() - start);
    }
    return best;
}

double machine_speed() {
    static const double kSpeed = std::clamp(kReferenceSeconds / reference_seconds(), 0.05, 20.0);
    return kSpeed;
}

nlohmann::json to_json(const Estimate& estimate, const Workload& work, int threads) {
    nlohmann::json json = {{"seconds", estimate.seconds},
                           {"memoryBytes", static_cast<std::uint64_t>(estimate.memory_bytes)},
                           {"threads", threads},
                           {"fields", static_cast<std::uint64_t>(std::round(work.fields))}};
    if (work.task != Task::Analyze)
        json["outputPoints"] = static_cast<std::uint64_t>(std::round(work.output_points));
    return json;
}

}  // namespace lpf
