#include "server/job_store.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "api/problem.h"
#include "core/base/error.h"
#include "server/ids.h"
#include "server/sha256.h"
#include "server/sqlite_job_store.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

constexpr UnixMillis kNow = 1'800'000'000'000;
constexpr UnixMillis kDay = 24LL * 3600 * 1000;

/// One way to make a store. A further implementation only adds itself to the list at the end.
struct Maker {
    const char* name;
    std::function<std::unique_ptr<JobStore>(const std::filesystem::path&)> make;
};

class JobStoreConformance : public testing::TestWithParam<Maker> {
protected:
    TemporaryFolder folder_;
    std::unique_ptr<JobStore> store_ = GetParam().make(folder_.path());

    ShapeInfo add_shape(const std::string& content = "shape") {
        ShapeInfo shape;
        shape.id = new_id();
        shape.format = "ply";
        shape.bytes = content.size();
        shape.sha256 = sha256_of(content);
        shape.points = 10;
        shape.created = kNow;
        shape.expires = kNow + kDay;
        return store_->add_shape(shape);
    }

    StatusInfo add_job(Task task = Task::Denoise) {
        StatusInfo job;
        job.job_id = new_id();
        job.process = task;
        job.created = job.updated = kNow;
        job.shape = add_shape().id;
        store_->add_job(job, 1000);
        return job;
    }

    /// Runs a job to its end, with one result.
    StatusInfo finish_job(const ClaimedJob& claim, const std::string& content = "result") {
        StatusInfo info = claim.info;
        info.status = JobStatus::Successful;
        info.finished = kNow + 1000;
        info.expires = kNow + kDay;
        const ResultFile file{ResultKind::Points, "application/ply", content.size(),
                              sha256_of(content)};
        EXPECT_TRUE(store_->finish(claim.lease, info, {file}, std::nullopt));
        return info;
    }

    [[nodiscard]] JobStatus status(const std::string& id) const {
        return store_->find_job(id)->info.status;
    }
};

TEST_P(JobStoreConformance, FindsAShapeByIdAndByDigest) {
    const ShapeInfo shape = add_shape();
    EXPECT_EQ(store_->find_shape(shape.id)->sha256, shape.sha256);
    EXPECT_EQ(store_->find_shape_by_digest(shape.sha256)->id, shape.id);
    EXPECT_FALSE(store_->find_shape(new_id()));
}

TEST_P(JobStoreConformance, EqualBytesAreOneShape) {
    const ShapeInfo first = add_shape();
    EXPECT_EQ(add_shape().id, first.id);
    EXPECT_NE(add_shape("other").id, first.id);
}

TEST_P(JobStoreConformance, AShapeLivesLongerWhenItIsUsedAgain) {
    const ShapeInfo shape = add_shape();
    EXPECT_EQ(store_->keep_shape_until(shape.id, kNow + 3 * kDay)->expires, kNow + 3 * kDay);
    EXPECT_EQ(store_->keep_shape_until(shape.id, kNow)->expires, kNow + 3 * kDay);
    EXPECT_FALSE(store_->keep_shape_until(new_id(), kNow));
}

TEST_P(JobStoreConformance, AShapeThatAJobNeedsStays) {
    const StatusInfo job = add_job();
    EXPECT_THROW(store_->remove_shape(job.shape), ProblemException);
    EXPECT_TRUE(store_->find_shape(job.shape));
    store_->dismiss(job.job_id, kNow);
    EXPECT_TRUE(store_->remove_shape(job.shape));
    EXPECT_FALSE(store_->remove_shape(job.shape));
}

TEST_P(JobStoreConformance, KeepsAJobAsItWasAdded) {
    StatusInfo job;
    job.job_id = new_id();
    job.process = Task::Resample;
    job.created = job.updated = kNow;
    job.shape = add_shape().id;
    job.parameters.factor = 4.0;
    job.warnings = {{"duplicate-points", "Two."}};
    store_->add_job(job, 1000);
    const StatusInfo found = store_->find_job(job.job_id)->info;
    EXPECT_EQ(found.process, Task::Resample);
    EXPECT_EQ(found.created, kNow);
    EXPECT_EQ(found.parameters.factor, 4.0);
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_EQ(found.warnings[0].code, "duplicate-points");
}

TEST_P(JobStoreConformance, QueuePositionsCountFromOne) {
    const StatusInfo first = add_job();
    const StatusInfo second = add_job();
    EXPECT_EQ(store_->find_job(first.job_id)->info.queue_position, 1U);
    EXPECT_EQ(store_->find_job(second.job_id)->info.queue_position, 2U);
    (void)store_->claim_next(kNow);
    EXPECT_FALSE(store_->find_job(first.job_id)->info.queue_position);
    EXPECT_EQ(store_->find_job(second.job_id)->info.queue_position, 1U);
}

TEST_P(JobStoreConformance, AFullQueueTakesNoJob) {
    const StatusInfo job = add_job();
    StatusInfo another = job;
    another.job_id = new_id();
    try {
        store_->add_job(another, 1);
        FAIL() << "the queue was full";
    } catch (const ProblemException& error) {
        EXPECT_EQ(error.problem().problem, ProblemCode::QueueFull);
        EXPECT_GT(error.problem().retry_after, 0);
    }
    EXPECT_FALSE(store_->find_job(another.job_id));
}

TEST_P(JobStoreConformance, AJobWithoutItsShapeIsRefused) {
    StatusInfo job;
    job.job_id = new_id();
    job.shape = new_id();
    EXPECT_THROW(store_->add_job(job, 10), ProblemException);
}

TEST_P(JobStoreConformance, ClaimsTheOldestAndEachOnce) {
    const StatusInfo first = add_job();
    const StatusInfo second = add_job();
    const auto claim = store_->claim_next(kNow + 5);
    EXPECT_EQ(claim->info.job_id, first.job_id);
    EXPECT_EQ(claim->info.status, JobStatus::Running);
    EXPECT_EQ(claim->info.attempt, 1);
    EXPECT_EQ(claim->info.started, kNow + 5);
    EXPECT_EQ(store_->claim_next(kNow)->info.job_id, second.job_id);
    EXPECT_FALSE(store_->claim_next(kNow));
}

TEST_P(JobStoreConformance, ResultsAppearWithTheSuccess) {
    add_job();
    const auto claim = store_->claim_next(kNow);
    EXPECT_TRUE(store_->find_job(claim->info.job_id)->results.empty());
    finish_job(*claim);
    const auto job = store_->find_job(claim->info.job_id);
    EXPECT_EQ(job->info.status, JobStatus::Successful);
    ASSERT_EQ(job->results.size(), 1U);
    EXPECT_EQ(job->results[0].sha256, sha256_of("result"));
    EXPECT_TRUE(store_->refers_to(sha256_of("result")));
}

TEST_P(JobStoreConformance, AVoidLeaseChangesNothing) {
    add_job();
    const auto claim = store_->claim_next(kNow);
    const std::string id = claim->info.job_id;
    EXPECT_TRUE(store_->save_progress(claim->lease, claim->info));
    store_->dismiss(id, kNow);
    StatusInfo late = claim->info;
    late.status = JobStatus::Successful;
    EXPECT_FALSE(store_->save_progress(claim->lease, claim->info));
    EXPECT_FALSE(store_->finish(claim->lease, late, {}, std::nullopt));
    EXPECT_FALSE(store_->give_back(claim->lease, kNow));
    EXPECT_EQ(status(id), JobStatus::Dismissed);
}

TEST_P(JobStoreConformance, AJobFinishesOnce) {
    add_job();
    const auto claim = store_->claim_next(kNow);
    finish_job(*claim);
    StatusInfo failed = claim->info;
    failed.status = JobStatus::Failed;
    EXPECT_FALSE(store_->finish(claim->lease, failed, {}, std::nullopt));
    EXPECT_EQ(status(claim->info.job_id), JobStatus::Successful);
}

TEST_P(JobStoreConformance, AJobGivenBackWaitsInItsOldPlaceAndCountsNoAttempt) {
    const StatusInfo first = add_job();
    add_job();
    const auto claim = store_->claim_next(kNow);
    EXPECT_TRUE(store_->give_back(claim->lease, kNow));
    EXPECT_EQ(status(first.job_id), JobStatus::Accepted);
    const auto again = store_->claim_next(kNow);
    EXPECT_EQ(again->info.job_id, first.job_id);
    EXPECT_EQ(again->info.attempt, 1);
}

TEST_P(JobStoreConformance, DismissingTakesTheResultsAndWorksOnce) {
    add_job();
    const auto claim = store_->claim_next(kNow);
    const std::string id = finish_job(*claim).job_id;
    EXPECT_EQ(store_->dismiss(id, kNow)->status, JobStatus::Dismissed);
    EXPECT_FALSE(store_->dismiss(id, kNow));
    EXPECT_FALSE(store_->dismiss(new_id(), kNow));
    EXPECT_TRUE(store_->find_job(id)->results.empty());
    EXPECT_FALSE(store_->find_job(id)->results_expired);
    EXPECT_FALSE(store_->refers_to(sha256_of("result")));
}

TEST_P(JobStoreConformance, JobsSurviveAndRunningOnesWaitAgain) {
    const StatusInfo job = add_job();
    (void)store_->claim_next(kNow);
    store_.reset();
    store_ = GetParam().make(folder_.path());
    EXPECT_EQ(store_->recover(3, kNow), 1U);
    EXPECT_EQ(status(job.job_id), JobStatus::Accepted);
    EXPECT_EQ(store_->claim_next(kNow)->info.attempt, 2);
}

TEST_P(JobStoreConformance, AJobThatLosesItsWorkerThreeTimesFails) {
    const StatusInfo job = add_job();
    for (int attempt = 1; attempt <= 3; ++attempt) {
        EXPECT_EQ(store_->claim_next(kNow)->info.attempt, attempt);
        EXPECT_EQ(store_->recover(3, kNow), 1U);
    }
    const StatusInfo info = store_->find_job(job.job_id)->info;
    EXPECT_EQ(info.status, JobStatus::Failed);
    EXPECT_EQ(info.exception->problem, ProblemCode::WorkerLost);
    EXPECT_FALSE(store_->claim_next(kNow));
}

TEST_P(JobStoreConformance, ListsNewestFirstPageByPage) {
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.insert(ids.begin(), add_job().job_id);
    std::vector<std::string> seen;
    JobFilter filter{.status = {}, .process = {}, .limit = 2, .cursor = {}};
    do {
        const JobPage page = store_->list_jobs(filter);
        for (const auto& job : page.jobs) seen.push_back(job.job_id);
        filter.cursor = page.next_cursor;
    } while (!filter.cursor.empty());
    EXPECT_EQ(seen, ids);
    filter.cursor = "nonsense";
    EXPECT_THROW((void)store_->list_jobs(filter), ProblemException);
}

TEST_P(JobStoreConformance, ListsByStatusAndProcess) {
    const StatusInfo dismissed = add_job();
    const StatusInfo resampling = add_job(Task::Resample);
    store_->dismiss(dismissed.job_id, kNow);
    const auto ids = [&](const JobFilter& filter) {
        std::vector<std::string> found;
        for (const auto& job : store_->list_jobs(filter).jobs) found.push_back(job.job_id);
        return found;
    };
    const std::vector<std::string> only_resampling{resampling.job_id};
    EXPECT_EQ(ids({}), only_resampling);
    EXPECT_EQ(ids({.status = JobStatus::Dismissed, .process = {}, .cursor = {}}),
              std::vector<std::string>{dismissed.job_id});
    EXPECT_EQ(ids({.status = {}, .process = Task::Resample, .cursor = {}}), only_resampling);
    EXPECT_TRUE(ids({.status = {}, .process = Task::Analyze, .cursor = {}}).empty());
}

TEST_P(JobStoreConformance, CountsJobsByStatus) {
    add_job();
    add_job();
    (void)store_->claim_next(kNow);
    QueueFigures figures = store_->figures();
    EXPECT_EQ(figures.jobs[JobStatus::Accepted], 1U);
    EXPECT_EQ(figures.jobs[JobStatus::Running], 1U);
    EXPECT_EQ(figures.oldest_accepted, kNow);
}

TEST_P(JobStoreConformance, DictionariesComeWithTheirJobAndOutliveItsDismissal) {
    add_job();
    const auto claim = store_->claim_next(kNow);
    StatusInfo info = claim->info;
    info.status = JobStatus::Successful;
    const StoredDictionary dictionary{new_id(), info.job_id, sha256_of("d"),
                                      kNow,     kNow + kDay, R"({"atoms":4})"};
    EXPECT_TRUE(store_->finish(claim->lease, info, {}, dictionary));
    store_->dismiss(info.job_id, kNow);
    EXPECT_EQ(store_->find_dictionary(dictionary.id)->summary, dictionary.summary);
    EXPECT_EQ(store_->list_dictionaries(10, "").dictionaries.size(), 1U);
    EXPECT_TRUE(store_->refers_to(sha256_of("d")));
}

TEST_P(JobStoreConformance, ExpiryTakesResultsFirstAndJobsLater) {
    add_job();
    const std::string id = finish_job(*store_->claim_next(kNow)).job_id;
    EXPECT_EQ(store_->remove_expired(kNow, 30 * kDay), 0U);
    EXPECT_GT(store_->remove_expired(kNow + 2 * kDay, 30 * kDay), 0U);
    EXPECT_TRUE(store_->find_job(id)->results_expired);
    EXPECT_TRUE(store_->all_digests().empty());
    EXPECT_GT(store_->remove_expired(kNow + 40 * kDay, 30 * kDay), 0U);
    EXPECT_FALSE(store_->find_job(id));
}

TEST_P(JobStoreConformance, ExpirySparesWhatUnfinishedJobsNeed) {
    const StatusInfo job = add_job();
    store_->remove_expired(kNow + 400 * kDay, 30 * kDay);
    EXPECT_TRUE(store_->find_job(job.job_id));
    EXPECT_TRUE(store_->find_shape(job.shape));
}

INSTANTIATE_TEST_SUITE_P(All, JobStoreConformance,
                         testing::Values(Maker{"Sqlite",
                                               [](const auto& path) {
                                                   return std::make_unique<SqliteJobStore>(
                                                       path / "jobs.sqlite");
                                               }}),
                         [](const auto& tested) { return tested.param.name; });

TEST(SqliteJobStore, RefusesAFileOfANewerProgram) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    SqliteDatabase(file, SqliteDatabase::Mode::ReadWrite).script("PRAGMA user_version = 99");
    EXPECT_THROW(SqliteJobStore{file}, Error);
}

TEST(SqliteJobStore, RefusesAFileThatIsNoDatabase) {
    const TemporaryFolder folder;
    EXPECT_THROW(SqliteJobStore{folder.path()}, Error);
}

}  // namespace
}  // namespace lpf::server
