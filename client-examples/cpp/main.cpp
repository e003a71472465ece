// Sends a scan to an LPF server, follows the job, and fetches the result.
//
//   lpf-client PROCESS IN OUT [NAME=VALUE ...]
//   lpf-client denoise in.ply out.ply radius=auto
//
// PROCESS is denoise, resample or analyze, whose result is the dictionary; the inputs are those of
// GET /v1/processes/PROCESS. LPF_URL says where the service is, LPF_API_KEY opens it, LPF_RETRIES
// says how often a request is tried again. Ctrl-C cancels the job. Exit codes: failure.h.

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "failure.h"
#include "service.h"

volatile std::sig_atomic_t lpf_client::interrupted = 0;

namespace {

using namespace lpf_client;

std::string variable(const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' ? value : otherwise;
}

/// A bar that stays in its line on a terminal, a line for each ten per cent elsewhere.
void show(const std::string& what, double percent, const std::string& note) {
    static std::string last;
    const std::string step = what + note + std::to_string(static_cast<int>(percent / 10));
    if (isatty(STDERR_FILENO) != 0) {
        const std::string bar(static_cast<std::size_t>(percent / 100 * 30), '#');
        std::fprintf(stderr, "\r\033[K%-10s [%-30s] %3.0f %% %s", what.c_str(), bar.c_str(),
                     percent, note.c_str());
        if (percent >= 100) std::fputc('\n', stderr);
    } else if (step != last) {
        std::fprintf(stderr, "%s: %.0f %% %s\n", what.c_str(), percent, note.c_str());
    }
    last = step;
}

std::multimap<std::string, std::string> inputs_of(int count, char** arguments) {
    std::multimap<std::string, std::string> inputs;
    for (int i = 0; i < count; ++i) {
        const std::string argument = arguments[i];
        const auto equals = argument.find('=');
        if (equals == std::string::npos) {
            throw Failure(Exit::Usage, argument + " is no input; write NAME=VALUE");
        }
        inputs.emplace(argument.substr(0, equals), argument.substr(equals + 1));
    }
    return inputs;
}

void run(int count, char** arguments) {
    if (count < 4) {
        throw Failure(Exit::Usage,
                      "usage: lpf-client denoise|resample|analyze IN OUT [NAME=VALUE]");
    }
    const std::string process = arguments[1], target = arguments[3];
    if (!std::filesystem::is_directory(std::filesystem::absolute(target).parent_path())) {
        throw Failure(Exit::CannotSave, "there is no folder for " + target);
    }
    Access access;
    access.url = variable("LPF_URL", access.url.c_str());
    access.api_key = variable("LPF_API_KEY", "");
    access.retries = std::atoi(variable("LPF_RETRIES", "5").c_str());
    Service service(access, show);
    const std::string job =
        service.submit(process, arguments[2], inputs_of(count - 4, arguments + 4));
    std::fprintf(stderr, "job %s\n", job.c_str());
    try {
        service.follow(job);
        service.save_result(job, process == "analyze" ? "dictionary" : "points", target);
    } catch (const Failure& failure) {
        if (failure.code() != Exit::Interrupted) throw;
        interrupted = 0;  // the request that cancels must not stop for it
        service.cancel(job);
        throw Failure(Exit::Interrupted, "Interrupted; job " + job + " is cancelled.");
    }
    std::printf("%s\n", target.c_str());
}

}  // namespace

int main(int count, char** arguments) {
    std::signal(SIGINT, [](int) { interrupted = 1; });
    std::signal(SIGPIPE, SIG_IGN);
    try {
        run(count, arguments);
        return 0;
    } catch (const Failure& failure) {
        std::fprintf(stderr, "\nlpf-client: %s\n", failure.what());
        return static_cast<int>(failure.code());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "\nlpf-client: %s\n", error.what());
        return static_cast<int>(Exit::Unexpected);
    }
}
