#include "service.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "failure.h"
#include "transfer.h"

namespace lpf_client {
namespace {

using nlohmann::json;

json parse(const std::string& text) {
    json value = json::parse(text, nullptr, false);
    return value.is_object() ? value : json::object();
}

/// A problem document (RFC 9457) in words; nothing in it may steer a terminal.
std::string describe(const json& problem) {
    const std::string detail = problem.value("detail", "");
    std::string text = problem.value("title", "The server gave no reason");
    if (!detail.empty()) text += ": " + detail;
    for (const json& error : problem.value("errors", json::array())) {
        if (error.value("detail", "") == detail) continue;
        text += "\n  " + error.value("pointer", "") + ": " + error.value("detail", "");
    }
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ' && c != '\n') c = '?';
    }
    return text;
}

Failure failure_of(int status, const json& problem) {
    const Exit code = status == 401 || status == 403                     ? Exit::AccessDenied
                      : status == 429 || status == 503                   ? Exit::Busy
                      : status == 502 || status == 504                   ? Exit::NoServer
                      : status >= 500                                    ? Exit::Unexpected
                      : problem.value("code", "") == "invalid-parameter" ? Exit::Usage
                                                                         : Exit::BadFile;
    if (problem.empty()) return {code, "HTTP status " + std::to_string(status)};
    return {code, describe(problem)};
}

/// Whether the same request may succeed later.
bool is_passing(int status, const json& problem) {
    return status == 408 || status == 429 || (status >= 502 && status <= 504) ||
           problem.value("code", "") == "idempotency-conflict";
}

/// Seconds before the next try: what the server asks for, else doubling.
double pause_before(int attempt, const std::string& retry_after) {
    const double asked = std::atof(retry_after.c_str());
    return std::min(asked > 0 ? asked : 0.5 * std::pow(2.0, attempt), 60.0);
}

void sleep_for(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        stop_if_interrupted();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
}

std::string random_key() {
    std::random_device random;
    std::string key = "lpf-client-";
    for (int i = 0; i < 32; ++i) key += "0123456789abcdef"[random() % 16];
    return key;
}

}  // namespace

Service::Service(const Access& access, Progress progress)
    : access_(access), progress_(std::move(progress)) {
    const auto scheme = access_.url.find("://");
    if (scheme == std::string::npos) throw Failure(Exit::Usage, "the URL must begin with http://");
    const auto path = access_.url.find('/', scheme + 3);
    if (path == std::string::npos) return;
    base_ = access_.url.substr(path);
    while (!base_.empty() && base_.back() == '/') base_.pop_back();
    access_.url.resize(path);
}

/// Sends until the answer is good, or there is no hope.
httplib::Response Service::request(const Send& send) {
    for (int attempt = 0;; ++attempt) {
        stop_if_interrupted();
        httplib::Client client(access_.url);
        if (!client.is_valid()) throw Failure(Exit::Usage, access_.url + " is no address");
        client.set_connection_timeout(10);
        client.set_read_timeout(60);
        client.set_write_timeout(60);
        if (!access_.api_key.empty()) client.set_bearer_token_auth(access_.api_key.c_str());
        const httplib::Result result = send(client);
        stop_if_interrupted();
        if (result && result->status < 400) return *result;
        const json problem = result ? parse(result->body) : json();
        const Failure failure =
            result ? failure_of(result->status, problem)
                   : Failure(Exit::NoServer, access_.url + " does not answer (" +
                                                 httplib::to_string(result.error()) + ")");
        if (attempt >= access_.retries || (result && !is_passing(result->status, problem))) {
            throw failure;
        }
        sleep_for(pause_before(attempt, result ? result->get_header_value("Retry-After") : ""));
    }
}

json Service::get(const std::string& path, const std::string& prefer) {
    httplib::Headers headers;
    if (!prefer.empty()) headers.emplace("Prefer", prefer);
    return parse(request([&](httplib::Client& client) {
                     return client.Get((base_ + path).c_str(), headers);
                 }).body);
}

/// Asks before the upload what would be refused in its middle, where httplib loses the answer.
void Service::check_upload(const std::string& path) {
    const std::uint64_t size = Upload(path).size();
    const json limits = get("/v1/info").value("limits", json::object());
    const std::uint64_t limit = limits.value("uploadBytes", std::uint64_t{0});
    if (limit != 0 && size > limit) {
        throw Failure(Exit::BadFile, path + " has " + std::to_string(size) +
                                         " bytes; the server takes " + std::to_string(limit));
    }
}

std::string Service::submit(const std::string& process, const std::string& path,
                            const std::multimap<std::string, std::string>& inputs) {
    check_upload(path);
    Upload file(path);
    const httplib::Headers headers{{"Idempotency-Key", random_key()}};
    const std::string target =
        httplib::append_query_params((base_ + "/v1/processes/" + process + "/execution").c_str(),
                                     httplib::Params(inputs.begin(), inputs.end()));
    const auto provide = [&](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        const std::string block = file.read(offset, length);
        if (block.empty() || interrupted) return false;
        progress_("upload", 100.0 * double(offset + block.size()) / double(file.size()), "");
        return sink.write(block.data(), block.size());
    };
    const auto answer = request([&](httplib::Client& client) {
        return client.Post(target.c_str(), headers, static_cast<std::size_t>(file.size()), provide,
                           "application/octet-stream");
    });
    const std::string job = parse(answer.body).value("jobID", "");
    if (job.empty()) throw Failure(Exit::Unexpected, "The answer names no job");
    return job;
}

void Service::follow(const std::string& job) {
    while (true) {
        // The server holds its answer back until the job ends, or the second is over.
        const json state = get("/v1/jobs/" + job, "wait=1");
        const std::string status = state.value("status", "");
        progress_(state.value("processID", "job"), state.value("progress", 0.0),
                  status == "running" ? state.value("phase", status) : status);
        if (status == "successful") return;
        if (status == "failed" || status == "dismissed") {
            throw Failure(Exit::JobFailed, describe(state.value("exception", json::object())));
        }
        sleep_for(0.1);  // also when the server answers at once
    }
}

void Service::save_result(const std::string& job, const std::string& name,
                          const std::string& path) {
    const json results = get("/v1/jobs/" + job + "/results");
    if (!results.contains(name)) throw Failure(Exit::BadFile, "The job has no " + name);
    Download file(path);
    fetch(results.at(name), file);
    file.keep(results.at(name).value("sha256", ""));
}

/// Reads an entry of a job's results, going on where a broken connection stopped.
void Service::fetch(const json& result, Download& file) {
    const double size = std::max(result.value("bytes", 1.0), 1.0);
    request([&](httplib::Client& client) {
        httplib::Headers headers;
        if (file.size() > 0) {
            headers.emplace("Range", "bytes=" + std::to_string(file.size()) + "-");
            headers.emplace("If-Range", '"' + result.value("sha256", "") + '"');
        }
        int status = 0;
        std::string refusal;
        const auto begin = [&](const httplib::Response& response) {
            status = response.status;
            if (status == 200) file.restart();
            return true;
        };
        const auto take = [&](const char* data, std::size_t length) {
            if (status >= 400) {
                refusal.append(data, length);
                return true;
            }
            file.write(data, length);
            progress_("download", std::min(100.0, 100 * double(file.size()) / size), "");
            return !interrupted;
        };
        auto answer = client.Get((base_ + result.value("href", "")).c_str(), headers, begin, take);
        if (answer) answer->body = refusal;
        return answer;
    });
}

void Service::cancel(const std::string& job) {
    request([&](httplib::Client& client) {
        return client.Delete((base_ + "/v1/jobs/" + job).c_str());
    });
}

}  // namespace lpf_client
