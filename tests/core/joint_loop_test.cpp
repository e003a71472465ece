// The joint loop and the LPFs that it works on, against the steps of the paper taken one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "core/field_set.h"
#include "core/gathered_fields.h"
#include "core/learn/dictionary_learning.h"
#include "core/learn/pose.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

/// A thin plate, so that LPFs have several sizes, and points too lonely for an LPF.
Shape plate() {
    const Points points = test::make_thin_plate({.points = 1500, .noise = 0.02}, 0.2).points;
    Shape shape;
    shape.cloud.points.resize(3, points.cols() + 3);
    shape.cloud.points << points, 9 * Eigen::Matrix3d::Identity();
    return shape;
}

AnalysisParams params_for_plate() {
    AnalysisParams params;
    params.radius = 0.35;
    params.atoms = 6;
    params.lambda = 0.1;
    params.iterations = 1;
    return params;
}

double squared_misfit(const FieldSet::Worker& worker) {
    double sum = 0;
    for (std::size_t i = 0; i < worker.field.size(); ++i) {
        sum += std::pow(double{worker.field[i]} - double{worker.decoded[i]}, 2);
    }
    return sum;
}

double l1(std::span<const float> code) {
    double sum = 0;
    for (const float value : code) sum += std::abs(double{value});
    return sum;
}

TEST(JointLoop, OneIterationIsTheStepsOfThePaper) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    FieldSet start(shape, params, {});
    params.initial_dictionary = analyze(start, params, {}).dictionary;
    params.keep_dictionary = true;
    const Dictionary& dictionary = *params.initial_dictionary;

    FieldSet fields(shape, params, {});
    std::vector<Frame> moved = fields.frames;
    SparseCodes codes(fields.size(), params.atoms);
    IterationEnergy expected;
    const Coder coder{static_cast<float>(params.lambda)};
    const auto energy = [&](std::size_t j, const FieldSet::Worker& worker) {
        return (squared_misfit(worker) +
                params.lambda * double{fields.lambda_share(j)} * l1(codes[j])) /
               static_cast<double>(fields.size());
    };
    const CodingMatrices matrices(dictionary);
    fields.for_each_probed("", {}, [&](std::size_t j, auto& worker, std::size_t) {
        coder.encode(matrices, worker.field, codes[j], fields.lambda_share(j));
        dictionary.decode(codes[j], worker.decoded);
        expected.learning += energy(j, worker);
        const RigidFit fit = fit_pose(fields.pattern(), worker.field.data(), worker.decoded.data());
        apply_pose(fit, moved[j]);
        move_field(fields.pattern(), fit, worker.field.data());
        expected.pose += energy(j, worker);
    });
    fields.frames = moved;
    fields.for_each_probed("", {}, [&](std::size_t j, auto& worker, std::size_t) {
        dictionary.decode(codes[j], worker.decoded);
        expected.probing += energy(j, worker);
    });

    FieldSet again(shape, params, {});
    const AnalysisResult result = analyze(again, params, {});
    ASSERT_EQ(result.energy.size(), 1U);
    EXPECT_NEAR(result.energy[0].learning, expected.learning, 1e-4 * expected.learning);
    EXPECT_NEAR(result.energy[0].pose, expected.pose, 1e-4 * expected.pose);
    EXPECT_NEAR(result.energy[0].probing, expected.probing, 1e-4 * expected.probing);
    EXPECT_LT(expected.pose, expected.learning);
    for (std::size_t j = 0; j < moved.size(); ++j) {
        EXPECT_EQ(result.frames[j].origin, moved[j].origin);
        EXPECT_EQ(result.frames[j].axes, moved[j].axes);
    }
}

TEST(JointLoop, ALaterIterationDoesNotChangeTheEnergyOfAnEarlierOne) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    const IterationEnergy alone = analyze(shape, params, {}).energy.front();
    params.iterations = 2;
    const IterationEnergy first = analyze(shape, params, {}).energy.front();
    EXPECT_EQ(first.learning, alone.learning);
    EXPECT_EQ(first.pose, alone.pose);
    EXPECT_EQ(first.probing, alone.probing) << "measured with the dictionary of its own iteration";
}

TEST(JointLoop, FinalCodesSolveTheLassoOfTheFinalPoses) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    for (const bool debiased : {false, true}) {
        params.debias = debiased;
        FieldSet fields(shape, params, {});
        const AnalysisResult result = analyze(fields, params, {});
        std::vector<float> usage(6, 0.0F);
        fields.for_each_probed("", {}, [&](std::size_t j, auto& worker, std::size_t) {
            result.dictionary.decode(result.codes[j], worker.decoded);
            const double rms = std::sqrt(squared_misfit(worker) / fields.pattern().size());
            ASSERT_NEAR(result.residuals[j], rms, 1e-4);
            const double lambda = params.lambda * double{fields.lambda_share(j)};
            for (int k = 0; k < 6; ++k) {
                const double value = double{result.codes[j][static_cast<std::size_t>(k)]};
                double slope = 0;
                for (std::size_t i = 0; i < worker.field.size(); ++i) {
                    slope += 2 * (double{worker.field[i]} - double{worker.decoded[i]}) *
                             double{result.dictionary.atom(k)[i]};
                }
                if (value == 0) {
                    ASSERT_LE(std::abs(slope), debiased ? 1e30 : lambda + 1e-3);
                } else {
                    usage[static_cast<std::size_t>(k)] += 1;
                    ASSERT_NEAR(slope, debiased ? 0 : std::copysign(lambda, value), 1e-3);
                }
            }
        });
        for (std::size_t k = 0; k < 6; ++k) {
            EXPECT_NEAR(result.usage[k], usage[k] / static_cast<float>(fields.size()), 1e-6);
        }
    }
}

TEST(JointLoop, LearnsOnASampleOfTheLpfsWithTheirSharesOfLambda) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    params.learning_sample = 60;
    FieldSet fields(shape, params, {});
    const std::vector<std::size_t> drawn = fields.draw_sample(60, params.random_seed);
    FieldSample sample{fields.probe_sample(drawn, {}),
                       3 * static_cast<std::size_t>(fields.pattern().padded_size()),
                       {}};
    for (const std::size_t j : drawn) sample.lambda_share.push_back(fields.lambda_share(j));
    Dictionary expected = draw_dictionary(fields.pattern(), 6, sample, params.random_seed);
    SparseCodes codes(sample.count(), 6);
    learn_dictionary(sample, {static_cast<float>(params.lambda)}, params.learning_rounds,
                     params.random_seed, expected, codes, {});
    const AnalysisResult result = analyze(fields, params, {});
    for (int k = 0; k < 6; ++k) {
        EXPECT_TRUE(std::ranges::equal(result.dictionary.atom(k), expected.atom(k)));
    }
}

TEST(JointLoop, DebiasesTheLastCodesOnly) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    params.iterations = 2;
    const AnalysisResult plain = analyze(shape, params, {});
    params.debias = true;
    const AnalysisResult debiased = analyze(shape, params, {});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(debiased.energy[i].learning, plain.energy[i].learning);
        EXPECT_EQ(debiased.energy[i].pose, plain.energy[i].pose);
    }
    EXPECT_NE(debiased.residuals, plain.residuals);
}

TEST(AnalysisLimits, AreThoseOfTheDocumentation) {
    const auto accepts = [](const std::function<void(AnalysisParams&)>& set) {
        AnalysisParams params;
        params.radius = 1;
        set(params);
        try {
            validate(params);
        } catch (const Error&) {
            return false;
        }
        return true;
    };
    EXPECT_TRUE(accepts([](auto& p) { p.target_radius = 2.0; }));
    EXPECT_FALSE(accepts([](auto& p) { p.target_radius = 2.01; }));
    EXPECT_TRUE(accepts([](auto& p) { p.seed_spacing = 1.0; }));
    EXPECT_FALSE(accepts([](auto& p) { p.seed_spacing = 1.01; }));
    EXPECT_TRUE(accepts([](auto& p) { p.learning_rounds = 100; }));
    EXPECT_FALSE(accepts([](auto& p) { p.learning_rounds = 101; }));
    EXPECT_TRUE(accepts([](auto& p) { p.smoothing = 0.5; }));
    EXPECT_FALSE(accepts([](auto& p) { p.smoothing = 0.51; }));
    EXPECT_TRUE(accepts([](auto& p) { p.noise = 0; }));
    EXPECT_FALSE(accepts([](auto& p) { p.noise = -0.01; }));
}

TEST(JointLoop, FollowersGoTheWayOfTheLeaders) {
    // The dictionary is learned on some LPFs, or given: what is done to the others is the same.
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    params.iterations = 3;
    FieldSet start(shape, params, {});
    params.initial_dictionary = analyze(start, params, {}).dictionary;
    params.keep_dictionary = true;
    FieldSet all_lead(shape, params, {});
    const AnalysisResult expected = analyze(all_lead, params, {});
    ASSERT_GT(all_lead.usable().size(), 100U);
    params.learning_sample = 7;
    FieldSet most_follow(shape, params, {});
    const AnalysisResult result = analyze(most_follow, params, {});
    EXPECT_EQ(result.codes.values(), expected.codes.values());
    EXPECT_EQ(result.residuals, expected.residuals);
    for (std::size_t j = 0; j < expected.frames.size(); ++j) {
        ASSERT_EQ(result.frames[j].axes, expected.frames[j].axes);
        ASSERT_EQ(result.frames[j].origin, expected.frames[j].origin);
    }
    ASSERT_EQ(result.energy.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(result.energy[i].learning, expected.energy[i].learning, 1e-12);
        EXPECT_NEAR(result.energy[i].pose, expected.energy[i].pose, 1e-12);
        EXPECT_NEAR(result.energy[i].probing, expected.energy[i].probing, 1e-12);
    }
}

TEST(JointLoop, APathInPiecesIsTheSamePath) {
    // Dictionaries so large that few of them are at hand together.
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    params.pattern.points = 1500;
    params.atoms = 48;
    params.learning_sample = 50;
    params.iterations = 5;
    const AnalysisResult result = analyze(shape, params, {});
    const AnalysisResult again = analyze(shape, params, {.threads = 2});
    EXPECT_EQ(result.codes.values(), again.codes.values());
    params.iterations = 1;
    const AnalysisResult first = analyze(shape, params, {});
    EXPECT_EQ(result.energy[0].learning, first.energy[0].learning);
    EXPECT_EQ(result.energy[0].probing, first.energy[0].probing);
    for (std::size_t i = 1; i < result.energy.size(); ++i) {
        EXPECT_LE(result.energy[i].pose, result.energy[i].learning);
        EXPECT_GT(result.energy[i].probing, 0.0);
    }
}

TEST(GatheredFields, AreProbedAsThoseThatAreGatheredAnew) {
    const Shape shape = plate();
    FieldSet fields(shape, params_for_plate(), {});
    const std::vector<std::size_t> numbers = fields.usable();
    GatheredFields gathered(fields, numbers);
    FieldSet::Worker worker = fields.make_worker();
    AlignedFloats field(worker.field.size());
    for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            fields.probe(numbers[i], worker.probe, worker.field.data());
            gathered.probe(i, field.data());
            ASSERT_EQ(field, worker.field);
        }
        fields.optimise_poses(1, {});  // they move; what was gathered stays good
    }
}

TEST(GatheredFields, KeepNoMorePointsThanTheyMay) {
    Shape shape;
    shape.cloud.points = test::make_plane({.points = 60000}).points;
    AnalysisParams params = params_for_plate();
    params.radius = 0.9;  // so many LPFs hold more points than are kept
    const FieldSet fields(shape, params, {});
    const std::vector<std::size_t> numbers = fields.usable();
    GatheredFields gathered(fields, numbers);
    FieldSet::Worker worker = fields.make_worker();
    AlignedFloats field(worker.field.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        fields.probe(numbers[i], worker.probe, worker.field.data());
        gathered.probe(i, field.data());
        ASSERT_EQ(field, worker.field);
    }
}

TEST(FieldSet, PassesOverLpfsOfTooFewPoints) {
    const Shape shape = plate();
    const FieldSet fields(shape, params_for_plate(), {});
    const auto lonely = std::ranges::count(fields.dimensions, std::uint8_t{kTooFewPoints});
    ASSERT_GE(lonely, 3);
    std::size_t probed = 0;
    fields.for_each_probed("", {}, [&](std::size_t j, auto&, std::size_t) {
        ++probed;
        EXPECT_NE(fields.dimensions[j], kTooFewPoints);
    });
    EXPECT_EQ(probed, fields.size() - static_cast<std::size_t>(lonely));
}

TEST(FieldSet, DrawsUsableLpfsInOrderAtRandom) {
    const Shape shape = plate();
    const FieldSet fields(shape, params_for_plate(), {});
    const std::vector<std::size_t> all = fields.draw_sample(1 << 20, 1);
    const auto lonely = std::ranges::count(fields.dimensions, std::uint8_t{kTooFewPoints});
    EXPECT_EQ(all.size(), fields.size() - static_cast<std::size_t>(lonely));
    std::set<std::size_t> seen;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const std::vector<std::size_t> some = fields.draw_sample(20, seed);
        ASSERT_EQ(some.size(), 20U);
        EXPECT_TRUE(std::ranges::is_sorted(some));
        EXPECT_EQ(std::ranges::adjacent_find(some), some.end()) << "drawn twice";
        for (const std::size_t j : some) EXPECT_NE(fields.dimensions[j], kTooFewPoints);
        seen.insert(some.begin(), some.end());
    }
    EXPECT_GT(seen.size(), std::min(all.size(), std::size_t{200}) / 2) << "always the same ones";
}

TEST(FieldSet, GathersAsFarAsTheTargetRadius) {
    Shape shape;
    shape.cloud.points = test::make_plane({.points = 3000}).points;
    for (const double reach : {1.0, 1.4, 2.0}) {
        AnalysisParams params = params_for_plate();
        params.target_radius = reach;
        const FieldSet fields(shape, params, {});
        float farthest = 0;
        fields.for_each_target("", {}, [&](std::size_t, auto& worker, std::size_t) {
            for (std::size_t i = 0; i < worker.probe.target.size; ++i) {
                farthest = std::max(farthest,
                                    std::hypot(worker.probe.target.x[i], worker.probe.target.y[i]));
            }
        });
        EXPECT_NEAR(farthest, reach, 0.02);
    }
}

TEST(FieldSet, FirstPosesAreRandomWhereAskedTo) {
    Shape shape;
    shape.cloud.points = test::make_plane({.points = 2000}).points;
    AnalysisParams params = params_for_plate();
    params.principal_frames = false;
    const FieldSet fields(shape, params, {});
    double tilt = 0;
    for (std::size_t j = 0; j < fields.size(); ++j) {
        tilt += std::abs(double{fields.frames[j].axes(2, 2)}) / static_cast<double>(fields.size());
        if (j > 0) {
            EXPECT_NE(fields.frames[j].axes, fields.frames[j - 1].axes);
        }
    }
    EXPECT_NEAR(tilt, 0.5, 0.15) << "uniform on the sphere";
    params.random_seed = 2;
    EXPECT_NE(FieldSet(shape, params, {}).frames[0].axes, fields.frames[0].axes);
}

TEST(FieldSet, SeedsAndRandomPatternsDependOnTheSeed) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    params.pattern = {.kind = PatternKind::RandomDisk, .points = 50};
    const FieldSet one(shape, params, {});
    params.random_seed = 2;
    const FieldSet two(shape, params, {});
    EXPECT_NE(one.pattern().point(7), two.pattern().point(7));
    std::set<double> first;
    for (const Frame& frame : one.frames) first.insert(frame.centre.x());
    std::size_t shared = 0;
    for (const Frame& frame : two.frames) shared += first.count(frame.centre.x());
    EXPECT_LT(shared, two.size()) << "the same seeds";
}

TEST(FieldSet, SamplesAMeshFinerThanATenthOfTheRadius) {
    const Shape mesh = test::plane_grid(1.0, 2);
    AnalysisParams params = params_for_plate();
    params.probing = ProbingKind::NearestTriangle;
    const FieldSet fields(mesh, params, {});
    // Triangles have an area of half a square of side .1 r at most.
    EXPECT_GE(static_cast<double>(fields.grid().size()), 4.0 / (0.5 * 0.035 * 0.035));
}

TEST(FieldSet, LambdaGrowsWithTheSquareOfTheShrinking) {
    const Shape shape = plate();
    AnalysisParams params = params_for_plate();
    params.noise = 0.02;
    params.adapt_radius = true;
    const FieldSet fields(shape, params, {});
    std::set<float> shares;
    for (std::size_t j = 0; j < fields.size(); ++j) {
        shares.insert(fields.lambda_share(j));
        EXPECT_NEAR(fields.lambda_share(j), std::pow(0.35 / fields.frames[j].radius, 2), 1e-5);
    }
    EXPECT_GT(shares.size(), 1U);
}

}  // namespace
}  // namespace lpf
