#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "server/clock.h"
#include "server/store/storage.h"

namespace lpf::server {

/// Why a running job was told to stop.
enum class StopReason { Dismissed, TimedOut, Shutdown, LeaseLost };

/// What a job leaves behind when it succeeds.
struct JobOutcome {
    std::vector<ResultFile> results;
    std::optional<StoredDictionary> dictionary;
    FileHold files_held;  ///< until the books name the files
    std::vector<std::pair<std::string, double>> phase_seconds = {};  ///< how long each phase took
};

/// A job while a worker has it: its state in memory, always fresh, and the switch that stops it.
class RunningJob {
public:
    RunningJob(ClaimedJob claim, double seconds_allowed);

    [[nodiscard]] const Lease& lease() const { return lease_; }
    [[nodiscard]] std::uint64_t points() const { return points_; }  ///< of its shape
    [[nodiscard]] std::uint64_t memory() const { return memory_; }  ///< that it may take [bytes]
    [[nodiscard]] StatusInfo info() const;
    [[nodiscard]] std::stop_token stop_token() const { return stop_.get_token(); }
    [[nodiscard]] UnixMillis lease_until() const { return lease_until_; }
    void lease_holds_until(UnixMillis time) { lease_until_ = time; }
    [[nodiscard]] double seconds() const { return seconds_since(started_); }

    /// Changes the state under the lock.
    template <typename Change>
    void update(Change change) {
        const std::lock_guard lock(mutex_);
        change(info_);
        info_.updated = now_millis();
    }

    /// Adds a warning, unless it is there already.
    void warn(std::string code, std::string detail);

    /// A sink that maps a computation's progress to [low, high] percent of the job.
    [[nodiscard]] ProgressSink progress_sink(double low, double high);

    /// Enters a phase that does not count for itself.
    void enter_phase(const std::string& phase, double percent);

    /// The worker is writing the job's end: from then on its lease may be gone for a good reason.
    void begin_end() { ending_ = true; }
    [[nodiscard]] bool is_ending() const { return ending_; }

    /// Only the first reason counts. @returns false if there was one before
    bool stop(StopReason reason);
    [[nodiscard]] std::optional<StopReason> stop_reason() const;
    /// Since the stop was asked for.
    [[nodiscard]] double seconds_stopping() const;
    [[nodiscard]] bool is_overdue() const { return Clock::now() >= deadline_; }

private:
    void set_eta();

    Lease lease_;
    std::uint64_t points_;
    std::uint64_t memory_;
    std::atomic<UnixMillis> lease_until_;
    std::atomic<bool> ending_ = false;
    Clock::time_point started_ = Clock::now();
    Clock::time_point deadline_;
    std::stop_source stop_;
    mutable std::mutex mutex_;
    StatusInfo info_;
    std::optional<StopReason> reason_;
    Clock::time_point stopped_;
};

}  // namespace lpf::server
