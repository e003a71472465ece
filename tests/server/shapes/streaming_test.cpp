#include "server/shapes/streaming.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "server/shapes/subject.h"
#include "tests/server/example_shapes.h"
#include "tests/server/runner_fixture.h"

namespace lpf::server {
namespace {

constexpr int kSide = 24;
constexpr std::size_t kPoints = std::size_t{kSide} * kSide;

/// The wavy square as a binary file, with one point that is not finite and one that is there twice.
std::string odd_square() {
    const std::string text = wavy_square(kSide);
    Document document = decode(std::as_bytes(std::span(text)));
    document.shape.cloud.points.col(100) = document.shape.cloud.points.col(101);
    document.shape.cloud.points(2, 7) = std::numeric_limits<double>::infinity();
    std::vector<Warning> lost;
    return encode(document, {.format = FileFormat::PlyBinary, .double_positions = false}, lost);
}

class StreamingTest : public JobRunning {
protected:
    JobOutcome run(const JobInputs& inputs, std::size_t most_in_memory) {
        ShapeInfo shape;
        shape.points = kPoints - 1;
        shape.bounds = bounds_of(decode(std::as_bytes(std::span(square_))).shape.cloud.points);
        shape.warnings = {{"non-finite-points-dropped", "1 point"}};
        return run_job(Task::Denoise, inputs, square_, std::move(shape), most_in_memory);
    }

    [[nodiscard]] nlohmann::json report(const JobOutcome& outcome) const {
        return nlohmann::json::parse(bytes_of(outcome, ResultKind::Report));
    }

    const std::string square_ = odd_square();
};

TEST_F(StreamingTest, GivesWhatAJobGivesThatHoldsItsShape) {
    const JobOutcome held = run({}, kPoints);
    const JobOutcome streamed = run({}, 100);
    EXPECT_EQ(streamed.results.size(), held.results.size());
    EXPECT_TRUE(streamed.dictionary);
    const Document a = points_of(held);
    const Document b = points_of(streamed);
    ASSERT_EQ(a.shape.size(), kPoints - 1);
    ASSERT_EQ(b.shape.size(), kPoints - 1);
    // A cloud of one tile: only the dictionary may differ in its last digits.
    EXPECT_LT((a.shape.cloud.points - b.shape.cloud.points).cwiseAbs().maxCoeff(), 1e-4);
    ASSERT_EQ(b.shape.cloud.attributes.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(b.shape.cloud.attributes[i].name, a.shape.cloud.attributes[i].name);
        EXPECT_EQ(b.shape.cloud.attributes[i].data, a.shape.cloud.attributes[i].data);
    }
    EXPECT_TRUE(bytes_of(streamed, ResultKind::Fields).starts_with("ply\n"));
}

TEST_F(StreamingTest, TellsTheSame) {
    const nlohmann::json held = report(run({}, kPoints));
    const std::vector<Warning> warnings = job_->info().warnings;
    const nlohmann::json streamed = report(run({}, 100));
    for (const char* part : {"input", "fields", "duplicates", "nonFinite"}) {
        SCOPED_TRACE(part);
        EXPECT_EQ(streamed.value(part, nlohmann::json()), held.value(part, nlohmann::json()));
    }
    EXPECT_EQ(streamed["output"]["points"], held["output"]["points"]);
    const auto high = [](const nlohmann::json& report) {
        return report["output"]["bounds"]["max"][2].get<double>();
    };
    EXPECT_NEAR(high(streamed), high(held), 1e-4);
    EXPECT_NEAR(streamed["displacement"]["rms"].get<double>(),
                held["displacement"]["rms"].get<double>(), 1e-4);
    std::vector<std::string> codes[2];
    for (const Warning& warning : warnings) codes[0].push_back(warning.code);
    for (const Warning& warning : job_->info().warnings) codes[1].push_back(warning.code);
    std::ranges::sort(codes[0]);
    std::ranges::sort(codes[1]);
    EXPECT_EQ(codes[1], codes[0]);
    EXPECT_FALSE(job_->info().resolved_parameters.empty());
}

TEST_F(StreamingTest, OnlyWhereNothingNeedsTheWhole) {
    EXPECT_TRUE(can_stream(Task::Denoise, {}));
    EXPECT_TRUE(can_stream(Task::Denoise, {.format = FileFormat::PlyBinary}));
    EXPECT_FALSE(can_stream(Task::Resample, {}));
    EXPECT_FALSE(can_stream(Task::Analyze, {}));
    EXPECT_FALSE(can_stream(Task::Denoise, {.outliers = OutlierPolicy::Mark}));
    EXPECT_FALSE(can_stream(Task::Denoise, {.duplicates = DuplicatePolicy::Remove}));
    EXPECT_FALSE(can_stream(Task::Denoise, {.attributes = AttributePolicy::Drop}));
    EXPECT_FALSE(can_stream(Task::Denoise, {.normals = NormalPolicy::Estimate}));
    EXPECT_FALSE(can_stream(Task::Denoise, {.format = FileFormat::Draco}));
    EXPECT_TRUE(run({.outliers = OutlierPolicy::Mark}, 100).dictionary);
}

TEST_F(StreamingTest, ASubjectKnowsTheSameWhetherStreamedOrHeld) {
    const MappedFile file(blobs_.local_file(blobs_.put(square_)));
    const JobInputs inputs;
    const Question question{Task::Denoise, inputs, square_.size()};
    const Subject held = read_subject(question, file, {}, {});
    const auto open = PlyPoints::open(file.bytes(), {}).value();
    const Subject streamed = streamed_subject(open, {}, {});
    EXPECT_FALSE(held.streamed);
    EXPECT_TRUE(streamed.streamed);
    EXPECT_EQ(streamed.points, held.points);
    EXPECT_EQ(streamed.diagonal(), held.diagonal());
    EXPECT_EQ(streamed.part.shape.size(), held.points);
    ASSERT_EQ(streamed.document.warnings.size(), held.document.warnings.size());
    EXPECT_EQ(streamed.document.warnings[0].detail, held.document.warnings[0].detail);
    EXPECT_EQ(streamed.document.shape.cloud.attributes.size(), 2U);
}

}  // namespace
}  // namespace lpf::server
