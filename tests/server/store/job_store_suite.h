#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/ids.h"
#include "server/store/sha256.h"
#include "tests/server/store/stores.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {

constexpr UnixMillis kNow = 1'800'000'000'000;
constexpr UnixMillis kDay = 24LL * 3600 * 1000;
constexpr UnixMillis kLease = 30'000;

/// What every JobStore must do, whatever keeps its books.
class JobStoreSuite : public testing::TestWithParam<StoreMaker<JobStore>> {
protected:
    TemporaryFolder folder_;
    std::unique_ptr<JobStore> store_ = GetParam().make(folder_.path());

    void reopen() {
        store_.reset();
        store_ = GetParam().make(folder_.path());
    }

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

    NewJob new_job(const std::string& owner = "", std::uint64_t points = 10,
                   UnixMillis created = kNow) {
        NewJob job{.info = {}, .owner = owner, .points = points};
        job.info.job_id = new_id();
        job.info.created = job.info.updated = created;
        job.info.shape = add_shape().id;
        return job;
    }

    /// @returns ID of a job that waits
    std::string add_job(const std::string& owner = "", std::uint64_t points = 10,
                        UnixMillis created = kNow) {
        const NewJob job = new_job(owner, points, created);
        store_->add_job(job, {});
        return job.info.job_id;
    }

    std::optional<ClaimedJob> claim(UnixMillis now = kNow, const TurnRules& rules = {}) {
        return store_->claim_next({.now = now, .lease_until = now + kLease, .rules = rules});
    }

    /// ID of the job that is claimed next; empty if there is none.
    std::string claimed_id(const TurnRules& rules = {}) {
        const auto job = claim(kNow, rules);
        return job ? job->info.job_id : "";
    }

    static StatusInfo successful(StatusInfo info) {
        info.status = JobStatus::Successful;
        info.finished = kNow + 1000;
        info.expires = kNow + kDay;
        return info;
    }

    static ResultFile result_file(const std::string& content) {
        return {ResultKind::Points, "application/ply", content.size(), sha256_of(content)};
    }

    /// Runs a job to its end, with one result.
    void finish_job(const ClaimedJob& claim, const std::string& content = "result") {
        EXPECT_TRUE(store_->finish(claim.lease, successful(claim.info), {result_file(content)},
                                   std::nullopt, kNow + 1000));
    }

    [[nodiscard]] JobStatus status(const std::string& id) const {
        return store_->find_job(id)->info.status;
    }

    /// Code of the problem that the action throws; empty if it throws none.
    template <typename Action>
    static std::string problem_of(Action action) {
        try {
            action();
        } catch (const ProblemException& error) {
            return std::string(error.problem().code());
        }
        return "";
    }
};

}  // namespace lpf::server
