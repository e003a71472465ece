#include "server/jobs/job_events.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/job_event.h"
#include "api/json_text.h"
#include "server/clock.h"

namespace lpf::server {
namespace {

constexpr std::size_t kEventsOfJob = 64;
constexpr std::size_t kStories = 4096;
constexpr UnixMillis kKept = 5LL * 60 * 1000;       // after the end of a job
constexpr UnixMillis kCleaning = 30LL * 1000;       // between two looks at what is old
constexpr std::uint64_t kIdsPerMillisecond = 1000;  // more than are ever given out

}  // namespace

/// The clock gives the first id, so that those of an earlier run of the server are smaller.
JobEvents::JobEvents()
    : last_id_(static_cast<std::uint64_t>(now_millis()) * kIdsPerMillisecond),
      cleaned_(now_millis()) {}

std::uint64_t JobEvents::next_id() { return ++last_id_; }

void JobEvents::add(Story& story, std::string name, std::string data) {
    // Only the last progress is of use, to those who follow and to those who come back.
    if (name == "progress")
        std::erase_if(story.events, [](const JobEvent& event) { return event.name == "progress"; });
    story.events.push_back({next_id(), std::move(name), std::move(data)});
    if (story.events.size() > kEventsOfJob) story.events.pop_front();
}

JobEvents::Story& JobEvents::story_of(const std::string& job_id) {
    const UnixMillis now = now_millis();
    if (now - cleaned_ > kCleaning) forget_before(now - kKept);
    if (!stories_.contains(job_id)) make_room();
    return stories_[job_id];
}

void JobEvents::make_room() {
    while (stories_.size() >= kStories) {
        const auto ended = std::ranges::find_if(
            stories_, [](const auto& entry) { return entry.second.ended > 0; });
        stories_.erase(ended == stories_.end() ? stories_.begin() : ended);
    }
}

void JobEvents::status(const StatusInfo& info) {
    const std::string data = dump_json(to_json(info));
    const std::lock_guard lock(mutex_);
    Story& story = story_of(info.job_id);
    add(story, "status", data);
    if (!is_finished(info.status)) return;
    add(story, "end", data);
    story.ended = now_millis();
}

void JobEvents::progress(const StatusInfo& info) {
    std::string data = dump_json(progress_event_to_json(info));
    const std::lock_guard lock(mutex_);
    Story& story = story_of(info.job_id);
    if (story.ended == 0) add(story, "progress", std::move(data));
}

void JobEvents::log(const std::string& job_id, const std::string& code, const std::string& detail) {
    std::string data = dump_json(log_event_to_json(job_id, now_millis(), code, detail));
    const std::lock_guard lock(mutex_);
    Story& story = story_of(job_id);
    if (story.ended == 0) add(story, "log", std::move(data));
}

std::vector<JobEvent> JobEvents::after(const std::string& job_id, std::uint64_t last) const {
    const std::lock_guard lock(mutex_);
    const auto story = stories_.find(job_id);
    if (story == stories_.end()) return {};
    if (last > last_id_) last = 0;  // from a server whose clock was ahead
    const auto& events = story->second.events;
    const auto first = std::ranges::upper_bound(events, last, {}, &JobEvent::id);
    return {first, events.end()};
}

bool JobEvents::knows(const std::string& job_id) const {
    const std::lock_guard lock(mutex_);
    return stories_.contains(job_id);
}

std::vector<JobEvent> JobEvents::tell(const StatusInfo& info) {
    const std::string data = dump_json(to_json(info));
    const std::lock_guard lock(mutex_);
    std::vector<JobEvent> events{{next_id(), "status", data}};
    if (is_finished(info.status)) events.push_back({next_id(), "end", data});
    return events;
}

void JobEvents::forget_old() {
    const std::lock_guard lock(mutex_);
    forget_before(now_millis() - kKept);
}

void JobEvents::forget_before(UnixMillis time) {
    cleaned_ = now_millis();
    std::erase_if(stories_, [&](const auto& entry) {
        return entry.second.ended > 0 && entry.second.ended < time;
    });
}

}  // namespace lpf::server
