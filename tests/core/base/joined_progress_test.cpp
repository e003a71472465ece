#include "core/base/joined_progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace lpf {
namespace {

TEST(JoinedProgress, RisesToTheWholeWhilePartsGoOnSideBySide) {
    std::vector<double> fractions;
    std::vector<std::size_t> done;
    const Execution execution{.threads = 2, .progress = [&](const Progress& progress) {
                                  EXPECT_EQ(progress.phase, "denoise");
                                  EXPECT_EQ(progress.unit, "tiles");
                                  EXPECT_EQ(progress.total, 2U);
                                  fractions.push_back(progress.fraction);
                                  done.push_back(progress.done);
                              }};
    const JoinedProgress joined(execution, "denoise", "tiles", 2);
    const Execution a = joined.part(1);
    const Execution b = joined.part(1);
    for (const double at : {0.0, 0.5, 1.0}) {
        const Progress progress{"vote", 0, 0, "fields", at};
        a.progress(progress);
        b.progress(progress);
    }
    EXPECT_EQ(fractions, (std::vector<double>{0, 0, 0.25, 0.5, 0.75, 1}));
    EXPECT_EQ(done, (std::vector<std::size_t>{0, 0, 0, 1, 1, 2}));
}

TEST(JoinedProgress, StepsOfAPartAreNotCountedTwice) {
    double last = 0;
    const Execution execution{.progress = [&](const Progress& p) { last = p.fraction; }};
    const Execution part = JoinedProgress(execution, "denoise", "tiles", 1).part(1);
    parallel_for(part_of(part, 0.0, 0.5), "a", "x", 10, 3, [](auto, auto, auto) {});
    EXPECT_DOUBLE_EQ(last, 0.5);
    parallel_for(part_of(part, 0.5, 1.0), "b", "x", 10, 3, [](auto, auto, auto) {});
    EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(JoinedProgress, WithoutASinkThereIsNone) {
    EXPECT_FALSE(JoinedProgress({}, "denoise", "tiles", 3).part(2).progress);
    EXPECT_EQ(JoinedProgress({}, "denoise", "tiles", 3).part(2).threads, 2);
}

}  // namespace
}  // namespace lpf
