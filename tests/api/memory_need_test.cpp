#include "api/memory_need.h"

#include <gtest/gtest.h>

#include "api/estimate.h"
#include "api/problem.h"

namespace lpf {
namespace {

ShapeInfo scan(std::uint64_t points) {
    ShapeInfo shape;
    shape.format = "ply";
    shape.points = points;
    shape.bytes = 15 * points;
    shape.attributes = {{"red", "uint8"}, {"green", "uint8"}, {"blue", "uint8"}};
    return shape;
}

double exact(Task task, double points, double fields_per_point) {
    ResolvedParameters p;
    p.analysis.radius = 1;
    if (task == Task::Resample) p.resample.denoise = DenoiseParams{};
    const Workload work{.task = task,
                        .points = points,
                        .file_bytes = 15 * points,
                        .row_bytes = 3,
                        .probed_points = points,
                        .fields = fields_per_point * points,
                        .points_per_field = 30,
                        .output_points = points};
    return estimate(work, p, 1, 1).memory_bytes;
}

TEST(MemoryNeed, TheEstimateOfALookLiesInTheRange) {
    for (const Task task : {Task::Denoise, Task::Resample, Task::Analyze}) {
        const MemoryRange range = memory_range(task, {}, scan(1'000'000));
        ASSERT_TRUE(range.most);
        for (const double fields : {0.01, 0.1, 0.3, 1.0}) {
            EXPECT_LE(range.least, exact(task, 1e6, fields));
            EXPECT_GE(*range.most, exact(task, 1e6, fields));
        }
    }
}

TEST(MemoryNeed, AStreamedJobNeedsFarLess) {
    const MemoryRange held = memory_range(Task::Denoise, {}, scan(15'000'000));
    const MemoryRange streamed = memory_range(Task::Denoise, {}, scan(15'000'000), 2);
    ASSERT_TRUE(streamed.most);
    EXPECT_LT(*streamed.most, 0.6 * held.least);
    EXPECT_LT(memory_range(Task::Denoise, {}, scan(100'000'000), 2).least, 3e9);
    EXPECT_GT(memory_range(Task::Denoise, {}, scan(15'000'000), 4).least, streamed.least);
    // A radius of the user's may make as many LPFs as there are points.
    EXPECT_GT(*memory_range(Task::Denoise, {.radius = 1.0}, scan(15'000'000), 2).most,
              2 * *streamed.most);
}

TEST(MemoryNeed, OnlyALookTellsWhatDependsOnMoreThanCounts) {
    ShapeInfo mesh = scan(1000);
    mesh.faces = 2000;
    EXPECT_TRUE(memory_range(Task::Denoise, {}, mesh).most);
    EXPECT_FALSE(memory_range(Task::Analyze, {}, mesh).most);
    EXPECT_FALSE(memory_range(Task::Resample, {.target_spacing = 0.1}, scan(1000)).most);
    EXPECT_FALSE(memory_range(Task::Denoise, {.dictionary = "id"}, scan(1000)).most);
}

TEST(MemoryNeed, GrowsWithWhatIsAskedFor) {
    const double plain = memory_range(Task::Resample, {}, scan(10'000)).least;
    EXPECT_GT(memory_range(Task::Resample, {.target_points = 1'000'000}, scan(10'000)).least,
              plain + 48e6);
    EXPECT_GT(memory_range(Task::Resample, {.factor = 100}, scan(10'000)).least, plain + 48e6);
    EXPECT_GT(memory_range(Task::Denoise, {.format = FileFormat::Draco}, scan(1'000'000)).least,
              memory_range(Task::Denoise, {}, scan(1'000'000)).least);
}

TEST(MemoryNeed, ARefusalNamesTheBudgetAndTheEstimate) {
    EXPECT_NO_THROW(require_memory(100, 100));
    try {
        require_memory(300.0 * (1 << 20), 256 << 20);
        FAIL() << "300 MiB do not fit into 256 MiB";
    } catch (const ProblemException& error) {
        EXPECT_EQ(error.problem().status(), 422);
        EXPECT_EQ(error.problem().code(), "out-of-memory");
        EXPECT_NE(error.problem().detail.find("300 MiB"), std::string::npos);
        EXPECT_NE(error.problem().detail.find("256 MiB"), std::string::npos);
        const auto& members = error.problem().members;
        EXPECT_EQ(std::get<std::int64_t>(members[1].second), 256 << 20);
        EXPECT_EQ(std::get<std::int64_t>(members[2].second), 300 << 20);
    }
}

}  // namespace
}  // namespace lpf
