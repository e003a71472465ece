#include "server/job_queue.h"

#include <atomic>

#include "api/problem.h"
#include "tests/server/job_queue_suite.h"

namespace lpf::server {
namespace {

using std::chrono::seconds;

TEST_F(JobQueueTest, RunsAJobToItsEnd) {
    const auto queue = make_queue(work_nothing);
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    const StatusInfo info = queue->find(id)->info;
    EXPECT_EQ(info.status, JobStatus::Successful);
    EXPECT_EQ(info.progress, 100);
    EXPECT_TRUE(info.finished);
    EXPECT_GT(info.expires.value_or(0), now_millis());
}

TEST_F(JobQueueTest, ErrorsOfTheMethodBecomeProblemsOfTheJob) {
    const auto queue = make_queue([](RunningJob&) -> JobOutcome {
        throw Error(ErrorCode::TooFewPoints, "Only two points.");
    });
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    const StatusInfo info = queue->find(id)->info;
    EXPECT_EQ(info.status, JobStatus::Failed);
    EXPECT_EQ(info.exception->problem, ProblemCode::TooFewPoints);
    EXPECT_EQ(info.exception->instance, "/v1/jobs/" + id);
}

TEST_F(JobQueueTest, RunningOutOfMemoryFailsOnlyTheJob) {
    const auto queue = make_queue([](RunningJob&) -> JobOutcome { throw std::bad_alloc(); });
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.exception->problem, ProblemCode::OutOfMemory);
}

TEST_F(JobQueueTest, DefectsAreNotShownToTheClient) {
    const auto queue =
        make_queue([](RunningJob&) -> JobOutcome { throw std::runtime_error("secret detail"); });
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    const StatusInfo info = queue->find(id)->info;
    EXPECT_EQ(info.exception->problem, ProblemCode::Internal);
    EXPECT_EQ(info.message.find("secret"), std::string::npos);
}

TEST_F(JobQueueTest, RunsOldestFirstAndOneAtATime) {
    std::mutex mutex;
    std::vector<std::string> order;
    std::atomic<int> now = 0;
    std::atomic<int> most = 0;
    const auto queue = make_queue([&](RunningJob& job) -> JobOutcome {
        most = std::max<int>(most, ++now);
        {
            const std::lock_guard lock(mutex);
            order.push_back(job.lease().job_id);
        }
        --now;
        return {};
    });
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(submit(*queue));
    queue->start();
    for (const auto& id : ids) ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(order, ids);
    EXPECT_EQ(most, 1);
}

TEST_F(JobQueueTest, ADismissedJobStopsWithinASecond) {
    const auto queue = make_queue(work_forever);
    queue->start();
    const std::string id = submit(*queue);
    wait_until_running(*queue, id);
    const auto start = Clock::now();
    EXPECT_EQ(queue->dismiss(id)->status, JobStatus::Dismissed);
    while (queue->gauges().running > 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    EXPECT_LT(seconds_since(start), 1.0);
    EXPECT_EQ(status(id), JobStatus::Dismissed);
}

TEST_F(JobQueueTest, ADismissedWaitingJobNeverRuns) {
    std::atomic<int> runs = 0;
    const auto queue = make_queue([&](RunningJob&) -> JobOutcome {
        ++runs;
        return {};
    });
    const std::string dismissed = submit(*queue);
    const std::string other = submit(*queue);
    queue->dismiss(dismissed);
    queue->start();
    ASSERT_TRUE(queue->wait_for(other, seconds(10), {}));
    EXPECT_EQ(runs, 1);
}

TEST_F(JobQueueTest, AJobThatRunsTooLongFailsWithTimedOut) {
    const auto queue = make_queue(work_forever);
    queue->start();
    StatusInfo job = new_job();
    job.parameters.max_seconds = 0.3;
    const std::string id = submit(*queue, job);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.exception->problem, ProblemCode::TimedOut);
}

TEST_F(JobQueueTest, AStopGivesRunningJobsBackUncounted) {
    auto queue = make_queue(work_forever);
    queue->start();
    const std::string id = submit(*queue);
    wait_until_running(*queue, id);
    queue->stop();
    EXPECT_EQ(status(id), JobStatus::Accepted);
    EXPECT_EQ(books_.find_job(id)->info.attempt, 0);
    queue = make_queue(work_nothing);
    queue->start();
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.attempt, 1);
}

TEST_F(JobQueueTest, JobsOfAKilledServerRunAgain) {
    const auto queue = make_queue(work_nothing);
    const std::string id = submit(*queue);
    (void)books_.claim_next({.now = now_millis(),
                             .lease_until = now_millis() + 60'000,
                             .rules = {}});  // the server that is killed now had it
    queue->start();
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.attempt, 2);
}

TEST_F(JobQueueTest, AStoppingQueueTakesNoJobs) {
    const auto queue = make_queue(work_nothing);
    queue->refuse_new();
    EXPECT_THROW(submit(*queue), ProblemException);
    EXPECT_FALSE(queue->gauges().ready);
}

TEST_F(JobQueueTest, ProgressIsFreshInMemoryAndOnDiskWithinSeconds) {
    const auto queue = make_queue([](RunningJob& job) -> JobOutcome {
        job.progress_sink(0, 80)({"learn", 5, 10, "fields", 0.5});
        return work_forever(job);
    });
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(becomes([&] { return queue->find(id)->info.progress == 40; }));
    const StatusInfo info = queue->find(id)->info;
    EXPECT_EQ(info.progress, 40);
    EXPECT_EQ(info.phase, "learn");
    EXPECT_EQ(info.phase_progress, (PhaseProgress{5, 10, "fields"}));
    EXPECT_TRUE(info.eta_seconds);
    EXPECT_TRUE(becomes([&] { return books_.find_job(id)->info.progress == 40; }));
}

TEST_F(JobQueueTest, ProgressNeverFalls) {
    RunningJob job({}, 10);
    job.progress_sink(0, 100)({"a", 1, 2, "x", 0.6});
    job.progress_sink(0, 100)({"a", 1, 2, "x", 0.2});
    EXPECT_DOUBLE_EQ(job.info().progress, 60);
}

TEST_F(JobQueueTest, AWarningIsGivenOnce) {
    RunningJob job({}, 10);
    job.warn("a", "First.");
    job.warn("a", "First.");
    job.warn("a", "Second.");
    EXPECT_EQ(job.info().warnings.size(), 2U);
}

TEST_F(JobQueueTest, AWaitEndsAtItsTimeAndWhenTheClientLeaves) {
    const auto queue = make_queue(work_forever);
    queue->start();
    const std::string id = submit(*queue);
    EXPECT_FALSE(queue->wait_for(id, seconds(0), {}));
    const auto start = Clock::now();
    EXPECT_FALSE(queue->wait_for(id, seconds(30), [] { return true; }));
    EXPECT_LT(seconds_since(start), 2.0);
}

TEST_F(JobQueueTest, WaitersBeyondTheirNumberAreSentAwayAtOnce) {
    QueueOptions options;
    options.max_waiters = 1;
    const auto queue = make_queue(work_forever, options);
    queue->start();
    const std::string id = submit(*queue);
    std::atomic<bool> leave = false;
    std::jthread first([&] { queue->wait_for(id, seconds(30), [&] { return leave.load(); }); });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const auto start = Clock::now();
    EXPECT_FALSE(queue->wait_for(id, seconds(30), {}));
    EXPECT_LT(seconds_since(start), 1.0);
    leave = true;
}

TEST_F(JobQueueTest, FilesOfASweepAreThoseThatNobodyNames) {
    const std::string shape = blobs_.put("shape");
    const std::string other = blobs_.put("other");
    (void)new_job();  // names the blob "shape"
    storage_.forget({shape, other});
    EXPECT_TRUE(blobs_.size(shape));
    EXPECT_FALSE(blobs_.size(other));
    EXPECT_GT(storage_.sweep(now_millis() + 2'000'000, 1), 0U);
    EXPECT_FALSE(blobs_.size(shape));
}

}  // namespace
}  // namespace lpf::server
