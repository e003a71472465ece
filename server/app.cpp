#include "server/app.h"

#include <algorithm>

#include "core/base/error.h"
#include "server/routes.h"
#include "server/site/pace.h"

namespace lpf::server {
namespace {

constexpr auto kPatience = std::chrono::seconds(10);  // for requests in flight at the end
constexpr std::size_t kAdminThreads = 4;
constexpr std::size_t kWaitingConnections = 256;

Config checked(Config config) {
    if (!config.web_dir.empty() && !std::filesystem::is_directory(config.web_dir)) {
        throw Error(ErrorCode::StorageFailure,
                    "The web folder " + config.web_dir.string() +
                        " is not there. Name a folder with an index.html with --web-dir.");
    }
    return config;
}

std::chrono::milliseconds millis(double seconds) {
    return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
}

QueueOptions queue_options(const Config& config) {
    const Limits& limits = config.limits;
    QueueOptions options;
    options.workers = config.jobs;
    options.limits = {limits.queued_jobs, limits.queued_jobs_per_key};
    options.small_points = limits.small_job_points;
    options.running_per_owner = limits.running_jobs_per_key;
    options.memory = limits.memory_bytes;
    options.leases = {millis(config.lease_seconds), millis(config.sweep_seconds),
                      limits.job_attempts};
    options.job_seconds = static_cast<double>(limits.job_seconds);
    options.result_retention = static_cast<UnixMillis>(limits.result_retention_seconds) * 1000;
    options.max_waiters = static_cast<int>(config.limits.long_requests_at_once);
    return options;
}

http::ListenerOptions public_listener(const Config& config) {
    http::ListenerOptions options;
    options.host = config.host;
    options.port = config.port;
    options.threads = static_cast<std::size_t>(config.http_threads);
    options.queue = kWaitingConnections;
    options.pace = pace_of;
    options.limits = config.limits;
    return options;
}

http::ListenerOptions admin_listener(const Config& config) {
    http::ListenerOptions options = public_listener(config);
    options.port = config.admin_port;
    options.threads = kAdminThreads;
    options.limits.upload_bytes = 0;  // nothing is sent to this one
    return options;
}

}  // namespace

App::App(Config config, Log& log)
    : config_(checked(std::move(config))),
      log_(log),
      data_(config_.data_dir),
      telemetry_(version()),
      blobs_(data_.path()),
      books_(data_.path() / "jobs.sqlite"),
      storage_(books_, blobs_),
      runner_(storage_, {config_.limits, config_.threads, version()}),
      previews_(data_.path() / "previews"),
      queue_(storage_, events_, log_, telemetry_, queue_options(config_),
             [this](RunningJob& job) { return runner_.run(job); }),
      services_{config_, data_, storage_, queue_, events_, previews_, log_, telemetry_},
      gate_(config_, log_),
      admin_(services_, nullptr, admin_routes(services_), admin_listener(config_)),
      site_(services_, &gate_, public_routes(services_), public_listener(config_)) {}

App::~App() { stop(); }

void App::start() {
    sweep();
    queue_.start();
    admin_port_ = admin_.start();
    port_ = site_.start();
    sweeper_ = std::jthread([this](const std::stop_token& stop) { sweep_hourly(stop); });
}

void App::stop() {
    queue_.refuse_new();
    site_.stop(kPatience);
    queue_.stop();
    sweeper_ = {};  // asks it to stop, and joins
    admin_.stop(std::chrono::seconds(1));
}

void App::sweep_hourly(const std::stop_token& stop) {
    std::unique_lock lock(sweep_mutex_);
    while (!stop.stop_requested()) {
        sweep_wake_.wait_for(lock, stop, std::chrono::hours(1), [] { return false; });
        if (!stop.stop_requested()) sweep();
    }
}

void App::sweep() {
    try {
        const auto status_retention =
            static_cast<UnixMillis>(config_.limits.status_retention_seconds) * 1000;
        const auto removed = storage_.sweep(now_millis(), status_retention);
        log_.info("swept", {{"removed", static_cast<std::int64_t>(removed)}});
    } catch (const std::exception& error) {
        log_.error("sweep-failed", {{"error", error.what()}});
    }
}

}  // namespace lpf::server
