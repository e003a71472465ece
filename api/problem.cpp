#include "api/problem.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "api/camel_case.h"

namespace lpf {
namespace {

using P = ProblemCode;

constexpr ProblemKind kProblems[] = {
    {P::InvalidParameter, "invalid-parameter", 422, "An input is not valid", ""},
    {P::TooFewPoints, "too-few-points", 422, "The shape has too few points", ""},
    {P::DegenerateShape, "degenerate-shape", 422, "The shape has no extent", ""},
    {P::IncompatibleDictionary, "incompatible-dictionary", 422, "The dictionary does not fit", ""},
    {P::MalformedFile, "malformed-file", 422, "The file breaks the rules of its format", ""},
    {P::UnsupportedFormat, "unsupported-format", 415, "The file is of no format read here", ""},
    {P::LimitExceeded, "limit-exceeded", 413, "The content is over a limit", ""},
    {P::Cancelled, "cancelled", 409, "The work was cancelled", ""},
    {P::TimedOut, "timed-out", 422, "The job needs more time than it may use", ""},
    {P::OutOfMemory, "out-of-memory", 422, "The job needs more memory than it may use", ""},
    {P::StorageFailure, "storage-failure", 500, "The storage failed", ""},
    {P::Internal, "internal", 500, "The server failed", ""},
    {P::MalformedJson, "malformed-json", 400, "The body is not valid JSON", ""},
    {P::MalformedRequest, "malformed-request", 400, "The request is malformed", ""},
    {P::Unauthorized, "unauthorized", 401, "An API key is needed", ""},
    {P::Forbidden, "forbidden", 403, "This may not be done from here", ""},
    {P::NotFound, "not-found", 404, "There is nothing here", ""},
    {P::ProcessNotFound, "process-not-found", 404, "There is no such process",
     "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/no-such-process"},
    {P::JobNotFound, "job-not-found", 404, "There is no such job",
     "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/no-such-job"},
    {P::ShapeNotFound, "shape-not-found", 404, "There is no such shape", ""},
    {P::DictionaryNotFound, "dictionary-not-found", 404, "There is no such dictionary", ""},
    {P::ResultNotFound, "result-not-found", 404, "The job has no such result", ""},
    {P::ResultNotReady, "result-not-ready", 404, "The job is not finished",
     "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/result-not-ready"},
    {P::MethodNotAllowed, "method-not-allowed", 405, "The method is not allowed here", ""},
    {P::NotAcceptable, "not-acceptable", 406, "No acceptable format is offered", ""},
    {P::RequestTimeout, "request-timeout", 408, "The request came too slowly", ""},
    {P::Conflict, "conflict", 409, "The request does not fit the present state", ""},
    {P::IdempotencyConflict, "idempotency-conflict", 409, "The same request is in flight", ""},
    {P::ShapeInUse, "shape-in-use", 409, "A job still needs the shape", ""},
    {P::JobDismissed, "job-dismissed", 410, "The job was dismissed", ""},
    {P::JobExpired, "job-expired", 410, "The job has expired", ""},
    {P::LengthRequired, "length-required", 411, "The length of the body is needed", ""},
    {P::PreconditionFailed, "precondition-failed", 412, "A precondition does not hold", ""},
    {P::PayloadTooLarge, "payload-too-large", 413, "The body is too large", ""},
    {P::UriTooLong, "uri-too-long", 414, "The address is too long", ""},
    {P::UnsupportedMediaType, "unsupported-media-type", 415, "The media type is not read here", ""},
    {P::RangeNotSatisfiable, "range-not-satisfiable", 416, "The range lies behind the end", ""},
    {P::Unprocessable, "unprocessable", 422, "The request cannot be carried out", ""},
    {P::IdempotencyMismatch, "idempotency-mismatch", 422, "The key was used for another request",
     ""},
    {P::UndecodableFile, "undecodable", 422, "The file could not be decoded within its limits", ""},
    {P::QuotaExceeded, "quota-exceeded", 429, "The key has too many jobs waiting", ""},
    {P::RateLimited, "rate-limited", 429, "Too many requests", ""},
    {P::HeadTooLarge, "head-too-large", 431, "The head of the request is too large", ""},
    {P::WorkerLost, "worker-lost", 500, "The worker was lost too often", ""},
    {P::QueueFull, "queue-full", 503, "The queue is full", ""},
    {P::Unavailable, "unavailable", 503, "The service is not available", ""},
    {P::InsufficientStorage, "insufficient-storage", 507, "There is too little storage left", ""},
};

std::string type_of(const ProblemKind& kind) {
    if (!kind.type.empty()) return std::string(kind.type);
    return "urn:lpf:problem:" + std::string(kind.code);
}

bool is_standard_member(std::string_view name) {
    constexpr std::array kNames{"type",     "title", "status", "detail",
                                "instance", "code",  "errors", "retryAfter"};
    return std::ranges::find(kNames, name) != kNames.end();
}

ProblemCode problem_named(std::string_view code) {
    const auto* row = std::ranges::find(kProblems, code, &ProblemKind::code);
    return row == std::end(kProblems) ? ProblemCode::Internal : row->problem;
}

}  // namespace

std::span<const ProblemKind> problem_table() { return kProblems; }

const ProblemKind& kind_of(ProblemCode problem) {
    return *std::ranges::find(kProblems, problem, &ProblemKind::problem);
}

ProblemCode problem_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::InvalidParameter: return P::InvalidParameter;
        case ErrorCode::TooFewPoints: return P::TooFewPoints;
        case ErrorCode::DegenerateShape: return P::DegenerateShape;
        case ErrorCode::IncompatibleDictionary: return P::IncompatibleDictionary;
        case ErrorCode::MalformedFile: return P::MalformedFile;
        case ErrorCode::UnsupportedFormat: return P::UnsupportedFormat;
        case ErrorCode::LimitExceeded: return P::LimitExceeded;
        case ErrorCode::Cancelled: return P::Cancelled;
        case ErrorCode::TimedOut: return P::TimedOut;
        case ErrorCode::OutOfMemory: return P::OutOfMemory;
        case ErrorCode::StorageFailure: return P::StorageFailure;
        case ErrorCode::Internal: return P::Internal;
    }
    return P::Internal;
}

Problem problem_from(const Error& error) {
    Problem problem{.problem = problem_code(error.code()), .detail = error.what()};
    if (problem.status() >= 500) {
        problem.detail = "The server could not do this; its log says why. Trying again may help.";
    }
    if (!error.field().empty()) {
        problem.errors.push_back({"/inputs/" + camel_case(error.field()), problem.detail});
    }
    return problem;
}

nlohmann::json to_json(const Problem& problem) {
    const ProblemKind& kind = kind_of(problem.problem);
    nlohmann::json json = {{"type", type_of(kind)},
                           {"title", kind.title},
                           {"status", kind.status},
                           {"detail", problem.detail},
                           {"code", kind.code}};
    if (!problem.instance.empty()) json["instance"] = problem.instance;
    if (problem.retry_after > 0) json["retryAfter"] = problem.retry_after;
    for (const auto& [name, value] : problem.members) {
        std::visit([&json, &key = name](const auto& v) { json[key] = v; }, value);
    }
    for (const FieldError& error : problem.errors) {
        json["errors"].push_back({{"pointer", error.pointer}, {"detail", error.detail}});
    }
    return json;
}

Problem problem_from_json(const nlohmann::json& json) {
    Problem problem{.problem = problem_named(json.value("code", "")),
                    .detail = json.value("detail", ""),
                    .instance = json.value("instance", ""),
                    .retry_after = json.value("retryAfter", 0)};
    for (const auto& error : json.value("errors", nlohmann::json::array())) {
        problem.errors.push_back({error.value("pointer", ""), error.value("detail", "")});
    }
    for (const auto& [name, value] : json.items()) {
        if (is_standard_member(name)) continue;
        if (value.is_number_integer())
            problem.members.emplace_back(name, value.get<std::int64_t>());
        if (value.is_number_float()) problem.members.emplace_back(name, value.get<double>());
        if (value.is_string()) problem.members.emplace_back(name, value.get<std::string>());
    }
    return problem;
}

}  // namespace lpf
