// Leases: who may write to a job, for how long, and what becomes of jobs whose worker is gone.
#include "server/job_store.h"
#include "tests/server/store/job_store_suite.h"

namespace lpf::server {
namespace {

class JobStoreLeases : public JobStoreSuite {
protected:
    /// A write of every kind that a worker does; true for each that was taken.
    std::vector<bool> write_all(const ClaimedJob& job, UnixMillis now) {
        return {store_->extend(job.lease, now, now + kLease),
                store_->save_progress(job.lease, job.info, now),
                store_->finish(job.lease, successful(job.info), {result_file("late")}, std::nullopt,
                               now),
                store_->give_back(job.lease, now)};
    }
    const std::vector<bool> kAllRefused = std::vector<bool>(4, false);
};

TEST_P(JobStoreLeases, AClaimStartsTheJob) {
    const std::string id = add_job();
    const auto job = claim(kNow + 5);
    EXPECT_EQ(job->info.job_id, id);
    EXPECT_EQ(job->points, 10U);
    EXPECT_EQ(job->lease_until, kNow + 5 + kLease);
    const StatusInfo info = store_->find_job(id)->info;
    EXPECT_EQ(info.status, JobStatus::Running);
    EXPECT_EQ(info.attempt, 1);
    EXPECT_EQ(info.started, kNow + 5);
    EXPECT_FALSE(claim());
}

TEST_P(JobStoreLeases, ResultsAppearWithTheSuccess) {
    const std::string id = add_job();
    const auto job = claim();
    EXPECT_TRUE(store_->find_job(id)->results.empty());
    finish_job(*job);
    const auto found = store_->find_job(id);
    EXPECT_EQ(found->info.status, JobStatus::Successful);
    ASSERT_EQ(found->results.size(), 1U);
    EXPECT_EQ(found->results[0].sha256, sha256_of("result"));
    EXPECT_TRUE(store_->refers_to(sha256_of("result")));
}

TEST_P(JobStoreLeases, AJobFinishesOnce) {
    const std::string id = add_job();
    const auto job = claim();
    finish_job(*job);
    StatusInfo failed = job->info;
    failed.status = JobStatus::Failed;
    EXPECT_FALSE(store_->finish(job->lease, failed, {}, std::nullopt, kNow));
    EXPECT_EQ(status(id), JobStatus::Successful);
}

TEST_P(JobStoreLeases, AWriteAfterTheEndOfTheLeaseIsRefused) {
    const std::string id = add_job();
    const auto job = claim();
    EXPECT_EQ(write_all(*job, kNow + kLease), kAllRefused);
    EXPECT_EQ(status(id), JobStatus::Running);
    EXPECT_FALSE(store_->refers_to(sha256_of("late")));
}

TEST_P(JobStoreLeases, ARenewedLeaseHolds) {
    add_job();
    const auto job = claim();
    ASSERT_TRUE(store_->extend(job->lease, kNow + kLease - 1, kNow + 2 * kLease));
    EXPECT_TRUE(store_->save_progress(job->lease, job->info, kNow + kLease + 1));
    EXPECT_TRUE(store_->take_back_expired(3, kNow + kLease + 1).empty());
    EXPECT_FALSE(store_->save_progress(job->lease, job->info, kNow + 2 * kLease));
}

TEST_P(JobStoreLeases, AWriteWithAForeignTokenIsRefused) {
    add_job();
    ClaimedJob job = *claim();
    job.lease.token = new_id();
    EXPECT_EQ(write_all(job, kNow + 1), kAllRefused);
    job.lease.token = "";
    EXPECT_EQ(write_all(job, kNow + 1), kAllRefused);
}

TEST_P(JobStoreLeases, ADismissalVoidsTheLease) {
    const std::string id = add_job();
    const auto job = claim();
    store_->dismiss(id, kNow);
    EXPECT_EQ(write_all(*job, kNow + 1), kAllRefused);
    EXPECT_EQ(status(id), JobStatus::Dismissed);
}

TEST_P(JobStoreLeases, AJobWhoseLeaseRanOutWaitsAgainAndItsWorkerIsShutOut) {
    const std::string id = add_job();
    const auto stalled = claim();
    const auto taken = store_->take_back_expired(3, kNow + kLease);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].job_id, id);
    EXPECT_EQ(taken[0].status, JobStatus::Accepted);
    EXPECT_EQ(taken[0].attempt, 1);
    const auto second = claim(kNow + kLease);
    EXPECT_EQ(second->info.attempt, 2);
    EXPECT_NE(second->lease.token, stalled->lease.token);
    EXPECT_EQ(write_all(*stalled, kNow + kLease + 1), kAllRefused);
    EXPECT_TRUE(store_->finish(second->lease, successful(second->info), {result_file("good")},
                               std::nullopt, kNow + kLease + 2));
    EXPECT_EQ(store_->find_job(id)->results.size(), 1U);
}

TEST_P(JobStoreLeases, AJobGivenBackWaitsInItsOldPlaceAndCountsNoAttempt) {
    const std::string first = add_job();
    add_job();
    const auto job = claim();
    EXPECT_TRUE(store_->give_back(job->lease, kNow));
    EXPECT_EQ(status(first), JobStatus::Accepted);
    EXPECT_EQ(store_->find_job(first)->info.attempt, 0);
    const auto again = claim();
    EXPECT_EQ(again->info.job_id, first);
    EXPECT_EQ(again->info.attempt, 1);
}

TEST_P(JobStoreLeases, AfterACrashRunningJobsAreTakenBackWhateverTheirLease) {
    const std::string running = add_job();
    (void)claim();
    const std::string waiting = add_job();
    reopen();
    const auto taken = store_->take_back_all(3, kNow + 1);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].job_id, running);
    EXPECT_EQ(status(running), JobStatus::Accepted);
    EXPECT_EQ(status(waiting), JobStatus::Accepted);
    EXPECT_EQ(claim()->info.attempt, 2);
}

TEST_P(JobStoreLeases, AJobThatLosesItsWorkerThreeTimesFails) {
    const std::string id = add_job();
    for (int attempt = 1; attempt <= 3; ++attempt) {
        EXPECT_EQ(claim()->info.attempt, attempt);
        EXPECT_EQ(store_->take_back_expired(3, kNow + kLease).size(), 1U);
    }
    const StatusInfo info = store_->find_job(id)->info;
    EXPECT_EQ(info.status, JobStatus::Failed);
    EXPECT_EQ(info.exception->problem, ProblemCode::WorkerLost);
    EXPECT_TRUE(info.finished);
    EXPECT_FALSE(claim());
}

TEST_P(JobStoreLeases, PastJobsTellTheirTime) {
    add_job("", 5000);
    finish_job(*claim(kNow - 2000));
    ASSERT_EQ(store_->past_jobs(10).size(), 1U);
    EXPECT_EQ(store_->past_jobs(10)[0].points, 5000U);
    EXPECT_DOUBLE_EQ(store_->past_jobs(10)[0].seconds, 3.0);
    EXPECT_TRUE(store_->past_jobs(0).empty());
}

INSTANTIATE_TEST_SUITE_P(All, JobStoreLeases, testing::ValuesIn(job_stores()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace lpf::server
