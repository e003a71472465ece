#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace httplib {
class Client;
class Result;
struct Response;
}  // namespace httplib

namespace lpf_client {

class Download;

/// Where the service is, and how patient the client.
struct Access {
    std::string url = "http://127.0.0.1:8080";
    std::string api_key;
    int retries = 5;
};

/// What is going on, in per cent, with a note; called often.
using Progress = std::function<void(const std::string& what, double percent, const std::string&)>;

/// One LPF server. Everything that fails throws Failure.
class Service {
public:
    Service(const Access& access, Progress progress);

    /// Uploads a file as a job and gives the job's ID. Sent again after a failure, it carries the
    /// same Idempotency-Key and makes no second job.
    std::string submit(const std::string& process, const std::string& path,
                       const std::multimap<std::string, std::string>& inputs);

    /// Waits until the job is successful.
    void follow(const std::string& job);

    /// Writes points, dictionary, report or fields to a file, whole or not at all.
    void save_result(const std::string& job, const std::string& name, const std::string& path);

    void cancel(const std::string& job);

private:
    using Send = std::function<httplib::Result(httplib::Client&)>;

    httplib::Response request(const Send& send);
    nlohmann::json get(const std::string& path, const std::string& prefer = {});
    void fetch(const nlohmann::json& result, Download& file);
    void check_upload(const std::string& path);

    Access access_;
    std::string base_;  // path under which the service lies, "" for most
    Progress progress_;
};

}  // namespace lpf_client
