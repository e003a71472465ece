#include "core/base/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"

namespace lpf {
namespace {

class ParallelFor : public testing::TestWithParam<int> {
protected:
    [[nodiscard]] Execution execution() const { return {.threads = GetParam()}; }
};

TEST_P(ParallelFor, VisitsEveryItemOnce) {
    for (const std::size_t n : {1U, 2U, 99U, 100U, 101U, 1000U}) {
        std::vector<std::atomic<int>> visits(n);
        parallel_for(execution(), n, 100, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (const auto& count : visits) ASSERT_EQ(count, 1) << "n = " << n;
    }
}

TEST_P(ParallelFor, MakesTheChunksThatChunkCountPromises) {
    std::mutex mutex;
    std::set<std::size_t> chunks;
    parallel_for(execution(), 1003, 100,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     EXPECT_EQ(begin, chunk * 100);
                     EXPECT_EQ(end, std::min<std::size_t>(1003, begin + 100));
                     const std::scoped_lock lock(mutex);
                     chunks.insert(chunk);
                 });
    EXPECT_EQ(chunks.size(), chunk_count(1003, 100));
    EXPECT_EQ(*chunks.rbegin(), 10U);
}

TEST_P(ParallelFor, DoesNothingForNoItems) {
    parallel_for(execution(), 0, 10, [](std::size_t, std::size_t, std::size_t) { FAIL(); });
}

TEST_P(ParallelFor, RethrowsTheExceptionOfABodyAndStopsTheOthers) {
    std::atomic<int> started = 0;
    const auto body = [&](std::size_t, std::size_t, std::size_t chunk) {
        ++started;
        if (chunk == 3) throw std::runtime_error("chunk 3");
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    EXPECT_THROW(parallel_for(execution(), 10000, 1, body), std::runtime_error);
    EXPECT_LT(started, 1000);
}

TEST_P(ParallelFor, StopsWithinOneChunkOfACancellation) {
    std::stop_source source;
    Execution cancellable = execution();
    cancellable.stop = source.get_token();
    std::atomic<int> started = 0;
    try {
        parallel_for(cancellable, 1000, 1, [&](std::size_t, std::size_t, std::size_t) {
            if (++started == 5) source.request_stop();
        });
        FAIL() << "no exception";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
    EXPECT_LE(started, 5 + GetParam());  // each thread may be in a chunk
}

TEST_P(ParallelFor, ReportsRisingProgressThatEndsAtOne) {
    std::vector<double> fractions;
    Execution reporting = execution();
    reporting.progress = [&](const Progress& progress) {
        EXPECT_EQ(progress.phase, "count");
        EXPECT_EQ(progress.unit, "items");
        EXPECT_EQ(progress.total, 500U);
        EXPECT_DOUBLE_EQ(progress.fraction, static_cast<double>(progress.done) / 500);
        fractions.push_back(progress.fraction);
    };
    parallel_for(reporting, "count", "items", 500, 7, [](std::size_t, std::size_t, std::size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    });
    ASSERT_GE(fractions.size(), 2U);
    EXPECT_EQ(fractions.front(), 0);
    EXPECT_EQ(fractions.back(), 1);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST_P(ParallelFor, GivesTheSameSumForAnyNumberOfThreads) {
    const auto sum = [](int threads) {
        std::vector<double> partial(chunk_count(100000, 777));
        parallel_for({.threads = threads}, 100000, 777,
                     [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                         for (std::size_t i = begin; i < end; ++i) {
                             partial[chunk] += Random(1, i).normal();
                         }
                     });
        double total = 0;
        for (const double value : partial) total += value;
        return total;
    };
    EXPECT_EQ(sum(GetParam()), sum(1));
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelFor, testing::Values(1, 2, 5, 8),
                         testing::PrintToStringParamName());

TEST(PartOf, MapsTheFractionIntoTheCallersBar) {
    std::vector<double> fractions;
    Execution whole;
    whole.progress = [&](const Progress& progress) { fractions.push_back(progress.fraction); };
    const Execution part = part_of(whole, 0.5, 0.75);
    for (const double fraction : {0.0, 0.5, 1.0}) {
        part.progress({.phase = "p", .unit = "u", .fraction = fraction});
    }
    EXPECT_THAT(fractions, testing::ElementsAre(0.5, 0.625, 0.75));
}

TEST(PartOf, StaysSilentWhereNobodyListens) { EXPECT_FALSE(part_of({}, 0.0, 0.5).progress); }

TEST(ThrowIfCancelled, ThrowsOnlyAfterARequest) {
    std::stop_source source;
    const Execution execution{.stop = source.get_token()};
    EXPECT_NO_THROW(throw_if_cancelled(execution));
    source.request_stop();
    EXPECT_THROW(throw_if_cancelled(execution), Error);
}

TEST(ErrorType, CarriesCodeMessageAndField) {
    const Error error(ErrorCode::InvalidParameter, "radius must be positive", "radius");
    EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
    EXPECT_STREQ(error.what(), "radius must be positive");
    EXPECT_EQ(error.field(), "radius");
}

TEST(ParallelFor, OfNothingIsDoneAtOnce) {
    std::vector<double> fractions;
    const Execution execution{
        .progress = [&](const Progress& progress) { fractions.push_back(progress.fraction); }};
    parallel_for(execution, "phase", "unit", 0, 10, [](auto, auto, auto) { FAIL(); });
    ASSERT_FALSE(fractions.empty());
    EXPECT_EQ(fractions.back(), 1.0);
}

}  // namespace
}  // namespace lpf
