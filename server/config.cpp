#include "server/config.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace lpf::server {
namespace {

/// "--data-dir" -> "LPF_DATA_DIR"
std::string variable_of(const std::string& flag) {
    std::string name = "LPF_";
    for (const char c : flag.substr(2))
        name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return name;
}

template <typename Value>
CLI::Option* add(CLI::App& app, const std::string& flag, Value& value, const std::string& help) {
    return app.add_option(flag, value, help)
        ->envname(variable_of(flag))
        ->take_last()
        ->capture_default_str();
}

/// A flag that may come several times; its variable holds a list with commas.
CLI::Option* add_list(CLI::App& app, const std::string& flag, std::vector<std::string>& values,
                      const std::string& help) {
    return app.add_option(flag, values, help + "; may come several times")
        ->envname(variable_of(flag))
        ->delimiter(',')
        ->take_all();
}

/// Whether the command line gives this flag, so that its variable is not to be added to.
bool is_given(const std::string& flag, int argc, const char* const* argv) {
    return std::any_of(argv + 1, argv + argc, [&](const std::string& argument) {
        return argument == flag || argument.starts_with(flag + "=");
    });
}

/// The command line with the environment's values in front of it, where later values replace them.
/// The library itself would let the configuration file win over the environment.
std::vector<std::string> with_environment(const CLI::App& app, int argc, const char* const* argv) {
    std::vector<std::string> arguments;
    for (const CLI::Option* option : app.get_options()) {
        const std::string variable = option->get_envname();
        const char* value = variable.empty() ? nullptr : std::getenv(variable.c_str());
        if (!value || !*value) continue;
        const bool is_list = option->get_items_expected_max() > 1;
        if (is_list && is_given(option->get_name(), argc, argv)) continue;
        arguments.push_back(option->get_name() + "=" + value);
    }
    for (int i = 1; i < argc; ++i) arguments.emplace_back(argv[i]);
    std::reverse(arguments.begin(), arguments.end());  // as the library wants them
    return arguments;
}

void add_network_and_work(CLI::App& app, Config& config) {
    add(app, "--host", config.host, "Address to listen on");
    add(app, "--port", config.port, "Port of the service; 0 picks a free one")
        ->check(CLI::Range(0, 65535));
    add(app, "--admin-port", config.admin_port,
        "Port of /healthz, /readyz and /metrics; 0 picks a free one")
        ->check(CLI::Range(0, 65535));
    add(app, "--data-dir", config.data_dir, "Folder for jobs, shapes and results");
    add(app, "--web-dir", config.web_dir, "Folder with the web page to serve at /");
    add(app, "--jobs", config.jobs, "Jobs worked on at a time; 0 chooses from the cores")
        ->check(CLI::Range(0, 256));
    add(app, "--threads", config.threads, "Threads of each job; 0 shares the cores out")
        ->check(CLI::Range(0, 1024));
    add(app, "--http-threads", config.http_threads, "Requests served at a time; 0 chooses")
        ->check(CLI::Range(0, 1024));
    add(app, "--lease-seconds", config.lease_seconds,
        "A worker that is not heard of for so long loses its job")
        ->check(CLI::Range(0.3, 86400.0));
    add(app, "--sweep-seconds", config.sweep_seconds, "Time between two looks for lost jobs")
        ->check(CLI::Range(0.1, 86400.0));
    app.add_option_function<std::string>(
           "--log-level",
           [&config](const std::string& name) { config.log_level = *level_from_name(name); },
           "Least level of the log")
        ->envname("LPF_LOG_LEVEL")
        ->take_last()
        ->check(CLI::IsMember({"debug", "info", "warn", "error"}))
        ->default_str("info");
}

void add_access(CLI::App& app, Config& config) {
    add(app, "--api-key-file", config.api_key_file,
        "File with the API keys that open the service, a line each; read again after SIGHUP")
        ->group("Access");
    add_list(app, "--cors-origin", config.cors_origins,
             "Origin of pages that may use the service, such as https://pages.example, or * for "
             "all pages there are")
        ->group("Access");
    add_list(app, "--trusted-proxy", config.trusted_proxies,
             "Address or block of a proxy whose X-Forwarded-For is believed")
        ->group("Access");
    app.add_option("--hash-key", config.hash_key,
                   "Read a key on standard input, print its line for the API key file, and exit")
        ->type_name("NAME")
        ->group("Access");
}

void add_limits(CLI::App& app, Limits& limits) {
    for (const LimitField& field : limit_table()) {
        const std::string flag = limit_flag(field.name);
        if (flag.empty()) continue;
        add(app, flag, limits.*field.value,
            std::string(field.description) + " [" + std::string(field.unit) + "]")
            ->group("Limits");
    }
}

}  // namespace

std::string limit_flag(std::string_view limit_name) {
    const bool is_maximum = limit_name.find("Retention") == std::string_view::npos &&
                            limit_name.find("Floor") == std::string_view::npos;
    std::string flag = is_maximum ? "--max-" : "--";
    for (const char c : limit_name) {
        const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0;
        if (upper) flag += '-';
        flag += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return flag;
}

CommandLine parse_command_line(int argc, const char* const* argv) {
    CommandLine line;
    CLI::App app("LPF Server: denoises, resamples and analyses 3D shapes over HTTP", "lpf-server");
    app.set_version_flag("--version", "lpf-server " + version());
    app.set_config("--config", "", "Configuration file: one 'flag = value' a line, without --")
        ->envname("LPF_CONFIG");
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.add_flag("--healthcheck", line.config.health_check,
                 "Ask the server on --host and --admin-port whether it is healthy, and exit with 0 "
                 "or 1");
    add_network_and_work(app, line.config);
    add_access(app, line.config);
    add_limits(app, line.config.limits);
    try {
        app.parse(with_environment(app, argc, argv));
    } catch (const CLI::ParseError& error) {
        line.exit_code = app.exit(error, std::cout, std::cerr) == 0 ? 0 : 2;
    }
    return line;
}

Config resolve_threads(Config config, int cores) {
    if (config.jobs == 0) {
        const int by_threads = config.threads > 0 ? cores / config.threads : cores / 4;
        config.jobs = std::clamp(by_threads, 1, 8);
    }
    config.jobs = std::min(config.jobs, cores);
    const int share = std::max(1, cores / config.jobs);
    config.threads = config.threads == 0 ? share : std::min(config.threads, share);
    if (config.limits.running_jobs_per_key == 0)
        config.limits.running_jobs_per_key = static_cast<std::uint64_t>(std::max(1, cores));
    if (config.http_threads == 0) config.http_threads = std::max(16, 2 * cores);
    return config;
}

Config resolve_memory(Config config, std::uint64_t usable) {
    constexpr std::uint64_t kServer = 256ULL << 20;
    constexpr std::uint64_t kIdle = 64ULL << 20;
    const auto without = [&](std::uint64_t part) { return usable - std::min(usable, part); };
    std::uint64_t& budget = config.limits.memory_bytes;
    if (budget == 0) budget = std::max(usable / 4, std::min(usable / 4 * 3, without(kServer)));
    config.decoding_bytes = std::max(without(budget + kIdle), kIdle);
    return config;
}

std::string version() { return LPF_VERSION; }

}  // namespace lpf::server
