#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <unordered_map>

namespace lpf::gate {

/// A token bucket for everyone: it holds `burst` requests and regains `per_second`. Remembers those
/// who asked last, a bounded number of them, so that strangers cannot fill the memory; who is
/// forgotten begins with a full bucket.
class RateLimiter {
public:
    using Clock = std::chrono::steady_clock;

    struct Rate {
        double per_second = 0;  ///< 0: no limit
        double burst = 1;
    };

    /// What came of a request.
    struct Verdict {
        bool allowed = true;
        int limit = 0;          ///< requests in a full bucket
        int remaining = 0;      ///< requests that could follow at once
        int reset_seconds = 0;  ///< until the bucket is full
        int retry_seconds = 0;  ///< until a refused request would be allowed, at least 1
    };

    explicit RateLimiter(Rate rate, std::size_t memory = 10'000);

    [[nodiscard]] bool enabled() const { return rate_.per_second > 0; }

    /// Takes one token of `who`, if there is one.
    Verdict take(const std::string& who, Clock::time_point now = Clock::now());

    /// Buckets that are remembered.
    [[nodiscard]] std::size_t size() const;

private:
    struct Bucket {
        std::string who;
        double tokens;
        Clock::time_point updated;
    };

    Bucket& bucket_of(const std::string& who, Clock::time_point now);

    Rate rate_;
    std::size_t memory_;
    mutable std::mutex mutex_;
    std::list<Bucket> buckets_;  // who asked last stands first
    std::unordered_map<std::string, std::list<Bucket>::iterator> places_;
};

}  // namespace lpf::gate
