// Reading and writing of large files ends soon after it was told to, in the helper as well.

#include "tests/support/stopping.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "api/codec/draco.h"
#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using namespace std::chrono_literals;

constexpr double kSoon = 0.5;  // seconds
constexpr Eigen::Index kPoints = 400'000;

Document large_mesh() {
    Document document;
    document.shape.cloud.points = Points::Random(3, kPoints).cast<float>().cast<double>();
    document.shape.cloud.attributes = {
        column("intensity", ScalarType::Float32, std::vector<float>(kPoints, 0.5F))};
    document.shape.triangles = Triangles::Zero(3, kPoints);
    return document;
}

EncodeOptions as(FileFormat format) {
    EncodeOptions options;
    options.format = format;
    return options;
}

class CodecStopping : public testing::TestWithParam<FileFormat> {};

TEST_P(CodecStopping, EndsReadingSoon) {
    const std::string file = written(large_mesh(), as(GetParam()));
    for (const auto delay : {0ms, 5ms, 30ms, 100ms}) {
        const auto seconds = time_to_stop(delay, [&](const Execution& execution) {
            (void)decode(bytes_of(file), {}, execution);
        });
        if (!seconds) break;
        EXPECT_LT(seconds->count(), kSoon) << delay.count() << " ms after the start";
    }
}

TEST_P(CodecStopping, EndsWritingSoon) {
    const Document document = large_mesh();
    std::vector<Warning> lost;
    for (const auto delay : {0ms, 5ms, 30ms, 100ms}) {
        const auto seconds = time_to_stop(delay, [&](const Execution& execution) {
            (void)encode(document, as(GetParam()), lost, execution);
        });
        if (!seconds) break;
        EXPECT_LT(seconds->count(), kSoon) << delay.count() << " ms after the start";
    }
}

TEST_P(CodecStopping, AsksBeforeItIsDone) {
    std::stop_source fired;
    fired.request_stop();
    const Execution stopped{.threads = 1, .stop = fired.get_token()};
    const std::string file = written(points_with_every_type(), as(GetParam()));
    EXPECT_THROW((void)decode(bytes_of(file), {}, stopped), Error);
    std::vector<Warning> lost;
    EXPECT_THROW((void)encode(points_with_every_type(), as(GetParam()), lost, stopped), Error);
}

TEST_P(CodecStopping, ProgressRisesAndNamesThePhase) {
    const Document document = large_mesh();
    std::vector<std::string> phases;
    double last = 0;
    const Execution watched{.threads = 1, .stop = {}, .progress = [&](const Progress& progress) {
                                EXPECT_GE(progress.fraction, last);
                                last = progress.fraction;
                                phases.emplace_back(progress.phase);
                            }};
    std::vector<Warning> lost;
    const std::string file = encode(document, as(GetParam()), lost, watched);
    ASSERT_FALSE(phases.empty());
    EXPECT_EQ(phases.back(), "encode");
    last = 0;
    (void)decode(bytes_of(file), {}, watched);
    EXPECT_EQ(phases.back(), "decode");
}

INSTANTIATE_TEST_SUITE_P(Formats, CodecStopping, testing::ValuesIn(all_formats()),
                         [](const auto& test) {
                             std::string name(format_name(test.param));
                             std::erase(name, '-');
                             return name;
                         });

TEST(Helper, IsKilledAtOnceWhenTheJobIsStopped) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("lpf-slow-helper-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const auto program = folder / "helper";
    std::ofstream(program) << "#!/bin/sh\nwhile :; do :; done\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    DecodeLimits limits;
    limits.decode_helper = program.string();
    const std::string file = written(points_with_every_type(), as(FileFormat::Draco));
    const auto seconds = time_to_stop(200ms, [&](const Execution& execution) {
        (void)decode(bytes_of(file), limits, execution);
    });
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(seconds.has_value());
    EXPECT_LT(seconds->count(), kSoon);
}

TEST(Helper, EncodesWhatEncodingHereGives) {
    Document document = large_mesh();
    document.shape.cloud.points(0, 0) += 1e-12;
    document.double_positions = true;
    document.comments = {"a comment", ""};
    document.elements = {{"edge", 1, {column<std::int32_t>("vertex1", ScalarType::Int32, {2})}}};
    for (const int bits : {0, 14}) {
        for (const bool doubles : {false, true}) {
            EncodeOptions options = as(FileFormat::Draco);
            options.quantization_bits = bits;
            options.double_positions = doubles;
            options.comments = {"from a test"};
            std::vector<Warning> lost_here;
            std::vector<Warning> lost_there;
            const std::string here = encode_draco_here(document, options, lost_here);
            EXPECT_TRUE(encode(document, options, lost_there) == here);
            ASSERT_EQ(lost_there.size(), lost_here.size());
            for (std::size_t i = 0; i < lost_here.size(); ++i) {
                EXPECT_EQ(lost_there[i].code, lost_here[i].code);
                EXPECT_EQ(lost_there[i].detail, lost_here[i].detail);
            }
        }
    }
}

}  // namespace
}  // namespace lpf
