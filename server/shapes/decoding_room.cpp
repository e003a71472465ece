#include "server/shapes/decoding_room.h"

#include <chrono>
#include <string>

#include "api/problem.h"

namespace lpf::server {
namespace {

constexpr auto kPatience = std::chrono::seconds(60);
constexpr int kRetrySeconds = 30;

std::uint64_t within(double memory, std::uint64_t all) {
    if (memory <= static_cast<double>(all)) return static_cast<std::uint64_t>(memory);
    throw ProblemException({.problem = ProblemCode::OutOfMemory,
                            .detail = "Decoding this file would need about " +
                                      std::to_string(static_cast<std::uint64_t>(memory) >> 20) +
                                      " MiB of memory; requests may use " +
                                      std::to_string(all >> 20) +
                                      " MiB. Send fewer points, or give the server more memory.",
                            .members = {{"limit", static_cast<std::int64_t>(all)},
                                        {"estimate", static_cast<std::int64_t>(memory)}}});
}

}  // namespace

DecodingRoom::Seat::Seat(DecodingRoom& room, double memory)
    : room_(room), memory_(within(memory, room.all_)) {
    std::unique_lock lock(room.mutex_);
    const bool found = room.left_.wait_for(
        lock, kPatience, [&] { return room.seats_ > 0 && room.memory_ >= memory_; });
    if (!found) {
        throw ProblemException({.problem = ProblemCode::Unavailable,
                                .detail = "Other files are being decoded; try again in a while.",
                                .retry_after = kRetrySeconds});
    }
    --room.seats_;
    room.memory_ -= memory_;
}

DecodingRoom::Seat::~Seat() {
    const std::lock_guard lock(room_.mutex_);
    ++room_.seats_;
    room_.memory_ += memory_;
    room_.left_.notify_all();
}

}  // namespace lpf::server
