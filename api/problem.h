#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"

namespace lpf {

/// Media type of every error answer (RFC 9457).
inline constexpr std::string_view kProblemMediaType = "application/problem+json";

/// Everything that can go wrong on the wire. `problem_table` gives each its code, status and title.
enum class ProblemCode {
    InvalidParameter,
    TooFewPoints,
    DegenerateShape,
    IncompatibleDictionary,
    MalformedFile,
    UnsupportedFormat,
    LimitExceeded,
    Cancelled,
    TimedOut,
    OutOfMemory,
    StorageFailure,
    Internal,

    MalformedJson,
    MalformedRequest,
    Unprocessable,
    Unauthorized,
    Forbidden,
    NotFound,
    ProcessNotFound,
    JobNotFound,
    ShapeNotFound,
    DictionaryNotFound,
    ResultNotFound,
    ResultNotReady,
    MethodNotAllowed,
    NotAcceptable,
    RequestTimeout,
    Conflict,
    IdempotencyConflict,
    IdempotencyMismatch,
    ShapeInUse,
    JobDismissed,
    JobExpired,
    LengthRequired,
    PreconditionFailed,
    PayloadTooLarge,
    UriTooLong,
    UnsupportedMediaType,
    RangeNotSatisfiable,
    QuotaExceeded,
    RateLimited,
    HeadTooLarge,
    QueueFull,
    Unavailable,
    InsufficientStorage,
    WorkerLost,
    UndecodableFile
};

/// One row of the only table from problem to HTTP status.
struct ProblemKind {
    ProblemCode problem;
    std::string_view code;  ///< kebab-case, stable: clients switch on it
    int status;
    std::string_view title;
    std::string_view type;  ///< URI of an OGC exception type, or empty for urn:lpf:problem:CODE
};

[[nodiscard]] std::span<const ProblemKind> problem_table();

[[nodiscard]] const ProblemKind& kind_of(ProblemCode problem);

/// The problem that an error of the method is. Every ErrorCode has one.
[[nodiscard]] ProblemCode problem_code(ErrorCode code);

/// Where in the request something is wrong: a JSON pointer ("/inputs/radius") and one sentence.
struct FieldError {
    std::string pointer;
    std::string detail;

    bool operator==(const FieldError&) const = default;
};

/// An error answer. Type, code, title and status follow from `problem`.
struct Problem {
    using Member = std::variant<std::int64_t, double, std::string>;

    ProblemCode problem = ProblemCode::Internal;
    std::string detail = {};    ///< what was wrong, where, and what would be right
    std::string instance = {};  ///< path of the request or job, or empty
    std::vector<FieldError> errors = {};
    int retry_after = 0;  ///< seconds, for the Retry-After header; 0 = none
    std::vector<std::pair<std::string, Member>> members =
        {};  ///< further members, e.g. {"limit", 32}

    [[nodiscard]] int status() const { return kind_of(problem).status; }
    [[nodiscard]] std::string_view code() const { return kind_of(problem).code; }
};

/// A request that is answered with a problem: thrown by every parser of this folder.
class ProblemException : public std::runtime_error {
public:
    explicit ProblemException(Problem problem)
        : std::runtime_error(problem.detail), problem_(std::move(problem)) {}
    ProblemException(ProblemCode problem, const std::string& detail)
        : ProblemException(Problem{.problem = problem, .detail = detail}) {}

    [[nodiscard]] const Problem& problem() const noexcept { return problem_; }

private:
    Problem problem_;
};

/// The answer to an error of the method. Its field, if it has one, becomes a pointer into the
/// inputs. The text of an Internal error is not shown: it goes to the log.
[[nodiscard]] Problem problem_from(const Error& error);

[[nodiscard]] nlohmann::json to_json(const Problem& problem);

/// The inverse of to_json. An unknown code becomes Internal.
[[nodiscard]] Problem problem_from_json(const nlohmann::json& json);

}  // namespace lpf
