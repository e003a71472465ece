#include "server/jobs/scheduling.h"

#include <gtest/gtest.h>

namespace lpf::server {
namespace {

WaitingJob job(const std::string& id, const std::string& owner = "", UnixMillis rank = 0) {
    return {.id = id, .owner = owner, .process = Task::Denoise, .points = 10, .rank = rank};
}

std::string order(const std::vector<WaitingJob>& jobs, const Owners& owners = {}) {
    std::string ids;
    for (const WaitingJob& each : in_turn(jobs, owners)) ids += each.id;
    return ids;
}

TEST(Scheduling, RanksGrowWithTimeAndSizeButNotWithoutEnd) {
    EXPECT_LT(rank_of(0, 10), rank_of(0, 1'000'000));
    EXPECT_LT(rank_of(0, 1'000'000), rank_of(3'600'000, 10));
    EXPECT_EQ(rank_of(0, 20'000'000'000), rank_of(0, UINT64_MAX));
    EXPECT_LE(rank_of(0, UINT64_MAX), 10 * 60 * 1000);
}

TEST(Scheduling, WithinAnOwnerRankDecidesAndThenArrival) {
    EXPECT_EQ(order({job("a", "", 5), job("b", "", 3), job("c", "", 5)}), "bac");
}

TEST(Scheduling, OwnersAlternate) {
    EXPECT_EQ(order({job("a", "x", 1), job("b", "x", 2), job("c", "x", 3), job("d", "y", 9)}),
              "adbc");
}

TEST(Scheduling, WhoeverRunsLessComesFirst) {
    EXPECT_EQ(order({job("a", "x", 1), job("b", "y", 9)}, {{"x", {1, 0}}}), "ba");
}

TEST(Scheduling, WhoeverWasServedLongestAgoComesFirst) {
    EXPECT_EQ(order({job("a", "x", 1), job("b", "y", 9)}, {{"x", {0, 7}}, {"y", {0, 3}}}), "ba");
}

std::string next(const std::vector<WaitingJob>& jobs, const TurnRules& rules) {
    const WaitingJob* found = next_turn(jobs, {}, rules);
    return found ? found->id : "";
}

TEST(Scheduling, AJobThatFindsTooLittleMemoryIsPassedUntilItsRankIsReached) {
    WaitingJob large = job("large", "", 1000);
    large.memory = 80;
    WaitingJob small = job("small", "", 2000);
    small.memory = 20;
    EXPECT_EQ(next({large, small}, {}), "large");
    EXPECT_EQ(next({large, small}, {.memory_free = 80, .now = 500}), "large");
    EXPECT_EQ(next({large, small}, {.memory_free = 50, .now = 500}), "small");
    EXPECT_EQ(next({large, small}, {.memory_free = 50, .now = 1000}), "");
    EXPECT_EQ(next({small}, {.memory_free = 10, .now = 500}), "");
}

TEST(Scheduling, AWorkerForSmallJobsWaitsWithALargeOneThatLacksMemory) {
    WaitingJob large = job("large", "", 1000);
    large.memory = 80;
    const WaitingJob small = job("small", "", 2000);
    const TurnRules rules{.small_only = true, .small_points = 5, .memory_free = 50, .now = 1000};
    large.points = 1000;
    EXPECT_EQ(next({large, small}, rules), "");
}

TEST(Scheduling, EachJobStartsWhenAWorkerIsFree) {
    EXPECT_EQ(start_times({4, 1}, {10, 2, 3}), (std::vector<double>{1, 4, 6}));
    EXPECT_EQ(start_times({0}, {5, 5}), (std::vector<double>{0, 5}));
    EXPECT_TRUE(start_times({}, {1}).empty());
}

}  // namespace
}  // namespace lpf::server
