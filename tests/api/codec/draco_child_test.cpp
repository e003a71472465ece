#include "api/codec/draco_child.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::HasSubstr;

std::string small_stream() {
    EncodeOptions options;
    options.format = FileFormat::Draco;
    return written(points_with_every_type(), options);
}

/// A program that stands in for the helper and does what a hostile stream makes a decoder do.
class FakeHelper : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("lpf-fake-helper-" + std::to_string(getpid()) + "-" +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] DecodeLimits limits_with(const std::string& script) const {
        const std::filesystem::path program = folder_ / "helper";
        std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        DecodeLimits limits;
        limits.decode_helper = program.string();
        return limits;
    }

    std::filesystem::path folder_;
};

TEST(DecodeHelper, LiesBesideTheProgram) {
    EXPECT_THAT(DecodeLimits::default_decode_helper(), testing::EndsWith("/lpf-decode"));
}

TEST(DecodeHelper, DecodesFromSeveralThreadsAtOnce) {
    const std::string file = small_stream();
    std::atomic<int> good = 0;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 8; ++i) {
            threads.emplace_back([&] { good += read(file).shape.size() == 4 ? 1 : 0; });
        }
    }
    EXPECT_EQ(good, 8);
}

TEST(DecodeHelper, LeavesNoDescriptorOpen) {
    const auto open_files = [] {
        std::size_t n = 0;
        for ([[maybe_unused]] const auto& entry :
             std::filesystem::directory_iterator("/proc/self/fd")) {
            ++n;
        }
        return n;
    };
    const std::string file = small_stream();
    (void)read(file);
    const std::size_t before = open_files();
    for (int i = 0; i < 5; ++i) {
        (void)read(file);
        (void)refusal(file.substr(0, file.size() - 9));
    }
    EXPECT_EQ(open_files(), before);
}

TEST_F(FakeHelper, CrashIsARefusal) {
    const auto error = refusal(small_stream(), limits_with("kill -SEGV $$"));
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::MalformedFile);
    EXPECT_THAT(error->what(), HasSubstr("crashed"));
}

TEST_F(FakeHelper, ProcessorLimitIsARefusal) {
    const auto error = refusal(small_stream(), limits_with("ulimit -t 1; while :; do :; done"));
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
    EXPECT_THAT(error->what(), HasSubstr("processor time"));
}

TEST_F(FakeHelper, OutOfMemoryIsARefusal) {
    const auto code = std::to_string(static_cast<int>(ErrorCode::OutOfMemory));
    const auto error =
        refusal(small_stream(), limits_with("echo " + code + " >&2; echo none >&2; exit 3"));
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
    EXPECT_THAT(error->what(), HasSubstr("MiB"));
}

TEST_F(FakeHelper, NonsenseIsARefusal) {
    for (const char* script : {"echo hello", "exit 3", "exit 42", "exit 0"}) {
        const auto error = refusal(small_stream(), limits_with(script));
        ASSERT_TRUE(error.has_value()) << script;
        EXPECT_EQ(error->code(), ErrorCode::MalformedFile) << script;
    }
}

TEST_F(FakeHelper, SeesNeitherTheEnvironmentNorOpenFiles) {
    std::ofstream secret(folder_ / "secret");
    const auto error = refusal(
        small_stream(),
        limits_with("if [ -z \"$HOME\" ] && [ ! -e /proc/self/fd/4 ]; then kill -SEGV $$; fi"));
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("crashed"));
}

TEST(DecodeHelper, MissingProgramIsAnInternalError) {
    DecodeLimits limits;
    limits.decode_helper = "/nonexistent/lpf-decode";
    const auto error = refusal(small_stream(), limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::Internal);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(DecodeHelper, KeepsToItsMemory) {
    DecodeLimits limits;
    limits.helper_memory_bytes = 8 << 20;
    const auto error = refusal(small_stream(), limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_NE(error->code(), ErrorCode::Internal);
}
#endif

}  // namespace
}  // namespace lpf
