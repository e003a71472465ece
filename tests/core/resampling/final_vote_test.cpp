#include "core/resampling/final_vote.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "core/auto_parameters.h"
#include "core/denoise.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr double kNoise = 0.01;
constexpr double kSpacing = 0.02;

/// What is kept of all points is told by so many draws of seeds: one alone is up to half a per cent
/// off.
constexpr std::uint64_t kDraws = 4;

/// A cube that had noise, its LPFs, and points that they are to vote on.
class FinalVote : public testing::Test {
protected:
    FinalVote() { draw(1); }

    /// Makes the LPFs anew, with other seeds.
    void draw(std::uint64_t random_seed) {
        Shape noisy;
        noisy.cloud.points = cube.points;
        const Measurements measured = measure(cube.points, {.threads = 2});
        auto params = resolve_parameters(Task::Resample, noisy, measured, {}).resample;
        params.analysis.random_seed = random_seed;
        params.denoise->analysis.random_seed = random_seed;
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
    std::size_t kept = result.size();
    for (std::uint64_t seed = 2; seed <= kDraws; ++seed) {
        draw(seed);
        kept += voted(points).size();
    }
    EXPECT_GT(kept, kDraws * 4950U);
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
    std::size_t others = 0;
    for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
        draw(seed);
        for (const std::uint32_t i : voted(points).field) ++(i % 50 == 0 ? strays : others);
    }
    EXPECT_LT(strays, kDraws * 10U);  // of 100
    EXPECT_GT(others, kDraws * 4850U);
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

TEST_F(FinalVote, TakesNoPoints) { EXPECT_EQ(voted({Points(3, 0), {}}).size(), 0U); }

TEST_F(FinalVote, LeavesPointsThatNoLpfKnowsWhereTheyAre) {
    Candidates far{Points(3, 1), {7}};
    far.points << 50, 60, 70;
    const Candidates result = voted(far);
    ASSERT_EQ(result.size(), 1U);
    EXPECT_EQ(result.points, far.points);
    EXPECT_EQ(result.field, far.field);
}

Candidates on_a_line(std::initializer_list<double> places) {
    Candidates points{Points::Zero(3, static_cast<Eigen::Index>(places.size())), {}};
    for (const double x : places) {
        points.points(0, static_cast<Eigen::Index>(points.field.size())) = x;
        points.field.push_back(static_cast<std::uint32_t>(points.field.size()));
    }
    return points;
}

using Rows = std::vector<std::uint32_t>;

TEST(SpreadOut, DropsTheLaterOfTwoThatAreTooNear) {
    Candidates points = on_a_line({0, 1, 2, 2.4, 1.5});
    EXPECT_EQ(spread_out({.least = 0.9}, points, {}), 0.9);
    EXPECT_EQ(points.field, (Rows{0, 1, 2}));
    EXPECT_EQ(points.points.row(0), Eigen::RowVector3d(0, 1, 2));
}

TEST(SpreadOut, StopsAtTheNumberThatIsEnoughAndTellsWhatIsLeft) {
    const Candidates all = on_a_line({0, 0.5, 2, 2.4, 4, 4.7});
    Candidates points = all;
    EXPECT_NEAR(spread_out({.least = 0.1, .wanted = 1, .enough = 4}, points, {}), 0.7, 1e-12);
    EXPECT_EQ(points.field, (Rows{0, 2, 4, 5}));
    points = all;
    EXPECT_EQ(spread_out({.least = 0.1, .wanted = 1, .enough = 2}, points, {}), 1);
    EXPECT_EQ(points.field, (Rows{0, 2, 4}));
    points = all;
    EXPECT_NEAR(spread_out({.least = 0.45, .wanted = 1, .enough = 9}, points, {}), 0.5, 1e-12);
    EXPECT_EQ(points.field, (Rows{0, 1, 2, 4, 5}));
}

TEST(SpreadOut, LeavesNoTwoNearerThanItTells) {
    Candidates points{test::make_sphere({.points = 4000}).points, Rows(4000, 0)};
    const double apart = spread_out({.least = 0.03, .wanted = 0.05, .enough = 2500}, points, {});
    EXPECT_EQ(points.size(), 2500U);
    EXPECT_GT(apart, 0.03);
    EXPECT_NEAR(test::nearest_neighbour_stats(points.points).min, apart, 1e-12);
}

}  // namespace
}  // namespace lpf
