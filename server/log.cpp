#include "server/log.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "server/clock.h"

namespace lpf::server {
namespace {

void write_to_stderr(const std::string& line) {
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

std::string_view level_name(LogLevel level) {
    switch (level) {
        case LogLevel::Debug: return "debug";
        case LogLevel::Info: return "info";
        case LogLevel::Warn: return "warn";
        case LogLevel::Error: return "error";
    }
    return "info";
}

std::optional<LogLevel> level_from_name(std::string_view name) {
    for (const LogLevel level : {LogLevel::Debug, LogLevel::Info, LogLevel::Warn, LogLevel::Error})
        if (level_name(level) == name) return level;
    return std::nullopt;
}

Log::Log(LogLevel least, Sink sink)
    : least_(least), sink_(sink ? std::move(sink) : Sink(write_to_stderr)) {}

void Log::write(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
    if (level < least_) return;
    nlohmann::ordered_json line;
    line["time"] = to_rfc3339(now_millis());
    line["level"] = level_name(level);
    line["event"] = event;
    for (const auto& [name, value] : fields)
        std::visit([&](const auto& v) { line[std::string(name)] = v; }, value);
    const std::string text =
        line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    const std::lock_guard lock(mutex_);
    sink_(text);
}

}  // namespace lpf::server
