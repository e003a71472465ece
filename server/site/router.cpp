#include "server/site/router.h"

#include <algorithm>
#include <optional>

#include "core/base/error.h"
#include "server/requests/answer.h"

namespace lpf::server {
namespace {

std::vector<std::string> segments_of(const std::string& path) {
    std::vector<std::string> segments(1);
    for (const char c : path) {
        if (c == '/') {
            segments.emplace_back();
        } else {
            segments.back() += c;
        }
    }
    return segments;
}

/// What the placeholders stand for, if the path fits the pattern.
std::optional<std::vector<std::string>> match(const std::string& pattern,
                                              const std::vector<std::string>& path) {
    const auto wanted = segments_of(pattern);
    if (wanted.size() != path.size()) return std::nullopt;
    std::vector<std::string> parameters;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i].starts_with('{') && !path[i].empty()) {
            parameters.push_back(path[i]);
        } else if (wanted[i] != path[i]) {
            return std::nullopt;
        }
    }
    return parameters;
}

/// "GET, HEAD, OPTIONS, POST"
std::string allow_header(std::vector<std::string> methods) {
    if (std::find(methods.begin(), methods.end(), "GET") != methods.end())
        methods.emplace_back("HEAD");
    methods.emplace_back("OPTIONS");
    std::sort(methods.begin(), methods.end());
    std::string text;
    for (const auto& method : methods) text += (text.empty() ? "" : ", ") + method;
    return text;
}

}  // namespace

Router::Router(std::vector<Route> routes, RouteHandler fallback)
    : routes_(std::move(routes)), fallback_(std::move(fallback)) {}

http::Response Router::dispatch(http::Request& request) const {
    const std::string method = request.method == "HEAD" ? "GET" : request.method;
    const auto path = segments_of(request.path);
    std::vector<std::string> others;
    for (const Route& route : routes_) {
        auto parameters = match(route.pattern, path);
        if (!parameters) continue;
        request.route = route.pattern;
        request.path_parameters = std::move(*parameters);
        if (route.method == method) return route.handler(request);
        others.push_back(route.method);
    }
    if (others.empty() && fallback_ && method == "GET") return fallback_(request);
    if (others.empty()) {
        throw ProblemException(ProblemCode::NotFound,
                               "There is nothing at this path. The API starts at /v1/, and "
                               "/v1/openapi.json describes it.");
    }
    const std::string allow = allow_header(std::move(others));
    if (method == "OPTIONS") {
        http::Response response;
        response.status = 204;
        return response.set("Allow", allow);
    }
    http::Response response =
        problem_response({.problem = ProblemCode::MethodNotAllowed,
                          .detail = "This path takes " + allow + ", not " + request.method + "."},
                         request);
    return response.set("Allow", allow);
}

http::Response Router::handle(http::Request& request,
                              const std::function<void(const std::string&)>& report) const {
    try {
        return dispatch(request);
    } catch (const ProblemException& error) {
        return problem_response(error.problem(), request);
    } catch (const Error& error) {
        const Problem problem = problem_from(error);
        if (problem.status() >= 500) report(error.what());
        return problem_response(problem, request);
    } catch (const std::bad_alloc&) {
        return problem_response(
            problem_from(Error(ErrorCode::OutOfMemory,
                               "The request needs more memory than the server has.")),
            request);
    } catch (const std::exception& error) {
        report(error.what());
        return problem_response(problem_from(Error(ErrorCode::Internal, error.what())), request);
    }
}

}  // namespace lpf::server
