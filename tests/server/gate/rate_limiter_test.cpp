#include "server/gate/rate_limiter.h"

#include <gtest/gtest.h>

namespace lpf::gate {
namespace {

TEST(RateLimiter, ABucketHoldsTheBurstAndRegainsItsRate) {
    RateLimiter limiter({2.0, 3.0});
    const auto start = RateLimiter::Clock::time_point{} + std::chrono::hours(1);
    for (int left = 2; left >= 0; --left) {
        const auto verdict = limiter.take("a", start);
        EXPECT_TRUE(verdict.allowed);
        EXPECT_EQ(verdict.limit, 3);
        EXPECT_EQ(verdict.remaining, left);
    }
    const auto refused = limiter.take("a", start);
    EXPECT_FALSE(refused.allowed);
    EXPECT_EQ(refused.retry_seconds, 1);
    EXPECT_EQ(refused.reset_seconds, 2);
    EXPECT_TRUE(limiter.take("b", start).allowed);
    EXPECT_TRUE(limiter.take("a", start + std::chrono::milliseconds(500)).allowed);
    EXPECT_FALSE(limiter.take("a", start + std::chrono::milliseconds(501)).allowed);
}

TEST(RateLimiter, LetsThroughNoMoreThanRateTimesTimePlusBurst) {
    RateLimiter limiter({10.0, 5.0});
    const auto start = RateLimiter::Clock::time_point{} + std::chrono::hours(1);
    int allowed = 0;
    for (int ms = 0; ms < 10'000; ms += 3)
        allowed += limiter.take("a", start + std::chrono::milliseconds(ms)).allowed;
    EXPECT_GE(allowed, 103);
    EXPECT_LE(allowed, 105);
}

TEST(RateLimiter, RemembersABoundedNumberOfClients) {
    RateLimiter limiter({1.0, 1.0}, 100);
    const auto now = RateLimiter::Clock::time_point{} + std::chrono::hours(1);
    for (int i = 0; i < 10'000; ++i) (void)limiter.take("client " + std::to_string(i), now);
    EXPECT_EQ(limiter.size(), 100U);
    EXPECT_FALSE(limiter.take("client 9999", now).allowed);
    EXPECT_TRUE(limiter.take("client 1", now).allowed);  // forgotten
}

TEST(RateLimiter, ZeroIsNoLimit) {
    RateLimiter limiter({0.0, 0.0});
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(limiter.take("a").allowed);
    EXPECT_EQ(limiter.size(), 0U);
}

}  // namespace
}  // namespace lpf::gate
