#include "api/estimate.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lpf {
namespace {

Workload scan(double points) {
    return {.task = Task::Denoise,
            .points = points,
            .file_bytes = 15 * points,
            .row_bytes = 3,
            .probed_points = points,
            .fields = points / 8,
            .points_per_field = 60,
            .output_points = points};
}

ResolvedParameters parameters() {
    ResolvedParameters p;
    p.analysis.radius = 1;
    p.analysis.iterations = 1;
    p.denoise.analysis = p.analysis;
    return p;
}

TEST(Estimate, GrowsWithTheWork) {
    const Estimate small = estimate(scan(1e4), parameters(), 1, 1);
    const Estimate large = estimate(scan(1e6), parameters(), 1, 1);
    EXPECT_GT(large.seconds, 20 * small.seconds);
    EXPECT_GT(large.memory_bytes, 5 * small.memory_bytes);
    ResolvedParameters longer = parameters();
    longer.denoise.iterations = 6;
    EXPECT_GT(estimate(scan(1e6), longer, 1, 1).seconds, 2 * large.seconds);
}

TEST(Estimate, FallsWithSpeedAndThreads) {
    const double alone = estimate(scan(1e6), parameters(), 1, 1).seconds;
    EXPECT_NEAR(estimate(scan(1e6), parameters(), 2, 1).seconds, alone / 2, 1e-9);
    const double shared = estimate(scan(1e6), parameters(), 1, 4).seconds;
    EXPECT_LT(shared, 0.8 * alone);
    EXPECT_GT(shared, alone / 4);
}

TEST(Estimate, NeverPromisesLessMemoryThanThePointsThemselvesTake) {
    for (const double n : {1e3, 1e5, 1e7}) {
        for (const Task task : {Task::Denoise, Task::Resample, Task::Analyze}) {
            Workload work = scan(n);
            work.task = task;
            EXPECT_GT(estimate(work, parameters(), 1, 1).memory_bytes, 60 * n);
        }
    }
}

TEST(Estimate, KnowsHowManyPointsWillCome) {
    ResolvedParameters p = parameters();
    p.resample.analysis = p.analysis;
    EXPECT_EQ(expected_points(Task::Denoise, 500, 60, p), 500);
    p.resample.target_points = 2000;
    EXPECT_EQ(expected_points(Task::Resample, 500, 60, p), 2000);
    p.resample.target_points = 0;
    p.resample.target_spacing = 0.25;  // half of that of the seeds
    EXPECT_NEAR(expected_points(Task::Resample, 500, 60, p), 240, 1e-9);
}

TEST(Estimate, CountsTheBytesOfAttributes) {
    PointCloud cloud;
    cloud.points = Points::Zero(3, 10);
    const std::vector<float> values(10);
    cloud.attributes = {float_attribute("a", values), float_attribute("b", values)};
    EXPECT_EQ(attribute_row_bytes(cloud), 8);
    EXPECT_EQ(attribute_row_bytes({}), 0);
}

TEST(Estimate, MeasuresTheMachineOnce) {
    const double speed = machine_speed();
    EXPECT_GT(speed, 0.01);
    EXPECT_EQ(machine_speed(), speed);
}

TEST(Estimate, IsToldInWholeBytes) {
    const nlohmann::json json = to_json(Estimate{1.5, 1234.5}, scan(100), 2);
    EXPECT_EQ(json["memoryBytes"], 1234);
    EXPECT_EQ(json["outputPoints"], 100);
    Workload analysis = scan(100);
    analysis.task = Task::Analyze;
    EXPECT_FALSE(to_json(Estimate{}, analysis, 1).contains("outputPoints"));
}

}  // namespace
}  // namespace lpf
