#include "server/config.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

CommandLine parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "lpf-server");
    return parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

TEST(Config, DefaultsListenOnTheLoopbackOnly) {
    const CommandLine line = parse({});
    EXPECT_FALSE(line.exit_code);
    EXPECT_EQ(line.config.host, "127.0.0.1");
    EXPECT_EQ(line.config.port, 8080);
    EXPECT_EQ(line.config.admin_port, 8081);
    EXPECT_EQ(line.config.limits.upload_bytes, 512ULL << 20);
}

TEST(Config, FlagsSetFields) {
    const Config config = parse({"--port", "0", "--data-dir", "/x", "--max-upload-bytes", "1000",
                                 "--jobs", "3", "--threads", "2", "--log-level", "warn"})
                              .config;
    EXPECT_EQ(config.port, 0);
    EXPECT_EQ(config.data_dir, "/x");
    EXPECT_EQ(config.limits.upload_bytes, 1000U);
    EXPECT_EQ(config.jobs, 3);
    EXPECT_EQ(config.threads, 2);
    EXPECT_EQ(config.log_level, LogLevel::Warn);
}

TEST(Config, FlagWinsOverEnvironmentAndEnvironmentOverFile) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "lpf.conf";
    write(file, "port = 1111\nadmin-port = 2222\njobs = 5\n");
    ::setenv("LPF_PORT", "3333", 1);
    ::setenv("LPF_ADMIN_PORT", "4444", 1);
    const Config config = parse({"--config", file.c_str(), "--admin-port", "5555"}).config;
    ::unsetenv("LPF_PORT");
    ::unsetenv("LPF_ADMIN_PORT");
    EXPECT_EQ(config.port, 3333);
    EXPECT_EQ(config.admin_port, 5555);
    EXPECT_EQ(config.jobs, 5);
}

TEST(Config, ListsComeFromSeveralFlagsOrOneVariable) {
    const auto origins = parse({"--cors-origin", "https://a.example", "--cors-origin",
                                "https://b.example,https://c.example"})
                             .config.cors_origins;
    EXPECT_EQ(origins, (std::vector<std::string>{"https://a.example", "https://b.example",
                                                 "https://c.example"}));
    ::setenv("LPF_TRUSTED_PROXY", "10.0.0.1,10.0.0.2", 1);
    const auto proxies = parse({}).config.trusted_proxies;
    const auto flagged = parse({"--trusted-proxy", "10.0.0.3"}).config.trusted_proxies;
    ::unsetenv("LPF_TRUSTED_PROXY");
    EXPECT_EQ(proxies, (std::vector<std::string>{"10.0.0.1", "10.0.0.2"}));
    EXPECT_EQ(flagged, (std::vector<std::string>{"10.0.0.3"}));
}

TEST(Config, NobodyIsKnownOrTrustedByDefault) {
    const Config config = parse({}).config;
    EXPECT_TRUE(config.api_key_file.empty());
    EXPECT_TRUE(config.cors_origins.empty());
    EXPECT_TRUE(config.trusted_proxies.empty());
}

TEST(Config, EnvironmentSetsLimits) {
    ::setenv("LPF_MAX_QUEUED_JOBS", "7", 1);
    const Config config = parse({}).config;
    ::unsetenv("LPF_MAX_QUEUED_JOBS");
    EXPECT_EQ(config.limits.queued_jobs, 7U);
}

TEST(Config, MistakesEndTheProgramWithTwo) {
    EXPECT_EQ(parse({"--no-such-flag"}).exit_code, 2);
    EXPECT_EQ(parse({"--port", "70000"}).exit_code, 2);
    EXPECT_EQ(parse({"--port", "many"}).exit_code, 2);
    EXPECT_EQ(parse({"--log-level", "loud"}).exit_code, 2);
    EXPECT_EQ(parse({"--config", "/nowhere/lpf.conf"}).exit_code, 2);
}

TEST(Config, HelpAndVersionEndTheProgramWithZero) {
    EXPECT_EQ(parse({"--help"}).exit_code, 0);
    EXPECT_EQ(parse({"--version"}).exit_code, 0);
}

TEST(Config, LimitFlagsFollowTheNamesOnTheWire) {
    EXPECT_EQ(limit_flag("uploadBytes"), "--max-upload-bytes");
    EXPECT_EQ(limit_flag("diskFloorBytes"), "--disk-floor-bytes");
    EXPECT_EQ(limit_flag("resultRetentionSeconds"), "--result-retention-seconds");
}

struct ThreadCase {
    const char* name;
    int jobs, threads, cores, expected_jobs, expected_threads;
};

class ThreadSharing : public testing::TestWithParam<ThreadCase> {};

TEST_P(ThreadSharing, NeverUsesMoreThanTheCores) {
    const ThreadCase& c = GetParam();
    Config config;
    config.jobs = c.jobs;
    config.threads = c.threads;
    config = resolve_threads(config, c.cores);
    EXPECT_EQ(config.jobs, c.expected_jobs);
    EXPECT_EQ(config.threads, c.expected_threads);
    EXPECT_LE(config.jobs * config.threads, c.cores);
    EXPECT_GE(config.http_threads, 16);
}

INSTANTIATE_TEST_SUITE_P(All, ThreadSharing,
                         testing::Values(ThreadCase{"OneCore", 0, 0, 1, 1, 1},
                                         ThreadCase{"TwoCores", 0, 0, 2, 1, 2},
                                         ThreadCase{"EightCores", 0, 0, 8, 2, 4},
                                         ThreadCase{"ThreadsGiven", 0, 2, 8, 4, 2},
                                         ThreadCase{"JobsGiven", 4, 0, 8, 4, 2},
                                         ThreadCase{"TooManyAsked", 100, 100, 4, 4, 1}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Config, TheMemoryBudgetLeavesRoomForTheServerItself) {
    constexpr std::uint64_t kMib = 1ULL << 20;
    EXPECT_EQ(resolve_memory({}, 512 * kMib).limits.memory_bytes, 256 * kMib);
    EXPECT_EQ(resolve_memory({}, 8192 * kMib).limits.memory_bytes, 6144 * kMib);
    EXPECT_EQ(resolve_memory({}, 128 * kMib).limits.memory_bytes, 32 * kMib);
    Config chosen;
    chosen.limits.memory_bytes = 5 * kMib;
    EXPECT_EQ(resolve_memory(chosen, 512 * kMib).limits.memory_bytes, 5 * kMib);
}

TEST(Config, RequestsDecodeInTheMemoryThatJobsLeave) {
    constexpr std::uint64_t kMib = 1ULL << 20;
    EXPECT_EQ(resolve_memory({}, 512 * kMib).decoding_bytes, 192 * kMib);
    Config greedy;
    greedy.limits.memory_bytes = 1024 * kMib;
    EXPECT_EQ(resolve_memory(greedy, 512 * kMib).decoding_bytes, 64 * kMib);
}

}  // namespace
}  // namespace lpf::server
