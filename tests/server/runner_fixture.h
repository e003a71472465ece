#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <utility>

#include "server/ids.h"
#include "server/runner.h"
#include "server/store/file_blob_store.h"
#include "server/store/mapped_file.h"
#include "server/store/sqlite_job_store.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {

/// Runs jobs without a queue.
class JobRunning : public testing::Test {
protected:
    /// @param shape what is known of the bytes; ID, format and hash are filled in
    JobOutcome run_job(Task task, const JobInputs& inputs, const std::string& bytes,
                       ShapeInfo shape = {}, std::size_t most_in_memory = kMostAtOnce) {
        shape.id = new_id();
        shape.format = "ply";
        shape.sha256 = blobs_.put(bytes);
        StatusInfo info;
        info.job_id = new_id();
        info.process = task;
        info.parameters = inputs;
        info.shape = books_.add_shape(shape).id;
        job_ = std::make_unique<RunningJob>(ClaimedJob{info, {info.job_id, "token"}}, 600);
        RunnerOptions options{.limits = {}, .threads = 2, .version = "test"};
        options.most_in_memory = most_in_memory;
        return Runner(storage_, std::move(options)).run(*job_);
    }

    [[nodiscard]] std::string bytes_of(const JobOutcome& outcome, ResultKind kind) const {
        for (const ResultFile& file : outcome.results) {
            if (file.kind == kind)
                return std::string(MappedFile(blobs_.local_file(file.sha256)).text());
        }
        return {};
    }

    [[nodiscard]] Document points_of(const JobOutcome& outcome) const {
        const std::string bytes = bytes_of(outcome, ResultKind::Points);
        return decode(std::as_bytes(std::span(bytes)));
    }

    TemporaryFolder folder_;
    FileBlobStore blobs_{folder_.path()};
    SqliteJobStore books_{folder_.path() / "jobs.sqlite"};
    Storage storage_{books_, blobs_};
    std::unique_ptr<RunningJob> job_;
};

}  // namespace lpf::server
