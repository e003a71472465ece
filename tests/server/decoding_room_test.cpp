#include "server/decoding_room.h"

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

TEST(DecodingRoom, WaitsUntilMemoryIsFree) {
    DecodingRoom room(100);
    auto first = std::make_unique<Seat>(room, 60);
    std::atomic<bool> seated = false;
    std::thread other([&] {
        const Seat second(room, 60);
        seated = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_FALSE(seated);
    first.reset();
    other.join();
    EXPECT_TRUE(seated);
}

TEST(DecodingRoom, HasFewSeats) {
    DecodingRoom room(100);
    const Seat first(room, 1);
    auto second = std::make_unique<Seat>(room, 1);
    std::atomic<bool> seated = false;
    std::thread other([&] {
        const Seat third(room, 1);
        seated = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_FALSE(seated);
    second.reset();
    other.join();
    EXPECT_TRUE(seated);
}

}  // namespace
}  // namespace lpf::server
