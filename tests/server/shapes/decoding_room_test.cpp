#include "server/shapes/decoding_room.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

#include "api/problem.h"

namespace lpf::server {
namespace {

using Seat = DecodingRoom::Seat;

TEST(DecodingRoom, RefusesWhatNeverFits) {
    DecodingRoom room(100 << 20);
    const Seat seat(room, 100 << 20);
    try {
        const Seat too_large(room, 101 << 20);
        FAIL() << "there is no such memory";
    } catch (const ProblemException& error) {
        EXPECT_EQ(error.problem().code(), "out-of-memory");
        EXPECT_NE(error.problem().detail.find("100 MiB"), std::string::npos);
    }
}

/// Somebody waits for `memory` for as long as `holder` keeps its seat.
void expect_wait(DecodingRoom& room, double memory, std::unique_ptr<Seat> holder) {
    std::atomic<bool> seated = false;
    std::thread other([&] {
        const Seat seat(room, memory);
        seated = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_FALSE(seated);
    holder.reset();
    other.join();
    EXPECT_TRUE(seated);
}

TEST(DecodingRoom, WaitsUntilMemoryIsFree) {
    DecodingRoom room(100);
    expect_wait(room, 60, std::make_unique<Seat>(room, 60));
}

TEST(DecodingRoom, HasFewSeats) {
    DecodingRoom room(100);
    const Seat first(room, 1);
    expect_wait(room, 1, std::make_unique<Seat>(room, 1));
}

}  // namespace
}  // namespace lpf::server
