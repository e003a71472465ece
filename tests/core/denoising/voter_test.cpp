#include "core/denoising/voter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/auto_parameters.h"
#include "core/denoise.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

const Execution kExecution{.threads = 2};

DenoiseParams params_of(const Shape& shape, const ParameterRequest& request) {
    const Measurements measured = measure(shape.cloud.points, kExecution);
    return resolve_parameters(Task::Denoise, shape, measured, request).denoise;
}

/// The LPFs of a noisy scan, and what was learned from them.
struct Analysed {
    Shape shape;
    DenoiseParams params;
    FieldSet fields;
    AnalysisResult analysis;

    explicit Analysed(const test::TestShape& scan, const ParameterRequest& request = {})
        : shape{{scan.points, {}}, {}},
          params(params_of(shape, request)),
          fields(shape, params.analysis, kExecution),
          analysis(analyze(fields, params.analysis, kExecution)) {}

    [[nodiscard]] Fit fit(std::size_t j) const {
        const Voter voter(fields, analysis, false, params.analysis.noise);
        FieldSet::Worker worker = fields.make_worker();
        fields.gather_ball(j, worker.probe.target);
        const FieldImage image = voter.image(j, worker);
        return voter.fit(j, worker.probe.target, Voter::field_at(worker.probe.target, image));
    }

    /// Share of the LPFs that are plain.
    [[nodiscard]] double plain_share() const {
        double plain = 0;
        for (std::size_t j = 0; j < fields.size(); ++j) plain += fit(j).is_plain;
        return plain / static_cast<double>(fields.size());
    }
};

/// Codes that say the same wrong thing about every LPF.
SparseCodes wrong_codes(const AnalysisResult& analysis) {
    SparseCodes codes = analysis.codes;
    for (std::size_t j = 0; j < codes.size(); ++j) {
        std::ranges::fill(codes[j], 0.0F);
        codes[j][0] = 0.5F;
    }
    return codes;
}

TEST(Voter, TakesAnLpfWhoseCodeIsWrongForItsPiece) {
    Analysed plane(test::make_plane({.points = 8000, .noise = 0.02}));
    const double before = plane.plain_share();
    EXPECT_GT(before, 0.7) << "noise is no detail";
    plane.analysis.codes = wrong_codes(plane.analysis);
    EXPECT_GT(plane.plain_share(), before);
}

TEST(Voter, BelievesCodesThatSayMoreThanPieces) {
    // Of one size, and too large for waves: pieces alone do not suit them.
    ParameterRequest request;
    request.radius = 1.5;
    const Analysed sheet(test::make_open_sheet({.points = 30000, .noise = 0.005}), request);
    EXPECT_LT(sheet.plain_share(), 0.3);
}

TEST(Voter, StopsSlidingAlongPieces) {
    Piece piece;
    piece.dimension = kSurface;
    Arrows field(2);
    const auto reset = [&] {
        field.x << 1, 2;
        field.y << 3, 4;
        field.z << 5, 6;
    };
    reset();
    Voter::stop_sliding(piece, field);
    EXPECT_TRUE(field.x.isZero() && field.y.isZero());
    EXPECT_EQ(field.z[1], 6);
    reset();
    Voter::leave_only_sliding(piece, field);
    EXPECT_TRUE(field.z.isZero());
    EXPECT_EQ(field.x[0] + field.y[0], 4);

    piece.dimension = kCurve;
    reset();
    Voter::stop_sliding(piece, field);
    EXPECT_TRUE(field.x.isZero());
    EXPECT_EQ(field.y[0] + field.z[0], 8);
    reset();
    Voter::leave_only_sliding(piece, field);
    EXPECT_TRUE(field.y.isZero() && field.z.isZero());
    EXPECT_EQ(field.x[1], 2);
}

/// How much shorter a noisy line of length 2 has become, on average [sigma].
double shortening(int iterations) {
    constexpr double kNoise = 0.02;
    constexpr int kDraws = 6;
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
        const Shape line{
            {test::make_line({.points = 4000, .noise = kNoise, .seed = seed}).points, {}}, {}};
        ParameterRequest request;
        request.denoise_iterations = iterations;
        const Points points = denoise(line, params_of(line, request), kExecution).points;
        sum += 2 - (points.row(0).maxCoeff() - points.row(0).minCoeff());
    }
    return sum / kDraws / kNoise;
}

TEST(Voter, PullsTheEndsOfCurvesOnce) {
    EXPECT_LT(shortening(1), 1.0) << "half a sigma at each end";
    EXPECT_GT(shortening(1), -2.0);
    EXPECT_NEAR(shortening(3), shortening(1), 0.5);
}

}  // namespace
}  // namespace lpf
