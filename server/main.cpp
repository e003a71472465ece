#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/base/error.h"
#include "server/app.h"
#include "server/cores.h"
#include "server/gate/api_keys.h"
#include "server/http/health_check.h"
#include "server/large_pages.h"

namespace {

using namespace lpf::server;

/// SIGTERM, SIGINT and SIGHUP, blocked in every thread that starts from here on, to be waited for.
sigset_t block_stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    return signals;
}

/// Ends the process when an orderly stop takes too long: whatever still runs is recovered at the
/// next start, while a supervisor that lost patience would kill it anyway.
void leave_after(std::chrono::seconds time) {
    std::thread([time] {
        std::this_thread::sleep_for(time);
        ::_exit(0);
    }).detach();
}

void run(const Config& config, Log& log) {
    const sigset_t signals = block_stop_signals();
    App app(config, log);
    app.start();
    const nlohmann::ordered_json ready{{"event", "listening"},
                                       {"host", config.host},
                                       {"port", app.port()},
                                       {"adminPort", app.admin_port()},
                                       {"version", version()}};
    std::cout << ready.dump() << std::endl;
    log.info("started", {{"jobs", config.jobs},
                         {"threads", config.threads},
                         {"memoryBudget", static_cast<std::int64_t>(config.limits.memory_bytes)}});

    int signal = SIGHUP;
    while (sigwait(&signals, &signal) == 0 && signal == SIGHUP) app.reload();
    log.info("stopping", {{"signal", signal}});
    leave_after(std::chrono::seconds(28));
    app.stop();
    log.info("stopped");
}

/// Prints the line that lets the key on standard input in.
int print_key_line(const std::string& name) {
    std::string key;
    std::getline(std::cin, key);
    if (!key.empty() && key.back() == '\r') key.pop_back();
    try {
        std::cout << lpf::gate::ApiKeys::line(name, key) << std::endl;
        return 0;
    } catch (const lpf::Error& error) {
        std::cerr << "lpf-server: " << error.what() << std::endl;
        return 2;
    }
}

}  // namespace

int main(int argc, char** argv) {
    const CommandLine line = parse_command_line(argc, argv);
    if (line.exit_code) return *line.exit_code;
    if (!line.config.hash_key.empty()) return print_key_line(line.config.hash_key);
    if (line.config.health_check)
        return is_healthy(line.config.host, line.config.admin_port) ? 0 : 1;
    use_large_pages(argv);
    const Config config =
        resolve_memory(resolve_threads(line.config, usable_cores()), usable_memory());
    Log log(config.log_level);
    try {
        run(config, log);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "lpf-server: " << error.what() << std::endl;
        return 1;
    }
}
