// Lost leases, turns, forecasts and events of the queue.
#include <atomic>
#include <set>

#include "server/job_queue.h"
#include "tests/server/job_queue_suite.h"

namespace lpf::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr UnixMillis kFarFuture = 4'000'000'000'000;

QueueOptions short_leases() {
    QueueOptions options;
    options.leases = {milliseconds(300), milliseconds(100), 3};
    return options;
}

TEST_F(JobQueueTest, AJobThatOutlastsItsLeaseKeepsItByHeartbeats) {
    const auto queue = make_queue(
        [](RunningJob&) -> JobOutcome {
            std::this_thread::sleep_for(milliseconds(900));
            return {};
        },
        short_leases());
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.status, JobStatus::Successful);
    EXPECT_EQ(queue->find(id)->info.attempt, 1);
}

TEST_F(JobQueueTest, AWorkerWhoseLeaseRanOutIsStoppedAndTheJobRunsAgain) {
    std::atomic<int> runs = 0;
    const auto queue = make_queue(
        [&](RunningJob& job) -> JobOutcome {
            if (++runs > 1) return {};
            // As if the process had been stopped for longer than the lease.
            (void)books_.take_back_expired(3, kFarFuture);
            return work_forever(job);
        },
        short_leases());
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.status, JobStatus::Successful);
    EXPECT_EQ(queue->find(id)->info.attempt, 2);
    EXPECT_EQ(runs, 2);
    EXPECT_NE(telemetry_.text({}).find("lpf_lease_losses_total 1"), std::string::npos);
}

TEST_F(JobQueueTest, TheLateResultOfALostLeaseIsDropped) {
    std::atomic<int> runs = 0;
    const auto queue = make_queue([&](RunningJob&) -> JobOutcome {
        JobOutcome outcome;
        const std::string content = "result of run " + std::to_string(++runs);
        outcome.results.push_back(
            {ResultKind::Points, "application/ply", content.size(), sha256_of(content)});
        if (runs == 1) (void)books_.take_back_expired(3, kFarFuture);
        return outcome;
    });
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    ASSERT_EQ(queue->find(id)->results.size(), 1U);
    EXPECT_EQ(queue->find(id)->results[0].sha256, sha256_of("result of run 2"));
}

TEST_F(JobQueueTest, AJobThatAnotherServerDismissesStopsHereWithoutALoss) {
    const auto queue = make_queue(
        [&](RunningJob& job) -> JobOutcome {
            (void)books_.dismiss(job.lease().job_id, now_millis());
            return work_forever(job);
        },
        short_leases());
    queue->start();
    submit(*queue);
    EXPECT_TRUE(becomes([&] {
        return telemetry_.text({}).find("lpf_cancel_seconds_count 1") != std::string::npos;
    })) << telemetry_.text({});
    EXPECT_NE(telemetry_.text({}).find("lpf_lease_losses_total 0"), std::string::npos);
}

TEST_F(JobQueueTest, TheLeaseOfAJobThatHasJustEndedIsNotLost) {
    books_.add_job({.info = new_job()}, {});
    auto claim = books_.claim_next({.now = now_millis(), .lease_until = kFarFuture, .rules = {}});
    StatusInfo done = claim->info;
    done.status = JobStatus::Successful;
    done.finished = now_millis();
    RunningJobs running;
    const auto job = std::make_shared<RunningJob>(std::move(*claim), 60.0);
    running.add(job);
    LeaseKeeper keeper(books_, running, log_, telemetry_, short_leases().leases,
                       [](const std::vector<StatusInfo>&) {});
    job->begin_end();
    ASSERT_TRUE(books_.finish(job->lease(), done, {}, std::nullopt, now_millis()));
    keeper.start();
    std::this_thread::sleep_for(milliseconds(400));  // four renewals
    keeper.stop();
    EXPECT_FALSE(job->stop_reason());
    EXPECT_NE(telemetry_.text({}).find("lpf_lease_losses_total 0"), std::string::npos);
}

TEST_F(JobQueueTest, JobsOfAnotherProcessThatDiedAreTakenBack) {
    const auto queue = make_queue(work_nothing, short_leases());
    queue->start();
    // Claimed before the queue's own workers can: another server had it, and died.
    StatusInfo job = new_job();
    books_.add_job({.info = job}, {});
    const auto claim =
        books_.claim_next({.now = now_millis(), .lease_until = now_millis() + 400, .rules = {}});
    ASSERT_TRUE(queue->wait_for(job.job_id, seconds(10), {}));
    EXPECT_EQ(queue->find(job.job_id)->info.attempt, claim ? 2 : 1);
}

TEST_F(JobQueueTest, PositionsAndStartsAreForecast) {
    books_.add_job({.info = new_job(), .points = 8000}, {});
    const auto past =
        books_.claim_next({.now = now_millis() - 10'000, .lease_until = kFarFuture, .rules = {}});
    StatusInfo done = past->info;  // 10 000 units of work took 10 s
    done.status = JobStatus::Successful;
    done.finished = now_millis();
    ASSERT_TRUE(books_.finish(past->lease, done, {}, std::nullopt, now_millis()));

    const auto queue = make_queue(work_forever);
    queue->start();
    const std::string running = submit(*queue, new_job(), 3000);
    wait_until_running(*queue, running);
    const std::string first = submit(*queue, new_job(), 1000);
    const std::string second = submit(*queue, new_job(), 1000);
    EXPECT_EQ(queue->find(first)->info.queue_position, 1U);
    const StatusInfo info = queue->find(second)->info;
    EXPECT_EQ(info.queue_position, 2U);
    ASSERT_TRUE(info.estimated_start);
    EXPECT_NEAR(static_cast<double>(*info.estimated_start - now_millis()), 8000, 1500);
    EXPECT_FALSE(queue->find(running)->info.queue_position);
    queue->dismiss(first);
    EXPECT_EQ(queue->find(second)->info.queue_position, 1U);
    EXPECT_EQ(queue->list({}).jobs.at(0).queue_position, 1U);
}

TEST_F(JobQueueTest, OneOfSeveralWorkersIsKeptForSmallJobs) {
    QueueOptions options;
    options.workers = 2;
    options.small_points = 100;
    const auto queue = make_queue(
        [](RunningJob& job) { return job.points() > 100 ? work_forever(job) : JobOutcome{}; },
        options);
    queue->start();
    const std::string large = submit(*queue, new_job(), 1000);
    const std::string another = submit(*queue, new_job(), 1000);
    wait_until_running(*queue, large);
    const std::string small = submit(*queue, new_job(), 10);
    EXPECT_TRUE(queue->wait_for(small, seconds(10), {}));
    EXPECT_EQ(status(another), JobStatus::Accepted);
    queue->dismiss(large);
    wait_until_running(*queue, another);
}

TEST_F(JobQueueTest, AnEndThatCannotBeStoredAtOnceIsStoredLater) {
    const auto queue = make_queue([&](RunningJob&) -> JobOutcome {
        SqliteDatabase(folder_.path() / "jobs.sqlite", SqliteDatabase::Mode::ReadWrite)
            .script(
                "CREATE TRIGGER full BEFORE INSERT ON results BEGIN "
                "SELECT RAISE(ABORT, 'no room'); END");
        JobOutcome outcome;
        outcome.results.push_back({ResultKind::Report, "application/json", 1, sha256_of("x")});
        return outcome;
    });
    queue->start();
    const std::string id = submit(*queue);
    EXPECT_FALSE(queue->wait_for(id, seconds(1), {}));
    SqliteDatabase(folder_.path() / "jobs.sqlite", SqliteDatabase::Mode::ReadWrite)
        .script("DROP TRIGGER full");
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    EXPECT_EQ(queue->find(id)->info.status, JobStatus::Successful);
    EXPECT_EQ(queue->find(id)->info.attempt, 1);
}

TEST_F(JobQueueTest, TheStoryOfAJobIsTold) {
    const auto queue = make_queue([](RunningJob& job) -> JobOutcome {
        job.enter_phase("decode", 1);
        job.warn("odd", "Something is odd.");
        std::this_thread::sleep_for(milliseconds(1500));
        return {};
    });
    queue->start();
    const std::string id = submit(*queue);
    ASSERT_TRUE(queue->wait_for(id, seconds(10), {}));
    std::vector<std::string> names;
    std::string all;
    ASSERT_TRUE(becomes([&] {
        names.clear();
        for (const JobEvent& event : events_.after(id, 0)) {
            names.push_back(event.name);
            all += event.data;
        }
        return !names.empty() && names.back() == "end";
    }));
    EXPECT_EQ(std::ranges::count(names, "status"), 3);  // accepted, running, successful
    EXPECT_EQ(std::ranges::count(names, "progress"), 1);
    EXPECT_GE(std::ranges::count(names, "log"), 2);
    EXPECT_NE(all.find("Something is odd."), std::string::npos);
    EXPECT_NE(all.find("decode"), std::string::npos);
}

TEST_F(JobQueueTest, FilesThatAreBeingAddedAreNotSweptAway) {
    FileHold held(storage_);
    const auto writer = blobs_.create();
    writer->write("fresh");
    const std::string digest = held.commit(*writer);
    storage_.forget({digest});
    EXPECT_TRUE(blobs_.size(digest));
    held = FileHold();
    storage_.forget({digest});
    EXPECT_FALSE(blobs_.size(digest));
}

}  // namespace
}  // namespace lpf::server
