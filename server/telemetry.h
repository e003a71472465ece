#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <tuple>

#include "api/job.h"

namespace lpf::server {

/// How many observations fell under each of a row of bounds, as Prometheus counts them.
class Histogram {
public:
    static constexpr std::array kBounds{0.005, 0.025, 0.1, 0.5, 1.0,   2.5,
                                        5.0,   10.0,  30., 60., 300.0, 1800.0};

    void observe(double value);
    [[nodiscard]] std::string text(const std::string& name, const std::string& labels) const;

private:
    std::array<std::uint64_t, kBounds.size() + 1> counts_{};
    double sum_ = 0;
};

/// What is true at the moment of the scrape.
struct Gauges {
    std::map<JobStatus, std::uint64_t> jobs;
    std::uint64_t queued = 0;
    std::uint64_t running = 0;
    std::uint64_t workers = 0;
    double oldest_queued_seconds = 0;
    double uptime_seconds = 0;
    bool ready = false;
};

/// The figures of the running server, as Prometheus reads them (text format 0.0.4).
class Telemetry {
public:
    explicit Telemetry(std::string version) : version_(std::move(version)) {}

    void count_request(const std::string& method, const std::string& route, int status,
                       std::uint64_t bytes_sent, double seconds);
    void count_received(std::uint64_t bytes);
    /// A problem document that was sent, by its code.
    void count_problem(std::string_view code);
    void count_job(std::string_view process, std::string_view status, double seconds);
    /// Time between the acceptance of a job and its start.
    void observe_queue_wait(double seconds);
    /// Time that a job spent in one of its phases.
    void observe_phase(std::string_view phase, double seconds);
    /// Time between a cancellation and the end of the job's work.
    void observe_cancel(double seconds);
    /// A job that was taken from a worker here which did not renew its lease in time.
    void count_lease_loss();
    /// Event streams that were opened (1) or ended (-1).
    void add_event_streams(int change);

    [[nodiscard]] std::string text(const Gauges& gauges) const;

private:
    [[nodiscard]] std::string http_text() const;
    [[nodiscard]] std::string jobs_text() const;

    mutable std::mutex mutex_;
    std::string version_;
    std::map<std::tuple<std::string, std::string, int>, std::uint64_t> requests_;
    std::map<std::string, Histogram> request_seconds_;               // by route
    std::map<std::pair<std::string, std::string>, Histogram> jobs_;  // by process and status
    std::map<std::string, std::uint64_t> problems_;                  // by code
    std::map<std::string, Histogram> phases_;                        // by name
    Histogram queue_wait_;
    Histogram cancel_;
    std::int64_t event_streams_ = 0;
    std::uint64_t lease_losses_ = 0;
    std::uint64_t received_ = 0;
    std::uint64_t sent_ = 0;
};

}  // namespace lpf::server
