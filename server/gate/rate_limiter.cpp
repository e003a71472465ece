#include "server/gate/rate_limiter.h"

#include <algorithm>
#include <cmath>

namespace lpf::gate {
namespace {

int whole_seconds(double seconds) {
    constexpr double kDay = 24 * 3600;
    return static_cast<int>(std::ceil(std::min(seconds, kDay)));
}

}  // namespace

RateLimiter::RateLimiter(Rate rate, std::size_t memory)
    : rate_{rate.per_second, std::max(1.0, rate.burst)},
      memory_(std::max<std::size_t>(1, memory)) {}

RateLimiter::Verdict RateLimiter::take(const std::string& who, Clock::time_point now) {
    if (!enabled()) return {};
    const std::lock_guard lock(mutex_);
    Bucket& bucket = bucket_of(who, now);
    const double seconds = std::chrono::duration<double>(now - bucket.updated).count();
    bucket.tokens =
        std::min(rate_.burst, bucket.tokens + std::max(0.0, seconds) * rate_.per_second);
    bucket.updated = now;
    Verdict verdict;
    verdict.allowed = bucket.tokens >= 1;
    if (verdict.allowed) bucket.tokens -= 1;
    verdict.limit = static_cast<int>(rate_.burst);
    verdict.remaining = static_cast<int>(bucket.tokens);
    verdict.reset_seconds = whole_seconds((rate_.burst - bucket.tokens) / rate_.per_second);
    if (!verdict.allowed)
        verdict.retry_seconds = std::max(1, whole_seconds((1 - bucket.tokens) / rate_.per_second));
    return verdict;
}

RateLimiter::Bucket& RateLimiter::bucket_of(const std::string& who, Clock::time_point now) {
    if (const auto place = places_.find(who); place != places_.end()) {
        buckets_.splice(buckets_.begin(), buckets_, place->second);
        return buckets_.front();
    }
    if (buckets_.size() == memory_) {
        places_.erase(buckets_.back().who);
        buckets_.pop_back();
    }
    buckets_.push_front({who, rate_.burst, now});
    places_[who] = buckets_.begin();
    return buckets_.front();
}

std::size_t RateLimiter::size() const {
    const std::lock_guard lock(mutex_);
    return buckets_.size();
}

}  // namespace lpf::gate
