#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "server/ids.h"
#include "server/job_queue.h"
#include "server/store/file_blob_store.h"
#include "server/store/sha256.h"
#include "server/store/sqlite_job_store.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {

/// Works until it is told to stop, as core does.
inline JobOutcome work_forever(RunningJob& job) {
    while (!job.stop_token().stop_requested())
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    throw Error(ErrorCode::Cancelled, "Cancelled.");
}

inline JobOutcome work_nothing(RunningJob&) { return {}; }

/// A queue on stores of its own.
class JobQueueTest : public testing::Test {
protected:
    std::unique_ptr<JobQueue> make_queue(JobWork work, QueueOptions options = {}) {
        return std::make_unique<JobQueue>(storage_, events_, log_, telemetry_, options,
                                          std::move(work));
    }

    StatusInfo new_job() {
        ShapeInfo shape;
        shape.id = new_id();
        shape.format = "ply";
        shape.sha256 = sha256_of("shape");
        shape.expires = now_millis() + 1'000'000;
        StatusInfo job;
        job.job_id = new_id();
        job.created = job.updated = now_millis();
        job.shape = books_.add_shape(shape).id;
        return job;
    }

    static std::string submit(JobQueue& queue, const StatusInfo& job, std::uint64_t points = 10,
                              const std::string& owner = "") {
        queue.submit({.info = job, .owner = owner, .points = points});
        return job.job_id;
    }
    std::string submit(JobQueue& queue) { return submit(queue, new_job()); }

    [[nodiscard]] JobStatus status(const std::string& id) const {
        return books_.find_job(id)->info.status;
    }

    /// Waits until it is so, ten seconds at most.
    template <typename Condition>
    static bool becomes(Condition condition) {
        for (int i = 0; i < 2000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }

    static void wait_until_running(JobQueue& queue, const std::string& id) {
        ASSERT_TRUE(becomes([&] { return queue.find(id)->info.status == JobStatus::Running; }));
    }

    TemporaryFolder folder_;
    FileBlobStore blobs_{folder_.path()};
    SqliteJobStore books_{folder_.path() / "jobs.sqlite"};
    Storage storage_{books_, blobs_};
    JobEvents events_;
    Log log_{LogLevel::Info, [](const std::string&) {}};
    Telemetry telemetry_{"test"};
};

}  // namespace lpf::server
