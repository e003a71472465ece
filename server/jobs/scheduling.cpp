#include "server/jobs/scheduling.h"

#include <algorithm>
#include <tuple>

namespace lpf::server {
namespace {

constexpr std::uint64_t kPointsPerMilli = 10;         // a job of a million points lets 100 s pass
constexpr UnixMillis kLongestDelay = 10 * 60 * 1000;  // and none lets pass more than 10 minutes

}  // namespace

UnixMillis rank_of(UnixMillis created, std::uint64_t points) {
    const auto delay =
        static_cast<UnixMillis>(std::min<std::uint64_t>(points / kPointsPerMilli, kLongestDelay));
    return created + delay;
}

std::vector<WaitingJob> in_turn(std::vector<WaitingJob> jobs, const Owners& owners) {
    std::ranges::stable_sort(jobs, {}, &WaitingJob::rank);
    using Turn = std::tuple<std::uint64_t, std::uint64_t, UnixMillis, std::size_t>;
    std::vector<Turn> turns;
    std::map<std::string_view, OwnerState> states(owners.begin(), owners.end());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        OwnerState& owner = states[jobs[i].owner];
        turns.emplace_back(owner.running++, owner.last_turn, jobs[i].rank, i);
    }
    std::ranges::sort(turns);
    std::vector<WaitingJob> ordered;
    ordered.reserve(jobs.size());
    for (const Turn& turn : turns) ordered.push_back(jobs[std::get<3>(turn)]);
    return ordered;
}

const WaitingJob* next_turn(const std::vector<WaitingJob>& jobs, const Owners& owners,
                            const TurnRules& rules) {
    const auto owner_may = [&](const WaitingJob& job) {
        if (job.owner.empty() || rules.running_per_owner == 0) return true;
        const auto owner = owners.find(job.owner);
        return owner == owners.end() || owner->second.running < rules.running_per_owner;
    };
    for (const WaitingJob& job : jobs) {
        if (!owner_may(job)) continue;
        if (rules.memory_free && job.memory > *rules.memory_free) {
            if (job.rank <= rules.now) return nullptr;
            continue;
        }
        if (!rules.small_only || job.points <= rules.small_points) return &job;
    }
    return nullptr;
}

std::vector<double> start_times(std::vector<double> busy, const std::vector<double>& seconds) {
    std::vector<double> starts;
    starts.reserve(seconds.size());
    std::ranges::make_heap(busy, std::greater{});
    for (const double time : seconds) {
        if (busy.empty()) break;
        std::ranges::pop_heap(busy, std::greater{});
        starts.push_back(busy.back());
        busy.back() += time;
        std::ranges::push_heap(busy, std::greater{});
    }
    return starts;
}

}  // namespace lpf::server
