#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "core/analysis.h"
#include "core/base/error.h"

namespace lpf {
namespace {

TEST(AnalysisParameters, AreCheckedEachUnderItsName) {
    const auto field_of = [](const std::function<void(AnalysisParams&)>& spoil) {
        AnalysisParams params;
        params.radius = 0.3;
        spoil(params);
        try {
            validate(params);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
            return error.field();
        }
        return std::string("accepted");
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(field_of([](AnalysisParams&) {}), "accepted");
    EXPECT_EQ(field_of([](auto& p) { p.radius = 0; }), "radius");
    EXPECT_EQ(field_of([&](auto& p) { p.radius = nan; }), "radius");
    EXPECT_EQ(field_of([](auto& p) { p.atoms = 0; }), "atoms");
    EXPECT_EQ(field_of([](auto& p) { p.atoms = 257; }), "atoms");
    EXPECT_EQ(field_of([](auto& p) { p.lambda = -0.1; }), "lambda");
    EXPECT_EQ(field_of([&](auto& p) { p.lambda = nan; }), "lambda");
    EXPECT_EQ(field_of([](auto& p) { p.iterations = 0; }), "analysisIterations");
    EXPECT_EQ(field_of([](auto& p) { p.iterations = 1001; }), "analysisIterations");
    EXPECT_EQ(field_of([](auto& p) { p.target_radius = 0.9; }), "targetRadius");
    EXPECT_EQ(field_of([](auto& p) { p.seed_spacing = -1; }), "seedSpacing");
    EXPECT_EQ(field_of([](auto& p) { p.pose_iterations = 51; }), "poseIterations");
    EXPECT_EQ(field_of([](auto& p) { p.learning_sample = 0; }), "learningSample");
    EXPECT_EQ(field_of([](auto& p) { p.learning_rounds = 0; }), "learningRounds");
    EXPECT_EQ(field_of([](auto& p) { p.smoothing = 0.01; }), "smoothing");
}

}  // namespace
}  // namespace lpf
