#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/limits.h"
#include "server/log.h"

namespace lpf::server {

/// Everything that an operator can set. Each field is a flag, a variable LPF_* of the environment
/// and a key of the configuration file; the flag wins over the variable, the variable over the
/// file.
struct Config {
    std::string host = "127.0.0.1";
    int port = 8080;        ///< 0 picks a free one
    int admin_port = 8081;  ///< 0 picks a free one
    std::filesystem::path data_dir = "lpf-data";
    std::filesystem::path web_dir;  ///< empty: only the plain index page
    int jobs = 0;                   ///< jobs worked on at a time; 0 = chosen from the cores
    int threads = 0;                ///< threads of each job; 0 = cores / jobs
    int http_threads = 0;           ///< requests served at a time; 0 = chosen from the cores
    double lease_seconds = 30;      ///< a worker that is not heard of for so long loses its job
    double sweep_seconds = 5;       ///< between two looks for such jobs
    LogLevel log_level = LogLevel::Info;
    std::filesystem::path api_key_file;        ///< empty: everybody may use the service
    std::vector<std::string> cors_origins;     ///< pages that may use it; "*": all of them
    std::vector<std::string> trusted_proxies;  ///< addresses whose X-Forwarded-For is believed
    std::uint64_t decoding_bytes =
        1ULL << 30;  ///< for files that requests decode; no flag: what jobs leave
    Limits limits = {};
    bool health_check = false;  ///< only ask a running server whether it is healthy
    std::string hash_key;       ///< only print the line of the key file for this name
};

/// What the command line led to: a configuration, or an end of the program.
struct CommandLine {
    Config config;
    std::optional<int> exit_code;  ///< set after --help, --version or a mistake, which were printed
};

/// Reads flags, environment and configuration file.
[[nodiscard]] CommandLine parse_command_line(int argc, const char* const* argv);

/// Fills in what was left to be chosen, so that jobs x threads never exceeds the cores.
[[nodiscard]] Config resolve_threads(Config config, int cores);

/// Chooses the budget of the jobs (Limits::memory_bytes), so that what the server itself needs is
/// left.
[[nodiscard]] Config resolve_memory(Config config, std::uint64_t usable);

/// Flag of a limit: "uploadBytes" -> "--max-upload-bytes"; empty if it is no flag.
[[nodiscard]] std::string limit_flag(std::string_view limit_name);

/// The program's version.
[[nodiscard]] std::string version();

}  // namespace lpf::server
