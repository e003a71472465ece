#include "server/gate/gate.h"

#include "api/problem.h"
#include "core/base/error.h"
#include "server/requests/answer.h"

namespace lpf::server {
namespace {

using gate::Address;

/// The service proper. What lies outside, the web page and /healthz, is for everybody.
bool is_service(const http::Request& request) {
    return request.path == "/v1" || request.path.starts_with("/v1/");
}

/// A server that only its own machine reaches, and no proxy on it for others.
bool is_local(const Config& config) {
    const auto address = Address::parse(config.host);
    const bool loopback = config.host == "localhost" || (address && address->is_loopback());
    return loopback && config.trusted_proxies.empty();
}

gate::RateLimiter::Rate rate(std::uint64_t per_second, std::uint64_t burst) {
    return {static_cast<double>(per_second), static_cast<double>(burst)};
}

/// All fields of this name, joined in their order.
std::string joined(const http::Request& request, std::string_view name) {
    std::string text;
    for (const auto& [key, value] : request.headers)
        if (key == name) text += (text.empty() ? "" : ",") + value;
    return text;
}

void set_rate(http::Response& response, int limit, int remaining, int reset) {
    response.set("RateLimit-Limit", std::to_string(limit));
    response.set("RateLimit-Remaining", std::to_string(remaining));
    response.set("RateLimit-Reset", std::to_string(reset));
}

}  // namespace

Gate::Gate(const Config& config, Log& log)
    : log_(log),
      proxies_(config.trusted_proxies),
      origins_(config.cors_origins, is_local(config)),
      requests_(rate(config.limits.requests_per_second, config.limits.request_burst)),
      uploads_(rate(config.limits.uploads_per_second, config.limits.upload_burst)) {
    if (config.api_key_file.empty()) return;
    keys_ = std::make_unique<gate::KeyFile>(config.api_key_file);
    if (keys_->readable_by_all())
        log_.warn("api-keys-readable-by-all", {{"hint", "chmod 640 the API key file"}});
}

void Gate::reload() {
    if (!keys_) return;
    try {
        keys_->reload();
        log_.info("api-keys-loaded", {{"keys", static_cast<std::int64_t>(keys_->keys()->size())}});
    } catch (const Error& error) {
        log_.error("api-keys-kept", {{"error", error.what()}});
    }
}

http::Response Gate::pass(http::Request& request, const std::function<http::Response()>& next) {
    http::Response response;
    Verdict verdict;
    try {
        admit(request, verdict);
        response = next();
    } catch (const ProblemException& refusal) {
        response = problem_response(refusal.problem(), request);
        if (response.status == 401) {
            const bool tried = request.header("authorization").has_value();
            response.set("WWW-Authenticate", tried ? "Bearer realm=\"lpf\", error=\"invalid_token\""
                                                   : "Bearer realm=\"lpf\"");
        }
    }
    if (verdict.limit > 0)
        set_rate(response, verdict.limit, verdict.remaining, verdict.reset_seconds);
    origins_.dress(request, response);
    return response;
}

void Gate::admit(http::Request& request, Verdict& verdict) {
    bool local = false;
    find_client(request, local);
    origins_.check(request);
    if (!is_service(request) || request.method == "OPTIONS") return;
    const std::string address = "address " + request.client;
    try {
        find_key(request);
    } catch (const ProblemException&) {
        if (!local) count(address, false, verdict);  // whoever guesses keys is slowed down
        throw;
    }
    if (request.key.empty() && local) return;
    count(request.key.empty() ? address : "key " + request.key, request.method == "POST", verdict);
}

/// @param local becomes true for somebody on this very machine
void Gate::find_client(http::Request& request, bool& local) const {
    const auto client =
        proxies_.client(Address::parse(request.client), joined(request, "x-forwarded-for"));
    local = client && client->is_loopback();
    if (client) request.client = client->owner();
}

void Gate::find_key(http::Request& request) const {
    if (!keys_) return;
    const auto header = request.header("authorization");
    const auto key = gate::bearer_key(header.value_or(""));
    const auto name = key ? keys_->keys()->name_of(*key) : std::nullopt;
    if (!name) {
        throw ProblemException(ProblemCode::Unauthorized,
                               header ? "This API key is not known here."
                                      : "This needs an API key: send 'Authorization: Bearer KEY'.");
    }
    request.key = *name;
}

void Gate::count(const std::string& who, bool upload, Verdict& verdict) {
    verdict = requests_.take(who);
    const char* limit = "requestsPerSecond";
    if (verdict.allowed && upload && uploads_.enabled()) {
        verdict = uploads_.take(who);
        limit = "uploadsPerSecond";
    }
    if (verdict.allowed) return;
    throw ProblemException({.problem = ProblemCode::RateLimited,
                            .detail = "More requests than the limit " + std::string(limit) +
                                      " of /v1/info allows; try again in " +
                                      std::to_string(verdict.retry_seconds) + " s.",
                            .retry_after = verdict.retry_seconds,
                            .members = {{"limit", std::string(limit)}}});
}

}  // namespace lpf::server
