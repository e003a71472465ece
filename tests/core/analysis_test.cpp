#include "core/analysis.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stop_token>

#include "core/base/error.h"
#include "tests/core/clouds.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

AnalysisParams small_params(double radius) {
    AnalysisParams params;
    params.radius = radius;
    params.atoms = 6;
    params.iterations = 3;
    params.learning_rounds = 3;
    return params;
}

Shape shape_named(const std::string& name, std::size_t points, double noise = 0.0) {
    Shape shape;
    shape.cloud.points = test::make_shape(name, {.points = points, .noise = noise}).points;
    return shape;
}

ErrorCode code_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.code();
    }
    ADD_FAILURE() << "no exception";
    return ErrorCode::Internal;
}

void expect_sound(const AnalysisResult& result) {
    const std::size_t n = result.frames.size();
    ASSERT_GT(n, 0U);
    ASSERT_EQ(result.codes.size(), n);
    ASSERT_EQ(result.residuals.size(), n);
    ASSERT_EQ(result.dimensions.size(), n);
    ASSERT_EQ(result.usage.size(), static_cast<std::size_t>(result.dictionary.atoms()));
    for (std::size_t j = 0; j < n; ++j) {
        const Eigen::Matrix3f& axes = result.frames[j].axes;
        ASSERT_LT((axes.transpose() * axes - Eigen::Matrix3f::Identity()).norm(), 1e-4F);
        ASSERT_NEAR(axes.determinant(), 1, 1e-4);
        ASSERT_TRUE(result.frames[j].origin.allFinite());
        ASSERT_TRUE(std::isfinite(result.residuals[j]));
        for (const float a : result.codes[j]) ASSERT_TRUE(std::isfinite(a));
    }
    for (int k = 0; k < result.dictionary.atoms(); ++k) {
        double norm = 0;
        for (const float value : result.dictionary.atom(k)) norm += double{value} * value;
        ASSERT_LE(norm, 1 + 1e-4) << "atom " << k;
        ASSERT_GE(result.usage[static_cast<std::size_t>(k)], 0);
        ASSERT_LE(result.usage[static_cast<std::size_t>(k)], 1);
    }
}

bool identical(const AnalysisResult& a, const AnalysisResult& b) {
    if (a.frames.size() != b.frames.size() || a.residuals != b.residuals) return false;
    for (std::size_t j = 0; j < a.frames.size(); ++j) {
        if (a.frames[j].origin != b.frames[j].origin || a.frames[j].axes != b.frames[j].axes ||
            !std::ranges::equal(a.codes[j], b.codes[j])) {
            return false;
        }
    }
    for (int k = 0; k < a.dictionary.atoms(); ++k) {
        if (!std::ranges::equal(a.dictionary.atom(k), b.dictionary.atom(k))) return false;
    }
    for (std::size_t i = 0; i < a.energy.size(); ++i) {
        if (a.energy[i].learning != b.energy[i].learning || a.energy[i].pose != b.energy[i].pose ||
            a.energy[i].probing != b.energy[i].probing) {
            return false;
        }
    }
    return true;
}

struct Case {
    std::string shape;
    ProbingKind probing;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.shape; }

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const auto& shape : {"plane", "sphere", "cube", "thin_plate", "fin", "crossing_curves",
                              "curve_on_surface", "open_sheet", "density_step", "helix"}) {
        all.push_back({shape, ProbingKind::AsOrthogonalAsPossible});
        all.push_back({shape, ProbingKind::NoiseAware});
    }
    all.push_back({"cube", ProbingKind::NearestPoint});
    return all;
}

struct CaseName {
    std::string operator()(const testing::TestParamInfo<Case>& test) const {
        std::string name;
        for (const char c : test.param.shape) {
            if (c != '_') name += c;
        }
        switch (test.param.probing) {
            case ProbingKind::AsOrthogonalAsPossible: return name + "Orthogonal";
            case ProbingKind::NoiseAware: return name + "NoiseAware";
            case ProbingKind::NearestPoint: return name + "NearestPoint";
            case ProbingKind::NearestTriangle: return name + "NearestTriangle";
        }
        return name;
    }
};

class AnalysisOf : public testing::TestWithParam<Case> {
protected:
    const Shape shape = shape_named(GetParam().shape, 1500, 0.01);
    const AnalysisParams params = [this] {
        AnalysisParams p = small_params(0.3);
        p.probing = GetParam().probing;
        return p;
    }();
};

TEST_P(AnalysisOf, IsSound) {
    const AnalysisResult result = analyze(shape, params, {});
    expect_sound(result);
    EXPECT_EQ(result.energy.size(), 3U);
    EXPECT_EQ(result.radius, params.radius);
    EXPECT_EQ(result.lambda, params.lambda);
}

TEST_P(AnalysisOf, LearningAndPoseNeverRaiseTheEnergy) {
    // All LPFs are learned on: the sample is larger than their number.
    const AnalysisResult result = analyze(shape, params, {});
    ASSERT_LT(result.frames.size(), static_cast<std::size_t>(params.learning_sample));
    for (std::size_t i = 0; i < result.energy.size(); ++i) {
        const IterationEnergy& now = result.energy[i];
        ASSERT_TRUE(std::isfinite(now.learning + now.pose + now.probing));
        EXPECT_LE(now.pose, now.learning * (1 + 1e-4) + 1e-6) << "iteration " << i;
        if (i == 0) continue;
        const double before = result.energy[i - 1].probing;
        EXPECT_LE(now.learning, before * (1 + 1e-4) + 1e-6) << "iteration " << i;
    }
}

TEST_P(AnalysisOf, DoesNotDependOnTheNumberOfThreads) {
    const AnalysisResult one = analyze(shape, params, {.threads = 1});
    EXPECT_TRUE(identical(analyze(shape, params, {.threads = 2}), one));
    EXPECT_TRUE(identical(analyze(shape, params, {.threads = 5}), one));
}

INSTANTIATE_TEST_SUITE_P(Shapes, AnalysisOf, testing::ValuesIn(cases()), CaseName());

TEST(Analysis, OfAPlaneNeedsNoDeformation) {
    AnalysisParams params = small_params(0.3);
    params.probing = ProbingKind::NoiseAware;
    std::size_t flat = 0;
    std::size_t all = 0;
    // One draw of seeds alone has 64 to 75 % of them off the border.
    for (params.random_seed = 1; params.random_seed <= 6; ++params.random_seed) {
        const AnalysisResult result = analyze(shape_named("plane", 4000), params, {});
        all += result.frames.size();
        for (std::size_t j = 0; j < result.frames.size(); ++j) {
            flat += std::abs(result.frames[j].axes(2, 2)) > 0.999F && result.residuals[j] < 0.05F;
        }
    }
    EXPECT_GT(static_cast<double>(flat), 0.7 * static_cast<double>(all));
}

TEST(Analysis, TellsCurvesFromSurfaces) {
    const auto share_of_curves = [](const std::string& name) {
        const AnalysisResult result = analyze(shape_named(name, 3000, 0.01), small_params(0.3), {});
        const auto curves = std::ranges::count(result.dimensions, std::uint8_t{1});
        return static_cast<double>(curves) / static_cast<double>(result.dimensions.size());
    };
    EXPECT_LT(share_of_curves("sphere"), 0.01);
    EXPECT_LT(share_of_curves("cube"), 0.02);
    EXPECT_GT(share_of_curves("helix"), 0.95);
    EXPECT_GT(share_of_curves("line"), 0.95);
}

TEST(Analysis, SeedsKeepTheirDistanceAndZeroMeansOneForEachPoint) {
    const Shape shape = shape_named("sphere", 600);
    AnalysisParams params = small_params(0.4);
    const AnalysisResult result = analyze(shape, params, {});
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE((result.frames[i].centre - result.frames[j].centre).norm(), 0.5 * 0.4);
        }
    }
    params.seed_spacing = 0;
    EXPECT_EQ(analyze(shape, params, {}).frames.size(), 600U);
}

TEST(Analysis, ALargerDictionaryFitsBetter) {
    const Shape shape = shape_named("cube", 3000);
    AnalysisParams params = small_params(0.4);
    params.lambda = 0.02;
    const auto error = [&](int atoms) {
        params.atoms = atoms;
        double sum = 0;
        for (const float r : analyze(shape, params, {}).residuals) sum += r;
        return sum;
    };
    EXPECT_LT(error(16), error(1));
}

TEST(Analysis, ALargerLambdaGivesSparserCodes) {
    const Shape shape = shape_named("open_sheet", 2000, 0.02);
    AnalysisParams params = small_params(0.4);
    const auto used = [&](double lambda) {
        params.lambda = lambda;
        float sum = 0;
        for (const float share : analyze(shape, params, {}).usage) sum += share;
        return sum;
    };
    const float dense = used(0.01);
    EXPECT_LT(used(1.0), dense);
    EXPECT_EQ(used(1e6), 0);
}

TEST(Analysis, BothLassoMethodsReachTheSameEnergy) {
    const Shape shape = shape_named("cube", 1500, 0.01);
    AnalysisParams params = small_params(0.4);
    params.iterations = 1;
    const double descended = analyze(shape, params, {}).energy[0].learning;
    params.lasso = LassoMethod::Lars;
    EXPECT_NEAR(analyze(shape, params, {}).energy[0].learning, descended, 0.01 * descended);
}

TEST(Analysis, SurvivesMapCoordinates) {
    Shape shape = shape_named("cube", 1500, 0.01);
    const AnalysisParams params = small_params(0.4);
    const AnalysisResult near = analyze(shape, params, {});
    shape.cloud.points.colwise() += Eigen::Vector3d(1e7, -2e7, 5e6);
    const AnalysisResult far = analyze(shape, params, {});
    ASSERT_EQ(far.frames.size(), near.frames.size());
    EXPECT_NEAR(far.energy.back().probing, near.energy.back().probing,
                0.02 * near.energy.back().probing);
}

TEST(Analysis, RestartsFromADictionary) {
    const Shape shape = shape_named("cube", 2000, 0.01);
    AnalysisParams params = small_params(0.4);
    const AnalysisResult first = analyze(shape, params, {});
    params.initial_dictionary = first.dictionary;
    params.iterations = 1;
    const AnalysisResult warm = analyze(shape, params, {});
    params.initial_dictionary.reset();
    const AnalysisResult cold = analyze(shape, params, {});
    EXPECT_LT(warm.energy[0].learning, cold.energy[0].learning);
}

TEST(Analysis, KeepsADictionaryUnchangedWhenAskedTo) {
    const Shape shape = shape_named("sphere", 1000);
    AnalysisParams params = small_params(0.4);
    const Dictionary given = analyze(shape, params, {}).dictionary;
    params.initial_dictionary = given;
    params.keep_dictionary = true;
    const AnalysisResult result = analyze(shape_named("cube", 1500), params, {});
    expect_sound(result);
    for (int k = 0; k < given.atoms(); ++k) {
        EXPECT_TRUE(std::ranges::equal(result.dictionary.atom(k), given.atom(k)));
    }
}

TEST(Analysis, TakesThePatternOfAGivenDictionary) {
    AnalysisParams params = small_params(0.4);
    params.initial_dictionary = Dictionary(Pattern::grid(8), params.atoms);
    const AnalysisResult result = analyze(shape_named("cube", 800), params, {});
    EXPECT_EQ(result.dictionary.pattern().size(), Pattern::grid(8).size());
}

TEST(Analysis, RefusesADictionaryWithAnotherNumberOfAtoms) {
    AnalysisParams params = small_params(0.4);
    params.initial_dictionary = Dictionary(Pattern::grid(8), params.atoms + 1);
    EXPECT_EQ(code_of([&] { (void)analyze(shape_named("plane", 100), params, {}); }),
              ErrorCode::IncompatibleDictionary);
}

TEST(Analysis, RunsOnEveryKindOfPattern) {
    const Shape shape = shape_named("cube", 1000);
    AnalysisParams params = small_params(0.5);
    params.pattern.kind = PatternKind::RandomDisk;
    params.pattern.points = 100;
    expect_sound(analyze(shape, params, {}));
    params.pattern.kind = PatternKind::Custom;
    params.pattern.offsets = 0.5F * Eigen::Matrix3Xf::Random(3, 30);
    expect_sound(analyze(shape, params, {}));
}

TEST(Analysis, ProbesTheTrianglesOfAMesh) {
    AnalysisParams params = small_params(0.5);
    params.probing = ProbingKind::NearestTriangle;
    const AnalysisResult result = analyze(test::cube_mesh(1.0, 2), params, {});
    expect_sound(result);
    EXPECT_GT(result.frames.size(), 30U) << "26 vertices, but 24 of area";
}

TEST(Analysis, RefusesToProbeTrianglesOfACloud) {
    AnalysisParams params = small_params(0.5);
    params.probing = ProbingKind::NearestTriangle;
    EXPECT_EQ(code_of([&] { (void)analyze(shape_named("cube", 500), params, {}); }),
              ErrorCode::InvalidParameter);
}

TEST(Analysis, ReportsRisingProgressToTheEnd) {
    std::vector<double> fractions;
    Execution execution{.threads = 2};
    execution.progress = [&](const Progress& p) { fractions.push_back(p.fraction); };
    (void)analyze(shape_named("cube", 2000), small_params(0.4), execution);
    ASSERT_GT(fractions.size(), 5U);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_NEAR(fractions.back(), 1, 1e-9);
}

TEST(Analysis, StopsSoonAfterACancellation) {
    // At each report in turn: no phase may go on to the end.
    const Shape shape = shape_named("cube", 2000);
    for (const int at : {1, 2, 4, 8}) {
        std::stop_source source;
        int reports = 0;
        int after = 0;
        Execution execution{.threads = 2, .stop = source.get_token()};
        execution.progress = [&](const Progress&) {
            after += source.stop_requested();
            if (++reports == at) source.request_stop();
        };
        EXPECT_EQ(code_of([&] { (void)analyze(shape, small_params(0.4), execution); }),
                  ErrorCode::Cancelled);
        EXPECT_LE(after, 2) << "cancelled at report " << at;
    }
}

class AwkwardAnalysis : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(AwkwardAnalysis, GivesASoundResultOrAnErrorThatSaysWhy) {
    Shape shape;
    shape.cloud.points = GetParam().points;
    for (const double radius : {1e-6, 0.3, 1e3}) {
        AnalysisParams params = small_params(radius);
        for (const auto probing : {ProbingKind::AsOrthogonalAsPossible, ProbingKind::NoiseAware}) {
            params.probing = probing;
            if (shape.size() < 3) {
                EXPECT_EQ(code_of([&] { (void)analyze(shape, params, {}); }),
                          ErrorCode::TooFewPoints);
            } else if (GetParam().name == "AllEqual") {
                EXPECT_EQ(code_of([&] { (void)analyze(shape, params, {}); }),
                          ErrorCode::DegenerateShape);
            } else {
                expect_sound(analyze(shape, params, {}));
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, AwkwardAnalysis, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Analysis, RefusesCoordinatesThatAreNotFinite) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Shape shape = shape_named("plane", 100);
        shape.cloud.points(1, 50) = bad;
        EXPECT_EQ(code_of([&] { (void)analyze(shape, small_params(0.3), {}); }),
                  ErrorCode::InvalidParameter);
    }
}

}  // namespace
}  // namespace lpf
