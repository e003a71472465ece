#include "server/job_store.h"

#include "tests/server/store/job_store_suite.h"

namespace lpf::server {
namespace {

class JobStoreConformance : public JobStoreSuite {};

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
    const std::string job = add_job();
    const std::string shape = add_shape().id;  // the same bytes, and so the same shape
    EXPECT_EQ(problem_of([&] { store_->remove_shape(shape); }), "shape-in-use");
    EXPECT_TRUE(store_->find_shape(shape));
    store_->dismiss(job, kNow);
    EXPECT_TRUE(store_->remove_shape(shape));
    EXPECT_FALSE(store_->remove_shape(shape));
}

TEST_P(JobStoreConformance, KeepsAJobAsItWasAdded) {
    NewJob job = new_job();
    job.info.process = Task::Resample;
    job.info.parameters.factor = 4.0;
    job.info.warnings = {{"duplicate-points", "Two."}};
    store_->add_job(job, {});
    const StatusInfo found = store_->find_job(job.info.job_id)->info;
    EXPECT_EQ(found.status, JobStatus::Accepted);
    EXPECT_EQ(found.process, Task::Resample);
    EXPECT_EQ(found.created, kNow);
    EXPECT_EQ(found.parameters.factor, 4.0);
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_EQ(found.warnings[0].code, "duplicate-points");
}

TEST_P(JobStoreConformance, ARetryAndItsJobKnowOfEachOther) {
    const std::string first = add_job();
    NewJob again = new_job();
    again.info.retry_of = first;
    store_->add_job(again, {});
    EXPECT_EQ(store_->find_job(first)->info.retries, std::vector{again.info.job_id});
    EXPECT_EQ(store_->find_job(again.info.job_id)->info.retry_of, first);
    EXPECT_TRUE(store_->find_job(again.info.job_id)->info.retries.empty());
}

TEST_P(JobStoreConformance, AJobWithoutItsShapeIsRefused) {
    NewJob job = new_job();
    job.info.shape = new_id();
    EXPECT_EQ(problem_of([&] { store_->add_job(job, {}); }), "shape-not-found");
    EXPECT_FALSE(store_->find_job(job.info.job_id));
}

TEST_P(JobStoreConformance, DismissingTakesTheResultsAndWorksOnce) {
    const std::string id = add_job();
    finish_job(*claim());
    EXPECT_EQ(store_->dismiss(id, kNow)->status, JobStatus::Dismissed);
    EXPECT_FALSE(store_->dismiss(id, kNow));
    EXPECT_FALSE(store_->dismiss(new_id(), kNow));
    EXPECT_TRUE(store_->find_job(id)->results.empty());
    EXPECT_FALSE(store_->find_job(id)->results_expired);
    EXPECT_FALSE(store_->refers_to(sha256_of("result")));
}

TEST_P(JobStoreConformance, ListsNewestFirstPageByPage) {
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.insert(ids.begin(), add_job());
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
    const std::string dismissed = add_job();
    NewJob resampling = new_job();
    resampling.info.process = Task::Resample;
    store_->add_job(resampling, {});
    store_->dismiss(dismissed, kNow);
    const auto ids = [&](const JobFilter& filter) {
        std::vector<std::string> found;
        for (const auto& job : store_->list_jobs(filter).jobs) found.push_back(job.job_id);
        return found;
    };
    const std::vector<std::string> only_resampling{resampling.info.job_id};
    EXPECT_EQ(ids({}), only_resampling);
    EXPECT_EQ(ids({.status = JobStatus::Dismissed, .process = {}, .cursor = {}}),
              std::vector<std::string>{dismissed});
    EXPECT_EQ(ids({.status = {}, .process = Task::Resample, .cursor = {}}), only_resampling);
    EXPECT_TRUE(ids({.status = {}, .process = Task::Analyze, .cursor = {}}).empty());
}

TEST_P(JobStoreConformance, CountsJobsByStatus) {
    add_job();
    add_job();
    (void)claim();
    QueueFigures figures = store_->figures();
    EXPECT_EQ(figures.jobs[JobStatus::Accepted], 1U);
    EXPECT_EQ(figures.jobs[JobStatus::Running], 1U);
    EXPECT_EQ(figures.oldest_accepted, kNow);
}

TEST_P(JobStoreConformance, DictionariesComeWithTheirJobAndOutliveItsDismissal) {
    add_job();
    const auto job = claim();
    const StatusInfo info = successful(job->info);
    const StoredDictionary dictionary{new_id(), info.job_id, sha256_of("d"),
                                      kNow,     kNow + kDay, R"({"atoms":4})"};
    EXPECT_TRUE(store_->finish(job->lease, info, {}, dictionary, kNow));
    store_->dismiss(info.job_id, kNow);
    EXPECT_EQ(store_->find_dictionary(dictionary.id)->summary, dictionary.summary);
    EXPECT_EQ(store_->list_dictionaries(10, "").dictionaries.size(), 1U);
    EXPECT_TRUE(store_->refers_to(sha256_of("d")));
}

TEST_P(JobStoreConformance, ExpiryTakesResultsFirstAndJobsLater) {
    const std::string id = add_job();
    finish_job(*claim());
    EXPECT_EQ(store_->remove_expired(kNow, 30 * kDay), 0U);
    EXPECT_GT(store_->remove_expired(kNow + 2 * kDay, 30 * kDay), 0U);
    EXPECT_TRUE(store_->find_job(id)->results_expired);
    EXPECT_TRUE(store_->all_digests().empty());
    EXPECT_GT(store_->remove_expired(kNow + 40 * kDay, 30 * kDay), 0U);
    EXPECT_FALSE(store_->find_job(id));
}

TEST_P(JobStoreConformance, ExpirySparesWhatUnfinishedJobsNeed) {
    const std::string job = add_job();
    store_->remove_expired(kNow + 400 * kDay, 30 * kDay);
    EXPECT_TRUE(store_->find_job(job));
    EXPECT_TRUE(store_->find_shape(store_->find_job(job)->info.shape));
}

INSTANTIATE_TEST_SUITE_P(All, JobStoreConformance, testing::ValuesIn(job_stores()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace lpf::server
