#pragma once

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/http/listener.h"
#include "tests/server/http/raw_client.h"
#include "tests/server/temporary_folder.h"

namespace lpf::http {

using server::RawClient;
using server::status_of;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A feed that tells its number of questions, up to `last`.
class CountingFeed : public Feed {
public:
    CountingFeed(int last, std::size_t size) : last_(last), size_(size) {}
    std::string next() override {
        if (count_ == last_) return {};
        return "data: " + std::to_string(++count_) + std::string(size_, ' ') + "\n\n";
    }
    [[nodiscard]] bool ended() const override { return count_ == last_; }

private:
    int last_;
    std::size_t size_;
    int count_ = 0;
};

/// A listener whose handler counts the bytes of a body, and has a few odd paths.
class ListenerTest : public testing::Test {
protected:
    using Watch = std::chrono::steady_clock;
    static constexpr std::size_t kLimit = 100'000;

    void SetUp() override {
        options_.threads = 4;
        options_.queue = 8;
        options_.limits.upload_bytes = kLimit;
        options_.limits.head_seconds = 1;
        options_.limits.body_idle_seconds = 1;
        options_.limits.keep_alive_seconds = 1;
        options_.limits.keep_alive_requests = 3;
        options_.limits.connections_per_client = 0;
        options_.pace = [](const Request& request) {
            return request.path == "/healthz"   ? Pace::AtOnce
                   : request.path == "/convert" ? Pace::Long
                                                : Pace::Quick;
        };
        start();
    }

    void start() {
        listener_ = std::make_unique<Listener>(
            options_, [this](Request& request) { return handle(request); },
            [](const Problem& problem) {
                Response response;
                response.status = problem.status();
                response.content_type = "application/problem+json";
                response.body = problem.detail;
                return response;
            });
        port_ = listener_->start();
    }

    /// For what SetUp has decided otherwise.
    void restart() {
        listener_.reset();
        start();
    }

    Response handle(Request& request) {
        ++requests_;
        Response response;
        response.content_type = "text/plain";
        if (request.path == "/ignore") {
            response.status = 404;
            return response;
        }
        if (request.path == "/throw") throw std::runtime_error("secret");
        if (request.path == "/slow") std::this_thread::sleep_for(milliseconds(400));
        if (request.path == "/convert") std::this_thread::sleep_for(milliseconds(400));
        if (request.path == "/wait")
            for (int i = 0; i < 100 && !request.abandoned(); ++i)
                std::this_thread::sleep_for(milliseconds(10));
        if (request.path == "/events") response.feed = std::make_shared<CountingFeed>(3, 0);
        if (request.path == "/endless")
            response.feed = std::make_shared<CountingFeed>(1'000'000'000, 50'000);
        if (request.path == "/file") {
            response.content_type = "application/octet-stream";
            response.file = FileSlice{file_, 0, std::filesystem::file_size(file_)};
            return response;
        }
        if (request.path == "/big") {
            response.content_type = "application/octet-stream";
            response.body = std::string(30'000'000, 'b');
            return response;
        }
        if (request.path == "/form") return form(request);
        std::size_t bytes = 0;
        try {
            const bool complete = request.read_body([&](std::string_view piece) {
                bytes += piece.size();
                return true;
            });
            response.status = complete ? 200 : 400;
        } catch (const ProblemException& error) {
            response.status = error.problem().status();
        }
        response.body = request.method + " " + request.path + " " + std::to_string(bytes);
        return response;
    }

    static Response form(Request& request) {
        Response response;
        response.content_type = "text/plain";
        try {
            (void)request.read_multipart(
                [&](const Part& part) {
                    response.body += "[" + part.name + "]";
                    return true;
                },
                [&](std::string_view bytes) {
                    response.body += bytes;
                    return true;
                });
        } catch (const ProblemException& error) {
            response.status = error.problem().status();
        }
        return response;
    }

    [[nodiscard]] std::string ask(const std::string& text) const {
        return RawClient(port_).ask(text);
    }

    /// Time until a plain request is answered.
    [[nodiscard]] Watch::duration time_of_a_get() const {
        const auto begin = Watch::now();
        EXPECT_EQ(status_of(ask(get("/"))), 200);
        return Watch::now() - begin;
    }

    static std::string get(const std::string& path, const std::string& fields = "") {
        return "GET " + path + " HTTP/1.1\r\nHost: h\r\n" + fields + "\r\n";
    }

    static std::string post(const std::string& path, const std::string& fields,
                            const std::string& body) {
        return "POST " + path + " HTTP/1.1\r\nHost: h\r\n" + fields + "\r\n" + body;
    }

    static std::string chunk(const std::string& data) {
        std::array<char, 32> size{};
        std::snprintf(size.data(), size.size(), "%zx\r\n", data.size());
        return size.data() + data + "\r\n";
    }

    ListenerOptions options_;
    std::filesystem::path file_;
    std::atomic<int> requests_ = 0;
    std::unique_ptr<Listener> listener_;
    int port_ = 0;
};

}  // namespace lpf::http
