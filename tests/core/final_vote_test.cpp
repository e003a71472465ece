#include "core/final_vote.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/auto_parameters.h"
#include "core/denoise.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr double kNoise = 0.01;
constexpr double kSpacing = 0.02;

/// A cube that had noise, its LPFs, and points that they are to vote on.
class FinalVote : public testing::Test {
protected:
    FinalVote() {
        Shape noisy;
        noisy.cloud.points = cube.points;
        const Measurements measured = measure(cube.points, {.threads = 2});
        const auto params = resolve_parameters(Task::Resample, noisy, measured, {}).resample;
        shape.cloud.points = denoise(noisy, *params.denoise, {.threads = 2}).points;
        fields.emplace(shape, params.analysis, Execution{.threads = 2});
        analysis = analyze(*fields, params.analysis, {.threads = 2});
    }

    /// Points of the true cube, moved at random in all directions.
    [[nodiscard]] static Candidates scattered(double by) {
        const auto truth = test::make_cube({.points = 5000, .noise = by, .seed = 8});
        Candidates points{truth.points, {}};
        for (Eigen::Index i = 0; i < truth.points.cols(); ++i) {
            points.field.push_back(static_cast<std::uint32_t>(i));  // tells what became of it
        }
        return points;
    }

    Candidates voted(Candidates points, int threads = 2) const {
        put_to_vote(*fields, *analysis, kNoise, kSpacing, points, {.threads = threads});
        return points;
    }

    const test::TestShape cube = test::make_cube({.points = 20000, .noise = kNoise, .seed = 5});
    Shape shape;
    std::optional<FieldSet> fields;
    std::optional<AnalysisResult> analysis;
};

TEST_F(FinalVote, BringsPointsBackToTheShape) {
    const Candidates points = scattered(0.4 * kNoise);
    const double before = test::error_to_shape(points.points, cube).rmse;
    const double after = test::error_to_shape(voted(points).points, cube).rmse;
    EXPECT_LT(after, 0.5 * before);
}

/// All but those at edges and corners, which LPFs know less well than by one sigma.
TEST_F(FinalVote, KeepsPointsOfTheShapeWhereTheyAre) {
    const Candidates points = scattered(0.0);
    const Candidates result = voted(points);
    EXPECT_GT(result.size(), 4950U);
    double sum = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto before = static_cast<Eigen::Index>(result.field[i]);
        sum += (result.points.col(static_cast<Eigen::Index>(i)) - points.points.col(before)).norm();
    }
    EXPECT_LT(sum / static_cast<double>(result.size()), 0.2 * kNoise);
}

TEST_F(FinalVote, DropsStraysAndKeepsTheOrderOfTheRest) {
    Candidates points = scattered(0.0);
    for (Eigen::Index i = 0; i < points.points.cols(); i += 50) {
        points.points.col(i) *= 1 + 3 * kNoise / points.points.col(i).lpNorm<Eigen::Infinity>();
    }
    const Candidates result = voted(points);
    ASSERT_EQ(result.field.size(), static_cast<std::size_t>(result.points.cols()));
    EXPECT_TRUE(std::ranges::is_sorted(result.field));
    std::size_t strays = 0;
    for (const std::uint32_t i : result.field) strays += i % 50 == 0;
    EXPECT_LT(strays, 10U);  // of 100
    EXPECT_GT(result.size() - strays, 4850U);
}

TEST_F(FinalVote, DoesNotDependOnTheNumberOfThreads) {
    const Candidates points = scattered(0.5 * kNoise);
    const Candidates one = voted(points, 1);
    for (const int threads : {2, 5}) {
        const Candidates many = voted(points, threads);
        EXPECT_EQ(many.points, one.points);
        EXPECT_EQ(many.field, one.field);
    }
}

TEST_F(FinalVote, TakesNoPoints) {
    EXPECT_EQ(voted({Points(3, 0), {}}).size(), 0U);
}

TEST_F(FinalVote, LeavesPointsThatNoLpfKnowsWhereTheyAre) {
    Candidates far{Points(3, 1), {7}};
    far.points << 50, 60, 70;
    const Candidates result = voted(far);
    ASSERT_EQ(result.size(), 1U);
    EXPECT_EQ(result.points, far.points);
    EXPECT_EQ(result.field, far.field);
}

TEST(SpreadOut, DropsWhatIsTooNearAndNothingElse) {
    Candidates points{Points(3, 4), {4, 5, 6, 7}};
    points.points << 0, 1, 2, 2.4,  //
        0, 0, 0, 0,                 //
        0, 0, 0, 0;
    spread_out(0.9, points, {});
    ASSERT_EQ(points.size(), 3U);
    EXPECT_EQ(points.field[0], 4U);
    EXPECT_EQ(points.field[1], 5U);
    EXPECT_GE(points.points(0, 2), 2.0);
    EXPECT_EQ(points.field[2], points.points(0, 2) == 2.0 ? 6U : 7U);
}

TEST(SpreadOut, LeavesNoTwoNearerThanTheSpacing) {
    Candidates points{test::make_sphere({.points = 4000}).points, {}};
    points.field.assign(4000, 0);
    spread_out(0.05, points, {.threads = 2});
    EXPECT_GE(test::nearest_neighbour_stats(points.points).min, 0.05 * (1 - 1e-9));
    EXPECT_GT(points.size(), 1000U);
}

}  // namespace
}  // namespace lpf
