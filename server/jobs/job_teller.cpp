#include "server/jobs/job_teller.h"

namespace lpf::server {

void JobTeller::waits(const StatusInfo& info) {
    const std::lock_guard lock(mutex_);
    told_.erase(info.job_id);
    events_.status(info);
}

void JobTeller::waits_first(const StatusInfo& info) {
    const std::lock_guard lock(mutex_);
    if (!events_.knows(info.job_id)) events_.status(info);  // a worker may have been quicker
}

void JobTeller::runs(const StatusInfo& info) {
    const std::lock_guard lock(mutex_);
    if (!events_.knows(info.job_id)) {
        StatusInfo before = info;
        before.status = JobStatus::Accepted;
        before.message = "Waiting for a worker.";
        before.started.reset();
        --before.attempt;
        events_.status(before);
    }
    told_[info.job_id] = {.phase = {}, .warnings = info.warnings.size()};
    events_.status(info);
}

void JobTeller::moves(const StatusInfo& info, bool with_progress) {
    const std::lock_guard lock(mutex_);
    const auto told = told_.find(info.job_id);
    if (told == told_.end()) return;
    tell_news(told->second, info);
    if (with_progress) events_.progress(info);
}

void JobTeller::ends(const StatusInfo& info) {
    const std::lock_guard lock(mutex_);
    if (const auto told = told_.find(info.job_id); told != told_.end()) {
        tell_news(told->second, info);
        told_.erase(told);
    }
    events_.status(info);
}

void JobTeller::tell_news(Told& told, const StatusInfo& info) {
    for (; told.warnings < info.warnings.size(); ++told.warnings) {
        const Warning& warning = info.warnings[told.warnings];
        events_.log(info.job_id, warning.code, warning.detail);
    }
    if (info.phase.empty() || info.phase == told.phase) return;
    told.phase = info.phase;
    events_.log(info.job_id, "phase", info.phase);
}

}  // namespace lpf::server
