#include "server/app.h"  // first: a macro of httplib.h would break its Eigen

#include <gtest/gtest.h>
#include <httplib.h>

#include <nlohmann/json.hpp>

#include "server/store/sha256.h"
#include "tests/server/example_shapes.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

using nlohmann::json;

/// The whole server, in this process, on free ports.
class AppTest : public testing::Test {
protected:
    void SetUp() override {
        Config config;
        config.port = 0;
        config.admin_port = 0;
        config.data_dir = folder_.path();
        config.limits.disk_floor_bytes = 0;
        config.limits.disk_floor_percent = 0;
        config.limits.upload_bytes = 1'000'000;
        config.limits.queued_jobs = 3;
        app_ = std::make_unique<App>(resolve_threads(config, 2), log_);
        app_->start();
        client_ = std::make_unique<httplib::Client>("127.0.0.1", app_->port());
        client_->set_read_timeout(120);
    }

    httplib::Result execute(const std::string& process, const std::string& query,
                            const std::string& body, const std::string& wait = "60") {
        httplib::Headers headers;
        if (!wait.empty()) headers.emplace("Prefer", "wait=" + wait);
        return client_->Post("/v1/processes/" + process + "/execution" + query, headers, body,
                             "application/x-www-form-urlencoded");
    }

    static std::string code_of(const httplib::Result& result) {
        return json::parse(result->body).value("code", "");
    }

    const std::string square_ = wavy_square(20);
    TemporaryFolder folder_;
    Log log_{LogLevel::Info, [this](const std::string& line) { lines_ += line; }};
    std::string lines_;
    std::unique_ptr<App> app_;
    std::unique_ptr<httplib::Client> client_;
};

TEST_F(AppTest, TheOneLinerGetsThePointsThemselves) {
    const auto result = execute("denoise", "", square_);
    ASSERT_EQ(result->status, 200) << result->body;
    EXPECT_EQ(result->get_header_value("Content-Type"), "application/ply");
    EXPECT_EQ(result->get_header_value("Preference-Applied"), "wait=60");
    EXPECT_NE(result->body.find("element vertex 400"), std::string::npos);
    EXPECT_EQ(client_->Get(result->get_header_value("Location"))->status, 200);
}

TEST_F(AppTest, WithoutAWaitAJobIsCreated) {
    const auto result = execute("analyze", "?atoms=4", square_, "");
    ASSERT_EQ(result->status, 201) << result->body;
    const auto info = json::parse(result->body);
    EXPECT_EQ(info["status"], "accepted");
    EXPECT_EQ(info["parameters"]["atoms"], 4);
    EXPECT_EQ(result->get_header_value("Location"), "/v1/jobs/" + info["jobID"].get<std::string>());
}

TEST_F(AppTest, AMistypedInputIsRefusedAndNothingIsStored) {
    const auto result = execute("denoise", "?raduis=1", square_);
    EXPECT_EQ(result->status, 422);
    EXPECT_EQ(json::parse(result->body)["errors"][0]["pointer"], "/inputs/raduis");
    EXPECT_TRUE(json::parse(client_->Get("/v1/jobs")->body)["jobs"].empty());
}

TEST_F(AppTest, ABadFileIsRefusedAtThePost) {
    EXPECT_EQ(code_of(execute("denoise", "", "OFF\n1 0 0\n")), "unsupported-format");
    EXPECT_EQ(code_of(execute("denoise", "", square_.substr(0, 400))), "malformed-file");
    EXPECT_EQ(client_->Get("/healthz")->status, 200);
}

TEST_F(AppTest, AFormCarriesFileAndInputs) {
    const httplib::MultipartFormDataItems items{{"file", square_, "scan.ply", ""},
                                                {"format", "drc", "", ""}};
    const auto result =
        client_->Post("/v1/processes/denoise/execution", {{"Prefer", "wait=60"}}, items);
    ASSERT_EQ(result->status, 200) << result->body;
    EXPECT_EQ(result->get_header_value("Content-Type"), "application/vnd.draco");
}

TEST_F(AppTest, AFormWithoutANameIsRefused) {
    const std::string body =
        "--b\r\nContent-Disposition: form-data; filename*=x\r\n\r\nabc\r\n--b--\r\n";
    const auto result =
        client_->Post("/v1/processes/denoise/execution", body, "multipart/form-data; boundary=b");
    EXPECT_EQ(result->status, 400);
}

TEST_F(AppTest, AnUploadedShapeIsUsedByItsId) {
    const auto upload = client_->Post("/v1/shapes", square_, "application/ply");
    ASSERT_EQ(upload->status, 201) << upload->body;
    const auto shape = json::parse(upload->body);
    EXPECT_EQ(shape["points"], 400);
    EXPECT_EQ(shape["sha256"], sha256_of(square_));
    EXPECT_EQ(client_->Post("/v1/shapes", square_, "application/ply")->status, 200);
    const json body{{"inputs", {{"shape", shape["id"]}}}};
    const auto job = client_->Post("/v1/processes/analyze/execution", {{"Prefer", "wait=60"}},
                                   body.dump(), "application/json");
    ASSERT_EQ(job->status, 200) << job->body;
    EXPECT_TRUE(json::parse(job->body).contains("dictionary"));
    const std::string path = "/v1/shapes/" + shape["id"].get<std::string>();
    EXPECT_EQ(client_->Get(path + "/data")->body, square_);
    EXPECT_EQ(client_->Delete(path)->status, 204);
    EXPECT_EQ(client_->Get(path)->status, 404);
}

TEST_F(AppTest, ResultsAreConvertedOnRequest) {
    const auto job = execute("denoise", "", square_);
    const std::string points = job->get_header_value("Location") + "/results/points";
    EXPECT_TRUE(client_->Get(points + "?format=drc")->body.starts_with("DRACO"));
    const auto accepted = client_->Get(points, {{"Accept", "application/vnd.draco"}});
    EXPECT_TRUE(accepted->body.starts_with("DRACO"));
    EXPECT_NE(client_->Get(points + "?format=ply-ascii")->body.find("ascii 1.0"),
              std::string::npos);
    EXPECT_EQ(client_->Get(points + "?format=stl")->status, 422);
    EXPECT_EQ(client_->Get(points, {{"Accept", "image/png"}})->status, 406);
}

TEST_F(AppTest, ResultsHaveTagsRangesAndHeads) {
    const auto job = execute("denoise", "", square_);
    const std::string points = job->get_header_value("Location") + "/results/points";
    const auto whole = client_->Get(points);
    const std::string tag = whole->get_header_value("ETag");
    EXPECT_EQ(tag, "\"" + sha256_of(whole->body) + "\"");
    EXPECT_EQ(client_->Get(points, {{"If-None-Match", tag}})->status, 304);
    const auto part = client_->Get(points, {{"Range", "bytes=0-2"}});
    EXPECT_EQ(part->status, 206);
    EXPECT_EQ(part->body, "ply");
    EXPECT_EQ(client_->Get(points, {{"Range", "bytes=99999999-"}})->status, 416);
    const auto head = client_->Head(points);
    EXPECT_EQ(head->get_header_value("Content-Length"), std::to_string(whole->body.size()));
    EXPECT_TRUE(head->body.empty());
}

TEST_F(AppTest, ADismissedJobIsGone) {
    const auto job = execute("denoise", "", square_);
    const std::string path = job->get_header_value("Location");
    EXPECT_EQ(json::parse(client_->Delete(path)->body)["status"], "dismissed");
    EXPECT_EQ(client_->Get(path)->status, 410);
    EXPECT_EQ(client_->Get(path + "/results/points")->status, 410);
    EXPECT_EQ(client_->Delete(path)->status, 410);
}

TEST_F(AppTest, BodiesOverTheLimitAre413) {
    const std::string large(1'100'000, 'a');
    EXPECT_EQ(client_->Post("/v1/shapes", large, "application/ply")->status, 413);
    const auto chunked = client_->Post(
        "/v1/shapes",
        [&](size_t offset, httplib::DataSink& sink) {
            if (offset >= large.size()) {
                sink.done();
                return true;
            }
            return sink.write(large.data(), 10'000);
        },
        "application/ply");
    ASSERT_TRUE(chunked);
    EXPECT_EQ(chunked->status, 413);
}

TEST_F(AppTest, ACompressedBombIsStoppedAtTheLimit) {
    client_->set_compress(true);
    const std::string bomb(20'000'000, 'a');  // a few kilobytes on the wire
    const auto result = client_->Post("/v1/shapes", bomb, "text/plain");
    client_->set_compress(false);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 413);
}

TEST_F(AppTest, UnknownThingsAre404) {
    for (const char* path : {"/v1/nothing", "/v1/jobs/x", "/v1/shapes/x", "/v1/dictionaries/x",
                             "/v1/processes/x", "/etc/passwd", "/v1/jobs/x/results"})
        EXPECT_EQ(client_->Get(path)->status, 404) << path;
}

TEST_F(AppTest, EveryAnswerCarriesItsIdAndSafeHeaders) {
    const auto result = client_->Get("/v1/info", {{"X-Request-Id", "abc-1"}});
    EXPECT_EQ(result->get_header_value("X-Request-Id"), "abc-1");
    EXPECT_EQ(result->get_header_value("X-Content-Type-Options"), "nosniff");
    const auto forged = client_->Get("/v1/info", {{"X-Request-Id", "a b"}});
    EXPECT_NE(forged->get_header_value("X-Request-Id"), "a b");
}

TEST_F(AppTest, TheAdminListenerAnswersOnItsOwnPort) {
    httplib::Client admin("127.0.0.1", app_->admin_port());
    EXPECT_EQ(admin.Get("/healthz")->status, 200);
    EXPECT_EQ(admin.Get("/readyz")->status, 200);
    EXPECT_NE(admin.Get("/metrics")->body.find("lpf_queue_depth 0"), std::string::npos);
    EXPECT_EQ(admin.Get("/v1/jobs")->status, 404);
    EXPECT_EQ(client_->Get("/metrics")->status, 404);
}

TEST_F(AppTest, TheLogHoldsNoFileNamesAndNoQueries) {
    const httplib::MultipartFormDataItems items{{"file", square_, "private-name.ply", ""}};
    client_->Post("/v1/shapes", items);
    client_->Get("/v1/jobs?limit=17");
    app_->stop();
    EXPECT_NE(lines_.find("/v1/shapes"), std::string::npos);
    EXPECT_EQ(lines_.find("private-name"), std::string::npos);
    EXPECT_EQ(lines_.find("limit=17"), std::string::npos);
}

TEST_F(AppTest, TheRootIsAPageUnderAStrictPolicy) {
    const auto page = client_->Get("/");
    EXPECT_EQ(page->status, 200);
    EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"),
              std::string::npos);
}

}  // namespace
}  // namespace lpf::server
