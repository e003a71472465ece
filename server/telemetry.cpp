#include "server/telemetry.h"

#include <sstream>

namespace lpf::server {
namespace {

/// Head of a metric: what it is, for the human who reads the page.
std::string head(const std::string& name, const std::string& type, const std::string& help) {
    return "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
}

std::string number(double value) {
    std::ostringstream out;
    out.precision(12);
    out << value;
    return out.str();
}

std::string line(const std::string& name, const std::string& labels, double value) {
    return name + (labels.empty() ? "" : "{" + labels + "}") + " " + number(value) + "\n";
}

std::string single(const std::string& name, const std::string& type, const std::string& help,
                   double value) {
    return head(name, type, help) + line(name, "", value);
}

std::string label(const std::string& name, std::string_view value) {
    return name + "=\"" + std::string(value) + "\"";
}

std::string gauges_text(const Gauges& gauges) {
    std::string out = head("lpf_jobs", "gauge", "Jobs in the store, by status.");
    for (const auto& [status, count] : gauges.jobs)
        out += line("lpf_jobs", label("status", status_name(status)), static_cast<double>(count));
    out += single("lpf_queue_depth", "gauge", "Jobs that wait for a worker.",
                  static_cast<double>(gauges.queued));
    out += single("lpf_queue_oldest_seconds", "gauge", "Age of the job that waits longest.",
                  gauges.oldest_queued_seconds);
    out += single("lpf_jobs_running", "gauge", "Jobs being worked on.",
                  static_cast<double>(gauges.running));
    out += single("lpf_workers", "gauge", "Jobs that can be worked on at a time.",
                  static_cast<double>(gauges.workers));
    out += single("lpf_uptime_seconds", "gauge", "Time since the start.", gauges.uptime_seconds);
    out += single("lpf_ready", "gauge", "1 while new jobs are taken.", gauges.ready ? 1 : 0);
    return out;
}

}  // namespace

void Histogram::observe(double value) {
    std::size_t i = 0;
    while (i < kBounds.size() && value > kBounds[i]) ++i;
    ++counts_[i];
    sum_ += value;
}

std::string Histogram::text(const std::string& name, const std::string& labels) const {
    const std::string comma = labels.empty() ? "" : ",";
    std::string out;
    std::uint64_t total = 0;
    for (std::size_t i = 0; i <= kBounds.size(); ++i) {
        total += counts_[i];
        const std::string bound = i < kBounds.size() ? number(kBounds[i]) : "+Inf";
        out +=
            line(name + "_bucket", labels + comma + label("le", bound), static_cast<double>(total));
    }
    out += line(name + "_sum", labels, sum_);
    return out + line(name + "_count", labels, static_cast<double>(total));
}

void Telemetry::count_request(const std::string& method, const std::string& route, int status,
                              std::uint64_t bytes_sent, double seconds) {
    const std::lock_guard lock(mutex_);
    ++requests_[{method, route, status}];
    request_seconds_[route].observe(seconds);
    sent_ += bytes_sent;
}

void Telemetry::count_received(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    received_ += bytes;
}

void Telemetry::count_job(std::string_view process, std::string_view status, double seconds) {
    const std::lock_guard lock(mutex_);
    jobs_[{std::string(process), std::string(status)}].observe(seconds);
}

void Telemetry::count_problem(std::string_view code) {
    const std::lock_guard lock(mutex_);
    ++problems_[std::string(code)];
}

void Telemetry::observe_queue_wait(double seconds) {
    const std::lock_guard lock(mutex_);
    queue_wait_.observe(seconds);
}

void Telemetry::observe_phase(std::string_view phase, double seconds) {
    const std::lock_guard lock(mutex_);
    phases_[std::string(phase)].observe(seconds);
}

void Telemetry::observe_cancel(double seconds) {
    const std::lock_guard lock(mutex_);
    cancel_.observe(seconds);
}

void Telemetry::count_lease_loss() {
    const std::lock_guard lock(mutex_);
    ++lease_losses_;
}

void Telemetry::add_event_streams(int change) {
    const std::lock_guard lock(mutex_);
    event_streams_ += change;
}

std::string Telemetry::http_text() const {
    std::string out = head("lpf_http_requests_total", "counter", "Requests answered.");
    for (const auto& [key, count] : requests_) {
        const auto& [method, route, status] = key;
        out += line("lpf_http_requests_total",
                    label("method", method) + "," + label("route", route) + "," +
                        label("status", std::to_string(status)),
                    static_cast<double>(count));
    }
    out += head("lpf_http_request_seconds", "histogram", "Time until the answer was made.");
    for (const auto& [route, histogram] : request_seconds_)
        out += histogram.text("lpf_http_request_seconds", label("route", route));
    out += head("lpf_problems_total", "counter", "Problem documents sent, by code.");
    for (const auto& [code, count] : problems_)
        out += line("lpf_problems_total", label("code", code), static_cast<double>(count));
    out += single("lpf_event_streams", "gauge", "Event streams that clients follow.",
                  static_cast<double>(event_streams_));
    out += single("lpf_http_received_bytes_total", "counter", "Bytes of bodies received.",
                  static_cast<double>(received_));
    return out + single("lpf_http_sent_bytes_total", "counter", "Bytes of bodies sent.",
                        static_cast<double>(sent_));
}

std::string Telemetry::jobs_text() const {
    std::string out = head("lpf_job_seconds", "histogram", "Time that workers spent on jobs.");
    for (const auto& [key, histogram] : jobs_)
        out += histogram.text("lpf_job_seconds",
                              label("process", key.first) + "," + label("status", key.second));
    out += head("lpf_phase_seconds", "histogram", "Time that jobs spent in their phases.");
    for (const auto& [phase, histogram] : phases_)
        out += histogram.text("lpf_phase_seconds", label("phase", phase));
    out += head("lpf_queue_wait_seconds", "histogram", "Time that jobs waited for a worker.") +
           queue_wait_.text("lpf_queue_wait_seconds", "");
    out +=
        head("lpf_cancel_seconds", "histogram", "Time from a dismissal to the end of the work.") +
        cancel_.text("lpf_cancel_seconds", "");
    return out + single("lpf_lease_losses_total", "counter",
                        "Jobs taken from a worker that did not renew its lease in time.",
                        static_cast<double>(lease_losses_));
}

std::string Telemetry::text(const Gauges& gauges) const {
    const std::lock_guard lock(mutex_);
    return head("lpf_build_info", "gauge", "The program that runs.") +
           line("lpf_build_info", label("version", version_), 1) + gauges_text(gauges) +
           http_text() + jobs_text();
}

}  // namespace lpf::server
