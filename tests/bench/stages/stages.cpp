// Nanoseconds of each stage for one LPF (or one point), on one core:
//
//   lpf-stages --benchmark_filter=Probe
//
// "peak" is the share of the rate of a plain loop of fused multiply-adds, by operations counted.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/auto_parameters.h"
#include "core/base/kernels.h"
#include "core/denoising/votes.h"
#include "core/field/piece_growth.h"
#include "core/field_set.h"
#include "core/learn/dictionary_learning.h"
#include "core/learn/pose.h"
#include "core/resampling/consensus.h"
#include "tests/bench/stages/peak.h"
#include "tests/support/shapes.h"

namespace lpf::bench {
namespace {

/// A scan with its LPFs in place and coded, as in the timing case of the paper: radius .225, M 193,
/// d 32.
struct Scene {
    Scene() {
        shape.cloud.points = test::make_curvenet({.points = 300000, .noise = 0.05}).points;
        params = {.radius = 0.43, .atoms = 32, .lambda = 0.2, .iterations = 1};
        fields = std::make_unique<FieldSet>(shape, params, Execution{});
        fields->optimise_poses(2, {});
        analysis = std::make_unique<AnalysisResult>(analyze(*fields, params, {}));
        for (std::size_t j = 0; j < fields->size(); ++j) {
            if (fields->dimensions[j] == kSurface) surfaces.push_back(j);
        }
    }

    /// The next surface LPF's target area, in frame coordinates.
    void gather(std::size_t i, TargetArea& target) const {
        const Frame& frame = fields->frames[surfaces[i % surfaces.size()]];
        fields->grid().gather(frame.centre, frame.radius, 1.1F, target);
    }

    Shape shape;
    AnalysisParams params;
    std::unique_ptr<FieldSet> fields;
    std::unique_ptr<AnalysisResult> analysis;
    std::vector<std::size_t> surfaces;
};

const Scene& scene() {
    static const Scene kScene;
    return kScene;
}

/// Notes the share of the peak rate. @param operations of all iterations
void count_operations(benchmark::State& state, double operations) {
    state.counters["GFLOP/s"] = benchmark::Counter(1e-9 * operations, benchmark::Counter::kIsRate);
    state.counters["peak"] =
        benchmark::Counter(operations / peak_rate(), benchmark::Counter::kIsRate);
}

void Peak(benchmark::State& state) {
    constexpr std::size_t kRounds = 1U << 14U;
    for (auto _ : state) benchmark::DoNotOptimize(multiply_and_add(kRounds, 0.5F, 1.0F));
    count_operations(state, static_cast<double>(state.iterations()) * kRounds * kOperationsOfRound);
}
BENCHMARK(Peak);

void Gather(benchmark::State& state) {
    (void)scene();  // made before the clock runs
    TargetArea target;
    std::size_t i = 0;
    std::size_t points = 0;
    for (auto _ : state) {
        scene().gather(i++, target);
        points += target.size;
    }
    state.counters["points"] =
        benchmark::Counter(static_cast<double>(points), benchmark::Counter::kAvgIterations);
}
BENCHMARK(Gather);

void Probe(benchmark::State& state, const std::unique_ptr<ProbingOperator>& probing) {
    const Scene& s = scene();
    AlignedFloats field(s.analysis->dictionary.stride());
    std::vector<ProbeScratch> scratch(64);
    for (std::size_t i = 0; i < scratch.size(); ++i) {
        s.gather(i, scratch[i].target);
        scratch[i].target.to_frame(s.fields->frames[s.surfaces[i]]);
    }
    std::size_t i = 0;
    for (auto _ : state) {
        probing->probe(s.fields->frames[0], false, scratch[i++ % scratch.size()], field.data());
        benchmark::DoNotOptimize(field.data());
    }
}
BENCHMARK_CAPTURE(Probe, orthogonal, make_orthogonal_probing(Pattern::grid(16)));
BENCHMARK_CAPTURE(Probe, noise_aware, make_noise_aware_probing(Pattern::grid(16), 0.15));

AlignedFloats some_fields(std::size_t count) {
    const Scene& s = scene();
    return s.fields->probe_sample(
        {s.surfaces.begin(), s.surfaces.begin() + static_cast<std::ptrdiff_t>(count)}, {});
}

/// Time of one LPF, where a block of them is at work.
void count_fields(benchmark::State& state) {
    state.counters["perLPF"] = benchmark::Counter(
        static_cast<double>(kFieldsOfBlock),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Correlate(benchmark::State& state) {
    const Dictionary& dictionary = scene().analysis->dictionary;
    const CodingMatrices matrices(dictionary);
    const AlignedFloats fields = some_fields(kFieldsOfBlock);
    AlignedFloats out(kFieldsOfBlock * matrices.width);
    for (auto _ : state) {
        Coder::correlate(matrices, fields, out);
        benchmark::DoNotOptimize(out.data());
    }
    count_fields(state);
    count_operations(state, 2.0 * static_cast<double>(state.iterations()) *
                                static_cast<double>(fields.size()) * dictionary.atoms());
}
BENCHMARK(Correlate);

void Code(benchmark::State& state) {
    const Scene& s = scene();
    const CodingMatrices matrices(s.analysis->dictionary);
    const AlignedFloats fields = some_fields(64);
    const auto d = static_cast<std::size_t>(s.analysis->dictionary.atoms());
    const Coder coder{static_cast<float>(s.params.lambda), LassoMethod::CoordinateDescent};
    AlignedFloats correlations(64 * matrices.width);
    Coder::correlate(matrices, fields, correlations);
    SparseCodes codes(64, s.analysis->dictionary.atoms());
    std::array<LassoTask, kFieldsOfBlock> tasks;
    std::size_t block = 0;
    for (auto _ : state) {
        const std::size_t first = block++ % (64 / kFieldsOfBlock) * kFieldsOfBlock;
        for (std::size_t k = 0; k < kFieldsOfBlock; ++k) {
            const std::span<float> code = codes[first + k];
            std::ranges::copy(s.analysis->codes[s.surfaces[first + k]], code.begin());
            for (float& value : code) value *= 0.95F;  // as an iteration of the joint loop finds it
            tasks[k] = {std::span(correlations).subspan((first + k) * matrices.width, d),
                        coder.lambda, code};
        }
        coder.solve(matrices.gram, tasks);
        benchmark::DoNotOptimize(codes.values().data());
    }
    count_fields(state);
}
BENCHMARK(Code);

void Decode(benchmark::State& state) {
    const Scene& s = scene();
    const Dictionary& dictionary = s.analysis->dictionary;
    const CodingMatrices matrices(dictionary);
    AlignedFloats codes;
    for (std::size_t k = 0; k < kFieldsOfBlock; ++k) {
        const auto code = s.analysis->codes[s.surfaces[k]];
        codes.insert(codes.end(), code.begin(), code.end());
    }
    AlignedFloats out(kFieldsOfBlock * dictionary.stride());
    for (auto _ : state) {
        Coder::decode(matrices, codes, out);
        benchmark::DoNotOptimize(out.data());
    }
    count_fields(state);
    count_operations(state, 2.0 * static_cast<double>(state.iterations()) *
                                static_cast<double>(out.size()) * dictionary.atoms());
}
BENCHMARK(Decode);

void Pose(benchmark::State& state) {
    const Scene& s = scene();
    const AlignedFloats fields = some_fields(64);
    const std::size_t stride = s.analysis->dictionary.stride();
    AlignedFloats decoded(stride);
    s.analysis->dictionary.decode(s.analysis->codes[s.surfaces[0]], decoded);
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            fit_pose(s.fields->pattern(), fields.data() + (i++ % 64) * stride, decoded.data()));
    }
}
BENCHMARK(Pose);

void Grow(benchmark::State& state) {
    const Scene& s = scene();
    TargetArea target;
    PieceGrower grower(true);
    std::size_t i = 0;
    for (auto _ : state) {
        s.gather(i++, target);
        benchmark::DoNotOptimize(grower.grow(target, 0.12F, 1.1F));
    }
}
BENCHMARK(Grow);

/// One iteration votes on all points; the counter is the time of one LPF.
void Vote(benchmark::State& state) {
    const Scene& s = scene();
    for (auto _ : state) benchmark::DoNotOptimize(vote(*s.fields, *s.analysis, {}, {}));
    state.counters["perLPF"] = benchmark::Counter(
        static_cast<double>(s.fields->size()),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(Vote)->Unit(benchmark::kMillisecond);

/// Candidates as twenty LPFs that overlap propose them.
void Consensus(benchmark::State& state) {
    Candidates candidates{test::make_plane({.points = 200000}).points, {}};
    candidates.field.resize(static_cast<std::size_t>(candidates.points.cols()), 0);
    for (auto _ : state) benchmark::DoNotOptimize(find_consensus(candidates, 0.02, {}));
    state.counters["perCandidate"] = benchmark::Counter(
        static_cast<double>(candidates.size()),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(Consensus)->Unit(benchmark::kMillisecond);

/// Probe, code and pose together, as the joint loop runs them (paper Sec. 3.2), by the operations
/// that M 193, d 32 and the points and non-zero coefficients at hand take.
void ProbeCodePose(benchmark::State& state) {
    const Scene& s = scene();
    AnalysisParams params = s.params;
    params.initial_dictionary = s.analysis->dictionary;
    params.keep_dictionary = true;
    params.iterations = 10;
    params.learning_sample = 1;  // nothing is learned: no LPF is probed for that
    FieldSet fields(s.shape, params, {});
    double points = 0;
    double used = 0;
    TargetArea target;
    for (std::size_t i = 0; i < 256; ++i) {
        s.gather(i, target);
        points += static_cast<double>(target.size) / 256;
        used += static_cast<double>(std::ranges::count_if(s.analysis->codes[s.surfaces[i]],
                                                          [](float c) { return c != 0; })) /
                256;
    }
    for (auto _ : state) benchmark::DoNotOptimize(analyze(fields, params, {}));
    const double stride = static_cast<double>(s.analysis->dictionary.stride());
    const double m = s.fields->pattern().size();
    const double gather = 8 * 2 * points;  // as many more are looked at
    const double probe = 15 * points + 3 * m + 15 * 3 * 16 * 5 * points / 15;  // three rows of 15
    const double correlate = 2 * 32 * stride;
    const double lasso = 2 * (used * used * used / 3 + 2 * used * 32) + 3 * 2 * 32 * used;
    const double decode = 2 * used * stride;
    const double energies = 3 * stride;
    const double pose = (30 + 24) * m;
    // Passes that move the LPFs, and the closing one. Points are gathered once for all of them.
    const double moving = probe + correlate + lasso + 2 * decode + 3 * energies + pose;
    const double closing = probe + correlate + lasso + 2 * decode + 2 * energies;
    const auto n = static_cast<double>(s.fields->size());
    count_operations(state, static_cast<double>(state.iterations()) * n *
                                (gather + params.iterations * moving + closing));
    state.counters["perPass"] = benchmark::Counter(
        (params.iterations + 1) * n,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(ProbeCodePose)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lpf::bench
