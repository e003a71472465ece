// Turns, limits, Idempotency-Keys, and many threads at once.
#include <atomic>
#include <set>
#include <thread>

#include "server/job_store.h"
#include "tests/server/store/job_store_suite.h"

namespace lpf::server {
namespace {

class JobStoreTurns : public JobStoreSuite {
protected:
    [[nodiscard]] std::vector<std::string> waiting() const {
        std::vector<std::string> ids;
        for (const WaitingJob& job : store_->waiting()) ids.push_back(job.id);
        return ids;
    }
};

TEST_P(JobStoreTurns, ClaimsTheOldestFirstAndEachOnce) {
    const std::string first = add_job();
    const std::string second = add_job();
    EXPECT_EQ(waiting(), (std::vector{first, second}));
    EXPECT_EQ(claimed_id(), first);
    EXPECT_EQ(waiting(), std::vector{second});
    EXPECT_EQ(claimed_id(), second);
    EXPECT_EQ(claimed_id(), "");
}

TEST_P(JobStoreTurns, ASmallJobOvertakesALargeOneThatHasNotWaitedLong) {
    const std::string large = add_job("", 1'000'000);
    const std::string small = add_job("", 1000, kNow + 5000);
    EXPECT_EQ(waiting(), (std::vector{small, large}));
    const std::string late = add_job("", 1000, kNow + kDay);
    EXPECT_EQ(waiting(), (std::vector{small, large, late}));
}

TEST_P(JobStoreTurns, OwnersTakeTurns) {
    std::vector<std::string> many;
    for (int i = 0; i < 3; ++i) many.push_back(add_job("a"));
    EXPECT_EQ(claimed_id(), many[0]);
    const std::string other = add_job("b");
    EXPECT_EQ(claimed_id(), other);
    EXPECT_EQ(claimed_id(), many[1]);
}

TEST_P(JobStoreTurns, OwnersTakeTurnsOnASingleWorkerToo) {
    std::vector<std::string> order;
    for (int i = 0; i < 3; ++i) add_job("a");
    for (int i = 0; i < 3; ++i) add_job("b");
    for (auto job = claim(); job; job = claim()) {
        order.push_back(store_->waiting().empty() ? "" : store_->waiting()[0].owner);
        finish_job(*job, job->info.job_id);
    }
    EXPECT_EQ(order, (std::vector<std::string>{"b", "a", "b", "a", "b", ""}));
}

TEST_P(JobStoreTurns, AnOwnerRunsOnlySoMany) {
    add_job("a");
    add_job("a");
    const std::string other = add_job("b");
    const TurnRules rules{.running_per_owner = 1};
    EXPECT_NE(claimed_id(rules), "");
    EXPECT_EQ(claimed_id(rules), other);
    EXPECT_EQ(claimed_id(rules), "");
}

TEST_P(JobStoreTurns, AWorkerForSmallJobsLeavesLargeOnes) {
    const std::string large = add_job("", 500);
    const TurnRules rules{.small_only = true, .small_points = 100};
    EXPECT_EQ(claimed_id(rules), "");
    const std::string small = add_job("", 100, kNow + 1000);
    EXPECT_EQ(claimed_id(rules), small);
    EXPECT_EQ(claimed_id(), large);
}

TEST_P(JobStoreTurns, AJobIsClaimedWhenItsMemoryIsFree) {
    NewJob job = new_job();
    job.memory = 1ULL << 40;
    store_->add_job(job, {});
    EXPECT_EQ(claimed_id({.memory_free = (1ULL << 40) - 1}), "");
    const auto claimed = claim(kNow, {.memory_free = 1ULL << 40});
    ASSERT_TRUE(claimed);
    EXPECT_EQ(claimed->memory, 1ULL << 40);
}

TEST_P(JobStoreTurns, AFullQueueTakesNoJob) {
    const NewJob first = new_job();
    const NewJob second = new_job();
    store_->add_job(first, {.waiting = 1});
    EXPECT_EQ(problem_of([&] { store_->add_job(second, {.waiting = 1}); }), "queue-full");
    EXPECT_FALSE(store_->find_job(second.info.job_id));
    (void)claim();
    EXPECT_EQ(problem_of([&] { store_->add_job(second, {.waiting = 1}); }), "");
}

TEST_P(JobStoreTurns, AnOwnerQueuesOnlySoMany) {
    const QueueLimits limits{.waiting = 10, .waiting_per_owner = 1};
    store_->add_job(new_job("a"), limits);
    EXPECT_EQ(problem_of([&] { store_->add_job(new_job("a"), limits); }), "quota-exceeded");
    EXPECT_EQ(problem_of([&] { store_->add_job(new_job("b"), limits); }), "");
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(problem_of([&] { store_->add_job(new_job(""), limits); }), "");
}

TEST_P(JobStoreTurns, AMarkIsKeptWithItsJobAndUsedOnce) {
    NewJob job = new_job("a");
    job.mark = {"key", "print"};
    EXPECT_FALSE(store_->find_request("a", "key"));
    store_->add_job(job, {});
    EXPECT_EQ(store_->find_request("a", "key")->fingerprint, "print");
    EXPECT_EQ(store_->find_request("a", "key")->job_id, job.info.job_id);
    EXPECT_FALSE(store_->find_request("b", "key"));
    NewJob again = new_job("a");
    again.mark = job.mark;
    EXPECT_EQ(problem_of([&] { store_->add_job(again, {}); }), "idempotency-conflict");
    EXPECT_FALSE(store_->find_job(again.info.job_id));
    again.owner = "b";
    EXPECT_EQ(problem_of([&] { store_->add_job(again, {}); }), "");
}

TEST_P(JobStoreTurns, AMarkGoesWithItsJob) {
    NewJob job = new_job();
    job.mark = {"key", "print"};
    store_->add_job(job, {});
    finish_job(*claim());
    store_->remove_expired(kNow + 40 * kDay, 30 * kDay);
    EXPECT_FALSE(store_->find_request("", "key"));
}

TEST_P(JobStoreTurns, ARefusedJobLeavesNoMark) {
    NewJob job = new_job();
    job.mark = {"key", "print"};
    EXPECT_EQ(problem_of([&] { store_->add_job(job, {.waiting = 0}); }), "queue-full");
    EXPECT_FALSE(store_->find_request("", "key"));
}

TEST_P(JobStoreTurns, ManyThreadsAddAndClaimEveryJobOnce) {
    constexpr int kThreads = 8;
    constexpr int kJobs = 25;
    std::mutex mutex;
    std::set<std::string> added;
    std::vector<std::string> claimed;
    std::atomic<int> adding = kThreads;
    const ShapeInfo shape = add_shape();
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < kThreads; ++t) {
            threads.emplace_back([&, t] {
                for (int i = 0; i < kJobs; ++i) {
                    NewJob job{.info = {}, .owner = "owner" + std::to_string(t), .points = 10};
                    job.info.job_id = new_id();
                    job.info.created = job.info.updated = kNow + i;
                    job.info.shape = shape.id;
                    store_->add_job(job, {});
                    const std::lock_guard lock(mutex);
                    added.insert(job.info.job_id);
                }
                --adding;
            });
            threads.emplace_back([&] {
                for (;;) {
                    const bool last = adding == 0;
                    const auto job = claim();
                    if (!job && last) return;
                    if (!job) continue;
                    EXPECT_TRUE(
                        store_->finish(job->lease, successful(job->info), {}, std::nullopt, kNow));
                    const std::lock_guard lock(mutex);
                    claimed.push_back(job->info.job_id);
                }
            });
        }
    }
    EXPECT_EQ(added.size(), static_cast<std::size_t>(kThreads * kJobs));
    EXPECT_EQ(claimed.size(), added.size());
    EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()), added);
}

TEST_P(JobStoreTurns, OfManyThreadsWithOneMarkOneMakesAJob) {
    constexpr int kThreads = 8;
    const ShapeInfo shape = add_shape();
    std::atomic<int> made = 0;
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < kThreads; ++t) {
            threads.emplace_back([&] {
                NewJob job{.info = {}, .mark = RequestMark{"key", "print"}};
                job.info.job_id = new_id();
                job.info.shape = shape.id;
                if (problem_of([&] { store_->add_job(job, {}); }).empty()) ++made;
            });
        }
    }
    EXPECT_EQ(made, 1);
    EXPECT_EQ(store_->waiting().size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(All, JobStoreTurns, testing::ValuesIn(job_stores()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace lpf::server
