#pragma once

#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "server/http/message.h"

namespace lpf::server {

/// The requests with an Idempotency-Key that are being answered right now: the same one a second
/// time is sent away until the first has its answer.
class RequestsInFlight {
public:
    using Name = std::pair<std::string, std::string>;  ///< API key and Idempotency-Key

    /// Leaves when it is destroyed.
    class Seat {
    public:
        Seat() = default;
        Seat(RequestsInFlight& all, Name name) : all_(&all), name_(std::move(name)) {}
        ~Seat();
        Seat(Seat&& other) noexcept
            : all_(std::exchange(other.all_, nullptr)), name_(std::move(other.name_)) {}
        Seat& operator=(Seat&&) = delete;

    private:
        RequestsInFlight* all_ = nullptr;
        Name name_;
    };

    /// @throws ProblemException{IdempotencyConflict} if it is there already
    [[nodiscard]] Seat enter(const Name& name);

private:
    std::mutex mutex_;
    std::set<Name> names_;
};

/// The value of an Idempotency-Key header, with or without the quotation marks of a structured
/// field. @throws ProblemException{MalformedRequest} unless it has 1 to 255 printable characters
[[nodiscard]] std::string idempotency_key(std::string_view header);

/// Stands for a request: digest of its method, path and query and of the digest of its body. The
/// order of the query does not count.
[[nodiscard]] std::string fingerprint(const http::Request& request, std::string_view body_digest);

}  // namespace lpf::server
