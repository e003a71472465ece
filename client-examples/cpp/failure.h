#pragma once

#include <csignal>
#include <stdexcept>
#include <string>

namespace lpf_client {

/// The exit codes of the program.
enum class Exit {
    Done = 0,
    Unexpected = 1,
    Usage = 2,
    NoServer = 3,
    BadFile = 4,
    Busy = 5,
    JobFailed = 6,
    AccessDenied = 7,
    CannotSave = 8,
    Interrupted = 130
};

/// What went wrong, in words and as an exit code.
class Failure : public std::runtime_error {
public:
    Failure(Exit code, const std::string& message) : std::runtime_error(message), code_(code) {}
    Exit code() const { return code_; }

private:
    Exit code_;
};

/// Set by Ctrl-C; looked at wherever the program waits.
extern volatile std::sig_atomic_t interrupted;

inline void stop_if_interrupted() {
    if (interrupted) throw Failure(Exit::Interrupted, "Interrupted.");
}

}  // namespace lpf_client
