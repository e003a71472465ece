#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace lpf::server {

enum class LogLevel { Debug, Info, Warn, Error };

[[nodiscard]] std::string_view level_name(LogLevel level);
[[nodiscard]] std::optional<LogLevel> level_from_name(std::string_view name);

/// A value of a log line.
using LogValue = std::variant<std::int64_t, double, std::string>;
using LogField = std::pair<std::string_view, LogValue>;

/// Writes one JSON object a line. What may be logged: identifiers, counts, codes, durations. Never
/// file names, query strings, header values or anything else that a stranger wrote freely.
class Log {
public:
    using Sink = std::function<void(const std::string& line)>;

    /// @param sink receives whole lines; by default they go to standard error
    explicit Log(LogLevel least = LogLevel::Info, Sink sink = {});

    void write(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {});

    void info(std::string_view event, std::initializer_list<LogField> fields = {}) {
        write(LogLevel::Info, event, fields);
    }
    void warn(std::string_view event, std::initializer_list<LogField> fields = {}) {
        write(LogLevel::Warn, event, fields);
    }
    void error(std::string_view event, std::initializer_list<LogField> fields = {}) {
        write(LogLevel::Error, event, fields);
    }

private:
    LogLevel least_;
    Sink sink_;
    std::mutex mutex_;
};

}  // namespace lpf::server
