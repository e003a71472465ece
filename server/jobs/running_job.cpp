#include "server/jobs/running_job.h"

#include <algorithm>

namespace lpf::server {
namespace {

constexpr double kFarAway = 1e8;  // seconds; keeps the deadline within the clock's range

}  // namespace

RunningJob::RunningJob(ClaimedJob claim, double seconds_allowed)
    : lease_(std::move(claim.lease)),
      points_(claim.points),
      memory_(claim.memory),
      lease_until_(claim.lease_until),
      deadline_(started_ + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(std::min(seconds_allowed, kFarAway)))),
      info_(std::move(claim.info)) {}

StatusInfo RunningJob::info() const {
    const std::lock_guard lock(mutex_);
    return info_;
}

void RunningJob::warn(std::string code, std::string detail) {
    update([&](StatusInfo& info) {
        for (const Warning& known : info.warnings)
            if (known.code == code && known.detail == detail) return;
        info.warnings.push_back({std::move(code), std::move(detail)});
    });
}

ProgressSink RunningJob::progress_sink(double low, double high) {
    return [this, low, high](const Progress& progress) {
        update([&](StatusInfo& info) {
            const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
            info.progress = std::max(info.progress, low + (high - low) * fraction);
            info.phase = progress.phase;
            info.phase_progress =
                PhaseProgress{progress.done, progress.total, std::string(progress.unit)};
            set_eta();
        });
    };
}

void RunningJob::enter_phase(const std::string& phase, double percent) {
    update([&](StatusInfo& info) {
        info.phase = phase;
        info.phase_progress.reset();
        info.progress = std::max(info.progress, percent);
        set_eta();
    });
}

void RunningJob::set_eta() {
    constexpr double kTooEarly = 3.0;  // percent: a guess from less is worth nothing
    if (info_.progress < kTooEarly) return;
    info_.eta_seconds = seconds() * (100.0 - info_.progress) / info_.progress;
}

bool RunningJob::stop(StopReason reason) {
    {
        const std::lock_guard lock(mutex_);
        if (reason_) return false;
        reason_ = reason;
        stopped_ = Clock::now();
    }
    stop_.request_stop();
    return true;
}

std::optional<StopReason> RunningJob::stop_reason() const {
    const std::lock_guard lock(mutex_);
    return reason_;
}

double RunningJob::seconds_stopping() const {
    const std::lock_guard lock(mutex_);
    return reason_ ? seconds_since(stopped_) : 0.0;
}

}  // namespace lpf::server
