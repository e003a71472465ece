#include "core/denoising/ballot.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/base/parallel.h"

namespace lpf {
namespace {

constexpr std::size_t kPoints = 20'000;  // of several locks

/// What vote number k says: a move for every point that it speaks about.
struct Speaker {
    explicit Speaker(std::size_t k) {
        for (std::size_t p = k % 7; p < kPoints; p += 7) {
            points.push_back(static_cast<std::uint32_t>(p));
            weights.push_back(1.0F + static_cast<float>(k % 3));
            moves.push_back(0.01F * static_cast<float>(p % 100) - 0.003F * static_cast<float>(k));
        }
    }
    [[nodiscard]] Votes votes() const {
        return {points, weights, {moves.data(), moves.data(), moves.data()}};
    }
    std::vector<std::uint32_t> points;
    std::vector<float> weights;
    std::vector<float> moves;
};

Ballot voted(int threads) {
    Ballot ballot(kPoints);
    parallel_for({.threads = threads}, 70, 1, [&](std::size_t begin, std::size_t, std::size_t) {
        ballot.cast(Speaker(begin).votes());
    });
    return ballot;
}

TEST(Ballot, TheOutcomeIsTheWeightedMean) {
    const Ballot ballot = voted(1);
    for (const std::size_t p : {0U, 4095U, 4096U, 19'999U}) {
        double weight = 0;
        double sum = 0;
        for (std::size_t k = p % 7; k < 70; k += 7) {
            const double w = 1.0 + static_cast<double>(k % 3);
            weight += w;
            sum += w * (0.01 * static_cast<double>(p % 100) - 0.003 * static_cast<double>(k));
        }
        EXPECT_NEAR(ballot.outcome(p).x(), sum / weight, 1e-6);
        EXPECT_EQ(ballot.outcome(p).x(), ballot.outcome(p).z());
    }
}

TEST(Ballot, ThreadsChangeNoDigit) {
    const Ballot alone = voted(1);
    for (const int threads : {2, 5}) {
        const Ballot together = voted(threads);
        for (std::size_t p = 0; p < kPoints; ++p) {
            ASSERT_EQ(together.outcome(p), alone.outcome(p)) << p;
        }
    }
}

TEST(Ballot, WhoeverGetsNoVoteStays) {
    Ballot ballot(3);
    const std::uint32_t point = 1;
    const float none = 0;
    const float move = 5;
    ballot.cast({{&point, 1}, {&none, 1}, {&move, &move, &move}});
    EXPECT_EQ(ballot.outcome(1), Eigen::Vector3d::Zero().eval());
}

}  // namespace
}  // namespace lpf
