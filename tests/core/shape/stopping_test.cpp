// Every stage that looks at all points ends soon after it was told to.

#include "tests/support/stopping.h"

#include <gtest/gtest.h>

#include "core/shape/noise.h"
#include "core/shape/normals.h"
#include "core/shape/outliers.h"
#include "core/shape/poisson_sampling.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

using namespace std::chrono_literals;

constexpr double kSoon = 0.5;  // seconds

struct Stage {
    const char* name;
    void (*work)(const Points&, const Execution&);
};

void PrintTo(const Stage& stage, std::ostream* out) { *out << stage.name; }

const Stage kStages[] = {
    {"Index",
     [](const Points& points, const Execution& e) { const SpatialIndex index(points, e); }},
    {"Duplicates",
     [](const Points& points, const Execution& e) { (void)find_duplicates(points, e); }},
    {"Outliers",
     [](const Points& points, const Execution& e) { (void)find_outliers(points, 6, e); }},
    {"Normals",
     [](const Points& points, const Execution& e) { (void)estimate_normals(points, 16, e); }},
    {"Measure", [](const Points& points, const Execution& e) { (void)measure(points, e); }},
    {"Seeds", [](const Points& points, const Execution& e) {
         (void)poisson_disk_subset(points, 0.01, 1, e);
     }}};

class Stopping : public testing::TestWithParam<Stage> {};

TEST_P(Stopping, IsDoneBeforeAnythingElse) {
    const Points points = Points::Random(3, 100'000);
    EXPECT_TRUE(time_to_stop(0ms, [&](const Execution& execution) {
                    Execution stopped = execution;
                    std::stop_source fired;
                    fired.request_stop();
                    stopped.stop = fired.get_token();
                    GetParam().work(points, stopped);
                }).has_value());
}

TEST_P(Stopping, TakesNoSecondAmongAMillionPoints) {
    const Points points = Points::Random(3, 1'000'000);
    for (const auto delay : {5ms, 40ms, 150ms, 400ms}) {
        const auto seconds = time_to_stop(
            delay, [&](const Execution& execution) { GetParam().work(points, execution); });
        if (!seconds) break;  // done before
        EXPECT_LT(seconds->count(), kSoon) << delay.count() << " ms after the start";
    }
}

INSTANTIATE_TEST_SUITE_P(Stages, Stopping, testing::ValuesIn(kStages),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Stopping, OfAHeapOfDuplicatesIsQuick) {
    const Points points = Points::Constant(3, 2'000'000, 0.5);
    const auto flags = find_duplicates(points);
    EXPECT_EQ(std::count(flags.begin(), flags.end(), 1), 1'999'999);
    const auto seconds = time_to_stop(
        2ms, [&](const Execution& execution) { (void)find_duplicates(points, execution); });
    if (seconds) {
        EXPECT_LT(seconds->count(), kSoon);
    }
}

}  // namespace
}  // namespace lpf
