#include "server/gate/gate.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

const std::string kKey = "correct-horse-battery-staple";

class GateTest : public testing::Test {
protected:
    GateTest() {
        config_.limits.requests_per_second = 1;
        config_.limits.request_burst = 5;
        config_.limits.uploads_per_second = 1;
        config_.limits.upload_burst = 2;
    }

    void demand_keys() {
        config_.api_key_file = folder_.path() / "keys";
        std::ofstream(config_.api_key_file) << gate::ApiKeys::line("lab", kKey) << "\n";
    }

    http::Response ask(const std::string& method, const std::string& path,
                       http::Fields headers = {}, const std::string& client = "192.0.2.1") {
        if (!gate_) gate_ = std::make_unique<Gate>(config_, log_);
        http::Request request;
        request.method = method;
        request.path = path;
        request.client = client;
        request.headers = std::move(headers);
        auto response = gate_->pass(request, [] {
            http::Response passed;
            passed.status = 204;
            return passed;
        });
        seen_ = request;
        return response;
    }

    static http::Fields with_key(const std::string& key) {
        return {{"authorization", "Bearer " + key}};
    }

    TemporaryFolder folder_;
    Config config_;
    std::string lines_;
    Log log_{LogLevel::Info, [this](const std::string& line) { lines_ += line; }};
    std::unique_ptr<Gate> gate_;
    http::Request seen_;
};

TEST_F(GateTest, WithoutAKeyFileEverybodyComesIn) {
    EXPECT_EQ(ask("GET", "/v1/jobs").status, 204);
    EXPECT_TRUE(seen_.key.empty());
    EXPECT_EQ(seen_.client, "192.0.2.1");
}

TEST_F(GateTest, AKeyIsAskedForAndKnownByItsName) {
    demand_keys();
    const auto refused = ask("GET", "/v1/jobs");
    EXPECT_EQ(refused.status, 401);
    EXPECT_EQ(refused.content_type, "application/problem+json");
    EXPECT_EQ(refused.header("WWW-Authenticate"), "Bearer realm=\"lpf\"");
    const auto wrong = ask("GET", "/v1/jobs", with_key(kKey + "x"));
    EXPECT_EQ(wrong.status, 401);
    EXPECT_EQ(wrong.header("WWW-Authenticate"), "Bearer realm=\"lpf\", error=\"invalid_token\"");
    EXPECT_EQ(wrong.body.find(kKey), std::string::npos);
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey)).status, 204);
    EXPECT_EQ(seen_.key, "lab");
}

TEST_F(GateTest, HealthPreflightsAndThePageNeedNoKey) {
    demand_keys();
    for (const char* path : {"/healthz", "/", "/app.js", "/v10"})
        EXPECT_EQ(ask("GET", path).status, 204) << path;
    EXPECT_EQ(ask("OPTIONS", "/v1/jobs").status, 204);
    for (const char* path : {"/v1", "/v1/", "/v1/info"}) EXPECT_EQ(ask("GET", path).status, 401);
}

TEST_F(GateTest, AReloadTakesNewKeysAndNoWrongOnes) {
    demand_keys();
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey)).status, 204);
    std::ofstream(config_.api_key_file) << "nonsense\n";
    gate_->reload();
    EXPECT_NE(lines_.find("api-keys-kept"), std::string::npos);
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey)).status, 204);
    std::ofstream(config_.api_key_file) << gate::ApiKeys::line("b", "the-key-of-next-year") << "\n";
    gate_->reload();
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey)).status, 401);
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key("the-key-of-next-year")).status, 204);
}

TEST_F(GateTest, TooManyRequestsAreToldWhenToTryAgain) {
    for (int left = 4; left >= 0; --left) {
        const auto answer = ask("GET", "/v1/jobs");
        EXPECT_EQ(answer.status, 204);
        EXPECT_EQ(answer.header("RateLimit-Limit"), "5");
        EXPECT_EQ(answer.header("RateLimit-Remaining"), std::to_string(left));
    }
    const auto refused = ask("GET", "/v1/jobs");
    EXPECT_EQ(refused.status, 429);
    EXPECT_EQ(refused.header("Retry-After"), "1");
    EXPECT_EQ(refused.header("RateLimit-Remaining"), "0");
    EXPECT_EQ(nlohmann::json::parse(refused.body)["limit"], "requestsPerSecond");
    EXPECT_EQ(refused.problem, "rate-limited");
    EXPECT_EQ(ask("GET", "/v1/jobs", {}, "192.0.2.2").status, 204);
    EXPECT_EQ(ask("GET", "/healthz").status, 204);
}

TEST_F(GateTest, UploadsHaveABucketOfTheirOwn) {
    EXPECT_EQ(ask("POST", "/v1/shapes").status, 204);
    EXPECT_EQ(ask("POST", "/v1/shapes").status, 204);
    const auto refused = ask("POST", "/v1/shapes");
    EXPECT_EQ(refused.status, 429);
    EXPECT_EQ(nlohmann::json::parse(refused.body)["limit"], "uploadsPerSecond");
    EXPECT_EQ(ask("GET", "/v1/jobs").status, 204);
}

TEST_F(GateTest, ThisMachineIsNotLimitedWithoutKeys) {
    for (int i = 0; i < 50; ++i) EXPECT_EQ(ask("POST", "/v1/shapes", {}, "127.0.0.1").status, 204);
}

TEST_F(GateTest, AKeyIsLimitedWhereverItComesFrom) {
    demand_keys();
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey), "127.0.0." + std::to_string(i)).status,
                  204);
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey), "127.0.0.9").status, 429);
}

TEST_F(GateTest, WhoGuessesKeysIsSlowedDown) {
    demand_keys();
    for (int i = 0; i < 5; ++i) EXPECT_EQ(ask("GET", "/v1/jobs", with_key("guess")).status, 401);
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key("guess")).status, 429);
    EXPECT_EQ(ask("GET", "/v1/jobs", with_key(kKey)).status, 204);
}

TEST_F(GateTest, BehindATrustedProxyEveryClientHasABucket) {
    config_.trusted_proxies = {"10.0.0.1"};
    const auto through = [&](const std::string& client) {
        return ask("POST", "/v1/shapes", {{"x-forwarded-for", client}}, "10.0.0.1").status;
    };
    EXPECT_EQ(through("198.51.100.1"), 204);
    EXPECT_EQ(through("198.51.100.1"), 204);
    EXPECT_EQ(through("198.51.100.1"), 429);
    EXPECT_EQ(through("198.51.100.2"), 204);
    EXPECT_EQ(seen_.client, "198.51.100.2");
    EXPECT_EQ(ask("POST", "/v1/shapes", {{"x-forwarded-for", "198.51.100.9"}}).status, 204);
    EXPECT_EQ(seen_.client, "192.0.2.1");
}

TEST_F(GateTest, ForeignPagesAreRefusedWithoutCorsHeaders) {
    const http::Fields page{{"host", "127.0.0.1"}, {"origin", "https://evil.example"}};
    const auto refused = ask("POST", "/v1/shapes", page);
    EXPECT_EQ(refused.status, 403);
    EXPECT_EQ(refused.problem, "forbidden");
    EXPECT_FALSE(refused.header("Access-Control-Allow-Origin"));
}

TEST_F(GateTest, RefusalsReachANamedPage) {
    demand_keys();
    config_.cors_origins = {"https://pages.example"};
    const auto refused = ask("POST", "/v1/shapes", {{"origin", "https://pages.example"}});
    EXPECT_EQ(refused.status, 401);
    EXPECT_EQ(refused.header("Access-Control-Allow-Origin"), "https://pages.example");
}

TEST_F(GateTest, AKeyFileThatAllMayReadIsWarnedOf) {
    demand_keys();
    using std::filesystem::perms;
    std::filesystem::permissions(config_.api_key_file, perms::owner_all | perms::others_read);
    (void)ask("GET", "/v1/jobs");
    EXPECT_NE(lines_.find("api-keys-readable-by-all"), std::string::npos);
}

}  // namespace
}  // namespace lpf::server
