#include "server/gate/origins.h"

#include <algorithm>

#include "api/http_text.h"
#include "api/problem.h"
#include "core/base/error.h"
#include "server/gate/peer.h"

namespace lpf::gate {
namespace {

constexpr const char* kRequestHeaders =
    "Authorization, Content-Type, Prefer, Idempotency-Key, If-Match, If-None-Match, If-Range, "
    "Range, Last-Event-ID, X-Request-Id";
constexpr const char* kAnswerHeaders =
    "Location, ETag, Retry-After, Link, Accept-Ranges, Content-Disposition, Content-Range, "
    "Preference-Applied, X-Request-Id, Idempotency-Replayed, RateLimit-Limit, RateLimit-Remaining, "
    "RateLimit-Reset, WWW-Authenticate";
constexpr const char* kPreflightSeconds = "600";

bool is_secure(std::string_view origin) { return origin.starts_with("https://"); }

/// "https://a.example:444" -> "a.example:444"
std::string_view host_of(std::string_view origin) {
    const auto mark = origin.find("://");
    return mark == std::string_view::npos ? std::string_view{} : origin.substr(mark + 3);
}

/// The name alone, without the port.
std::string_view without_port(std::string_view host) {
    if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
    return host.substr(0, host.rfind(':'));
}

/// With the scheme's own port left out, as browsers do.
std::string_view without_default_port(std::string_view host, bool secure) {
    const std::string_view port = secure ? ":443" : ":80";
    if (host.ends_with(port)) host.remove_suffix(port.size());
    return host;
}

/// As browsers write it: scheme and host in lower case, no default port.
std::string normal(std::string_view origin) {
    const std::string text = lower(origin);
    return std::string(without_default_port(text, is_secure(text)));
}

bool is_origin(std::string_view text) {
    const auto host = host_of(text);
    return (text.starts_with("http://") || is_secure(text)) && !host.empty() &&
           host.find_first_of("/?#@, *") == std::string_view::npos;
}

bool only_reads(const std::string& method) {
    return method == "GET" || method == "HEAD" || method == "OPTIONS";
}

void vary_by_origin(http::Response& response) {
    const std::string before = response.header("Vary").value_or("");
    response.set("Vary", before.empty() ? "Origin" : before + ", Origin");
}

void answer_preflight(const http::Request& request, bool named, http::Response& response) {
    if (request.method != "OPTIONS" || !request.header("access-control-request-method")) return;
    if (const auto methods = response.header("Allow"))
        response.set("Access-Control-Allow-Methods", *methods);
    response.set("Access-Control-Allow-Headers", kRequestHeaders);
    response.set("Access-Control-Max-Age", kPreflightSeconds);
    // Browsers ask this before a public page may reach a private network. Only for named pages.
    if (named && request.header("access-control-request-private-network"))
        response.set("Access-Control-Allow-Private-Network", "true");
}

}  // namespace

Origins::Origins(const std::vector<std::string>& allowed, bool local) : local_(local) {
    for (const std::string& text : allowed) {
        if (text == "*") {
            any_ = true;
        } else if (const std::string origin = normal(text); is_origin(origin)) {
            allowed_.push_back(origin);
        } else {
            throw Error(ErrorCode::InvalidParameter,
                        "'" + text +
                            "' is no origin. An origin is scheme, host and port without a path, "
                            "such as https://pages.example or http://localhost:3000.");
        }
    }
}

bool Origins::allows(const std::string& origin) const {
    return any_ || std::find(allowed_.begin(), allowed_.end(), normal(origin)) != allowed_.end();
}

bool Origins::is_own_host(std::string_view host) const {
    const auto name = without_port(host);
    const bool foreign_name = name.find('.') != std::string_view::npos && !Address::parse(name) &&
                              !name.ends_with(".localhost");
    if (!local_ || !foreign_name) return true;
    return std::any_of(allowed_.begin(), allowed_.end(), [&](const std::string& origin) {
        return without_port(host_of(origin)) == name;
    });
}

void Origins::check(const http::Request& request) const {
    const std::string host = lower(request.header("host").value_or(""));
    if (!is_own_host(host)) {
        throw ProblemException(
            ProblemCode::Forbidden,
            "This server listens for its own machine only and is not known by this host name. "
            "Use localhost, or name the proxy in front of it with --trusted-proxy.");
    }
    const auto origin = request.header("origin");
    if (!origin || only_reads(request.method) || allows(*origin)) return;
    const bool own = is_origin(normal(*origin)) &&
                     host_of(normal(*origin)) == without_default_port(host, is_secure(*origin));
    if (!own) {
        throw ProblemException(ProblemCode::Forbidden,
                               "Pages of this origin may not change anything here. The server's "
                               "operator can allow them with --cors-origin.");
    }
}

void Origins::dress(const http::Request& request, http::Response& response) const {
    if (!any_ && allowed_.empty()) return;
    if (!any_) vary_by_origin(response);
    const auto origin = request.header("origin");
    if (!origin || !allows(*origin)) return;
    const bool named =
        std::find(allowed_.begin(), allowed_.end(), normal(*origin)) != allowed_.end();
    response.set("Access-Control-Allow-Origin", any_ ? "*" : *origin);
    response.set("Access-Control-Expose-Headers", kAnswerHeaders);
    answer_preflight(request, named, response);
}

}  // namespace lpf::gate
