#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/time_text.h"
#include "core/auto_parameters.h"

namespace lpf::server {

/// A job that waits: what its turn depends on.
struct WaitingJob {
    std::string id;
    std::string owner;  ///< name of its API key, or empty
    Task process = Task::Denoise;
    std::uint64_t points = 0;  ///< of its shape
    UnixMillis rank = 0;       ///< see rank_of
    std::uint64_t memory = 0;  ///< that it may take [bytes]
};

/// What an owner of jobs has had so far.
struct OwnerState {
    std::uint64_t running = 0;
    std::uint64_t last_turn = 0;  ///< grows with every job that is started; 0: none was
};
using Owners = std::map<std::string, OwnerState>;

/// Place in the queue of one owner: jobs are ordered by it. A job counts as if it had come later by
/// a time that grows with its size, so that small jobs overtake large ones; but that time has an
/// end, and what waits longer than it is overtaken no more.
[[nodiscard]] UnixMillis rank_of(UnixMillis created, std::uint64_t points);

/// The jobs in the order of their turns: owners take turns, whoever has fewest jobs running first,
/// then whoever was served longest ago; within an owner by rank.
/// @param jobs in the order of their arrival
[[nodiscard]] std::vector<WaitingJob> in_turn(std::vector<WaitingJob> jobs, const Owners& owners);

/// What a worker may take.
struct TurnRules {
    bool small_only = false;                        ///< the other workers are busy with large jobs
    std::uint64_t small_points = 0;                 ///< jobs up to this size are small
    std::uint64_t running_per_owner = 0;            ///< 0: any number; no limit for the empty owner
    std::optional<std::uint64_t> memory_free = {};  ///< [bytes]; nothing: every job fits
    UnixMillis now = 0;
};

/// The first of the jobs that may start now, or null. A job that finds too little memory is passed
/// by others until its rank is reached; from then on they wait with it, so that its time comes.
/// @param jobs as in_turn gave them
[[nodiscard]] const WaitingJob* next_turn(const std::vector<WaitingJob>& jobs, const Owners& owners,
                                          const TurnRules& rules);

/// When each of the jobs will start [s from now], if nothing else comes: every worker takes the
/// next one when it is free.
/// @param busy    time that each worker is still busy for; one entry per worker
/// @param seconds time that each job will take, in the order of the turns
[[nodiscard]] std::vector<double> start_times(std::vector<double> busy,
                                              const std::vector<double>& seconds);

}  // namespace lpf::server
