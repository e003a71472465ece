// Jobs that share the memory budget.
#include <atomic>

#include "tests/server/job_queue_suite.h"

namespace lpf::server {
namespace {

class JobQueueMemory : public JobQueueTest {
protected:
    std::string submit_with(JobQueue& queue, std::uint64_t memory) {
        const StatusInfo job = new_job();
        queue.submit({.info = job, .points = 10, .memory = memory});
        return job.job_id;
    }
};

TEST_F(JobQueueMemory, JobsThatTogetherPassTheBudgetRunOneAfterTheOther) {
    std::atomic<int> running = 0;
    std::atomic<int> most = 0;
    const auto queue = make_queue(
        [&](RunningJob&) -> JobOutcome {
            most = std::max<int>(most, ++running);
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            --running;
            return {};
        },
        {.workers = 4, .memory = 100});
    std::vector<std::string> jobs;
    for (int i = 0; i < 4; ++i) jobs.push_back(submit_with(*queue, 60));
    queue->start();
    for (const std::string& id : jobs)
        EXPECT_TRUE(becomes([&] { return status(id) == JobStatus::Successful; }));
    EXPECT_EQ(most, 1);
}

TEST_F(JobQueueMemory, JobsThatFitRunTogether) {
    const auto queue = make_queue(work_forever, {.workers = 2, .memory = 100});
    queue->start();
    const std::string first = submit_with(*queue, 50);
    const std::string second = submit_with(*queue, 50);
    wait_until_running(*queue, first);
    wait_until_running(*queue, second);
}

TEST_F(JobQueueMemory, AnEndLetsTheNextStartAtOnce) {
    const auto queue = make_queue(work_forever, {.workers = 2, .memory = 100});
    queue->start();
    const std::string first = submit_with(*queue, 70);
    wait_until_running(*queue, first);
    const std::string second = submit_with(*queue, 70);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(status(second), JobStatus::Accepted);
    queue->dismiss(first);
    wait_until_running(*queue, second);
}

TEST_F(JobQueueMemory, AJobOfALargerBudgetIsRefusedInsteadOfWaitingForEver) {
    const auto queue = make_queue(work_nothing, {.workers = 2, .memory = 100});
    const std::string id = submit_with(*queue, 101);
    queue->start();
    ASSERT_TRUE(becomes([&] { return status(id) == JobStatus::Failed; }));
    const auto job = queue->find(id);
    EXPECT_EQ(job->info.exception->code(), "out-of-memory");
    EXPECT_NE(job->info.exception->detail.find("memoryBytes"), std::string::npos);
}

}  // namespace
}  // namespace lpf::server
