#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace lpf {

/// Every way in which the project refuses or fails. `api/problem` maps each to an HTTP status.
enum class ErrorCode {
    InvalidParameter,        ///< a parameter is outside its range or contradicts another
    TooFewPoints,            ///< fewer finite points than the method can work on
    DegenerateShape,         ///< the points have no extent (all of them coincide)
    IncompatibleDictionary,  ///< a dictionary's pattern does not fit the requested one
    MalformedFile,           ///< the bytes break the rules of their own format
    UnsupportedFormat,       ///< the bytes are of no format that is read here
    LimitExceeded,           ///< a count or a size is over a limit; the message names the limit
    Cancelled,               ///< the stop token was triggered
    TimedOut,                ///< the job ran longer than it was allowed to
    OutOfMemory,             ///< the work would need, or needed, more memory than its budget
    StorageFailure,          ///< reading or writing durable storage failed
    Internal                 ///< a defect of the program
};

/// The one exception type of the project: what was wrong, where, and what would be right.
class Error : public std::runtime_error {
public:
    /// @param code    what kind of failure
    /// @param message one sentence for the user
    /// @param field   name of the parameter at fault (as on the wire), or empty
    Error(ErrorCode code, const std::string& message, std::string field = {})
        : std::runtime_error(message), code_(code), field_(std::move(field)) {}

    [[nodiscard]] ErrorCode code() const noexcept { return code_; }
    [[nodiscard]] const std::string& field() const noexcept { return field_; }

private:
    ErrorCode code_;
    std::string field_;
};

}  // namespace lpf
