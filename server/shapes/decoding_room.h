#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace lpf::server {

/// Where files are decoded within requests: a few at a time, in so much memory together.
class DecodingRoom {
public:
    /// @param memory of all seats together [bytes]
    explicit DecodingRoom(std::uint64_t memory) : memory_(memory) {}

    /// Waits for a place.
    /// @param memory that the work in it may take [bytes]
    /// @throws ProblemException{OutOfMemory} if there never is so much, {Unavailable} if it is
    /// taken by others for long
    class Seat {
    public:
        Seat(DecodingRoom& room, double memory);
        ~Seat();
        Seat(const Seat&) = delete;
        Seat& operator=(const Seat&) = delete;

    private:
        DecodingRoom& room_;
        std::uint64_t memory_;
    };

private:
    static constexpr int kSeats = 2;

    std::mutex mutex_;
    std::condition_variable left_;
    std::uint64_t memory_;  // that is free
    int seats_ = kSeats;
    const std::uint64_t all_ = memory_;
};

}  // namespace lpf::server
