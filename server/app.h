#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "server/config.h"
#include "server/gate/gate.h"
#include "server/job_queue.h"
#include "server/jobs/job_events.h"
#include "server/requests/preview_cache.h"
#include "server/runner.h"
#include "server/services.h"
#include "server/site/site.h"
#include "server/store/file_blob_store.h"
#include "server/store/sqlite_job_store.h"

namespace lpf::server {

/// The whole server: its parts, made in order, stopped in the opposite one.
class App {
public:
    /// @param config with its threads resolved
    /// @throws Error{StorageFailure} when the data folder or the web folder cannot be used
    App(Config config, Log& log);
    ~App();

    /// Takes up old jobs and listens. @throws Error{StorageFailure} when a port cannot be had
    void start();

    /// Takes nothing new, lets requests in flight end, gives running jobs back.
    void stop();

    /// Reads the API keys again.
    void reload() { gate_.reload(); }

    [[nodiscard]] int port() const { return port_; }
    [[nodiscard]] int admin_port() const { return admin_port_; }

private:
    void sweep_hourly(const std::stop_token& stop);
    void sweep();

    Config config_;
    Log& log_;
    DataDir data_;
    Telemetry telemetry_;
    FileBlobStore blobs_;
    SqliteJobStore books_;
    Storage storage_;
    Runner runner_;
    JobEvents events_;
    PreviewCache previews_;
    JobQueue queue_;
    Services services_;
    Gate gate_;
    Site admin_;
    Site site_;
    int port_ = 0;
    int admin_port_ = 0;
    std::mutex sweep_mutex_;
    std::condition_variable_any sweep_wake_;
    std::jthread sweeper_;
};

}  // namespace lpf::server
