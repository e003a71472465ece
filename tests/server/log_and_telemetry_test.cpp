#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/log.h"
#include "server/telemetry.h"

namespace lpf::server {
namespace {

TEST(Log, WritesOneJsonObjectALine) {
    std::vector<std::string> lines;
    Log log(LogLevel::Info, [&](const std::string& line) { lines.push_back(line); });
    log.info("started", {{"jobs", 2}, {"seconds", 0.5}, {"text", "a\n\"b\"\xff"}});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].find('\n'), lines[0].size() - 1);
    const auto json = nlohmann::json::parse(lines[0]);
    EXPECT_EQ(json["event"], "started");
    EXPECT_EQ(json["level"], "info");
    EXPECT_EQ(json["jobs"], 2);
    EXPECT_TRUE(json["time"].get<std::string>().ends_with("Z"));
}

TEST(Log, LeavesOutWhatIsBelowItsLevel) {
    int lines = 0;
    Log log(LogLevel::Warn, [&](const std::string&) { ++lines; });
    log.info("small");
    log.warn("large");
    EXPECT_EQ(lines, 1);
}

TEST(Log, LevelsHaveNames) {
    EXPECT_EQ(level_from_name("warn"), LogLevel::Warn);
    EXPECT_FALSE(level_from_name("loud"));
}

TEST(Telemetry, HistogramBucketsAddUp) {
    Histogram histogram;
    for (const double value : {0.001, 0.3, 4.0, 1e9}) histogram.observe(value);
    const std::string text = histogram.text("h", "route=\"x\"");
    EXPECT_NE(text.find("h_bucket{route=\"x\",le=\"0.005\"} 1\n"), std::string::npos);
    EXPECT_NE(text.find("h_bucket{route=\"x\",le=\"0.5\"} 2\n"), std::string::npos);
    EXPECT_NE(text.find("h_bucket{route=\"x\",le=\"+Inf\"} 4\n"), std::string::npos);
    EXPECT_NE(text.find("h_count{route=\"x\"} 4\n"), std::string::npos);
}

TEST(Telemetry, CountsRequestsByRouteAndStatus) {
    Telemetry telemetry("1.2.3");
    telemetry.count_request("GET", "/v1/jobs/{id}", 200, 100, 0.01);
    telemetry.count_request("GET", "/v1/jobs/{id}", 200, 50, 0.01);
    telemetry.count_request("GET", "none", 404, 10, 0.01);
    telemetry.count_received(7);
    telemetry.count_job("denoise", "successful", 2.0);
    Gauges gauges;
    gauges.jobs[JobStatus::Accepted] = 3;
    gauges.queued = 3;
    const std::string text = telemetry.text(gauges);
    for (const char* line :
         {"lpf_build_info{version=\"1.2.3\"} 1\n", "lpf_jobs{status=\"accepted\"} 3\n",
          "lpf_queue_depth 3\n", "lpf_http_received_bytes_total 7\n",
          "lpf_http_requests_total{method=\"GET\",route=\"/v1/jobs/{id}\",status=\"200\"} 2\n",
          "lpf_http_requests_total{method=\"GET\",route=\"none\",status=\"404\"} 1\n",
          "lpf_http_sent_bytes_total 160\n",
          "lpf_job_seconds_count{process=\"denoise\",status=\"successful\"} 1\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(Telemetry, CountsWhatGoesWrong) {
    Telemetry telemetry("1");
    telemetry.count_problem("queue-full");
    telemetry.count_problem("queue-full");
    telemetry.count_lease_loss();
    telemetry.observe_queue_wait(0.02);
    telemetry.observe_phase("analyze", 3.0);
    telemetry.add_event_streams(2);
    telemetry.add_event_streams(-1);
    const std::string text = telemetry.text({});
    for (const char* line :
         {"lpf_problems_total{code=\"queue-full\"} 2\n", "lpf_lease_losses_total 1\n",
          "lpf_queue_wait_seconds_count 1\n", "lpf_phase_seconds_sum{phase=\"analyze\"} 3\n",
          "lpf_event_streams 1\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace lpf::server
