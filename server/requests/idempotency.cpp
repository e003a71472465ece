#include "server/requests/idempotency.h"

#include <algorithm>

#include "api/problem.h"
#include "server/store/sha256.h"

namespace lpf::server {
namespace {

constexpr std::size_t kLongestKey = 255;

/// Lengths keep neighbours apart.
void add(Sha256& hash, std::string_view text) {
    hash.update(std::to_string(text.size()) + ":");
    hash.update(text);
}

}  // namespace

RequestsInFlight::Seat::~Seat() {
    if (!all_) return;
    const std::lock_guard lock(all_->mutex_);
    all_->names_.erase(name_);
}

RequestsInFlight::Seat RequestsInFlight::enter(const Name& name) {
    const std::lock_guard lock(mutex_);
    if (!names_.insert(name).second) {
        throw ProblemException({.problem = ProblemCode::IdempotencyConflict,
                                .detail = "A request with this Idempotency-Key is being answered "
                                          "right now. Send it again when that is done.",
                                .retry_after = 1});
    }
    return {*this, name};
}

std::string idempotency_key(std::string_view header) {
    if (header.size() >= 2 && header.front() == '"' && header.back() == '"')
        header = header.substr(1, header.size() - 2);
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    if (header.empty() || header.size() > kLongestKey || !std::ranges::all_of(header, printable)) {
        throw ProblemException(ProblemCode::MalformedRequest,
                               "An Idempotency-Key has 1 to 255 printable ASCII characters; a "
                               "random UUID is a good one.");
    }
    return std::string(header);
}

std::string fingerprint(const http::Request& request, std::string_view body_digest) {
    Sha256 hash;
    add(hash, request.method);
    add(hash, request.path);
    http::Fields query = request.query;
    std::ranges::sort(query);
    for (const auto& [name, value] : query) {
        add(hash, name);
        add(hash, value);
    }
    add(hash, body_digest);
    return hash.finish();
}

}  // namespace lpf::server
