#include "server/runner.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "api/problem.h"
#include "core/base/error.h"
#include "server/ids.h"
#include "server/store/file_blob_store.h"
#include "server/store/mapped_file.h"
#include "server/store/sha256.h"
#include "server/store/sqlite_job_store.h"
#include "tests/server/example_shapes.h"
#include "tests/server/runner_fixture.h"

namespace lpf::server {
namespace {

class RunnerTest : public JobRunning {
protected:
    JobOutcome run(Task task, const JobInputs& inputs, const std::string& bytes) {
        return run_job(task, inputs, bytes);
    }

    [[nodiscard]] bool warned(const std::string& code) const {
        for (const Warning& warning : job_->info().warnings)
            if (warning.code == code) return true;
        return false;
    }

    static const Attribute* attribute(const Document& document, const std::string& name) {
        for (const Attribute& a : document.shape.cloud.attributes)
            if (a.name == name) return &a;
        return nullptr;
    }

    const std::string square_ = wavy_square(24);
};

TEST_F(RunnerTest, DenoisingKeepsNumberOrderAndAttributes) {
    const JobOutcome outcome = run(Task::Denoise, {}, square_);
    const Document document = points_of(outcome);
    ASSERT_EQ(document.shape.size(), 576U);
    ASSERT_NE(attribute(document, "number"), nullptr);
    ASSERT_NE(attribute(document, "red"), nullptr);
    for (const std::size_t i : {0U, 100U, 575U}) {
        EXPECT_EQ(value_at(*attribute(document, "number"), i), static_cast<double>(i));
        EXPECT_EQ(value_at(*attribute(document, "red"), i), static_cast<double>(i % 256));
    }
    EXPECT_TRUE(document.shape.cloud.points.allFinite());
}

TEST_F(RunnerTest, DenoisingLeavesFourResults) {
    const JobOutcome outcome = run(Task::Denoise, {}, square_);
    EXPECT_EQ(outcome.results.size(), 4U);
    ASSERT_TRUE(outcome.dictionary);
    const auto dictionary = nlohmann::json::parse(bytes_of(outcome, ResultKind::Dictionary));
    EXPECT_EQ(dictionary["id"], outcome.dictionary->id);
    EXPECT_EQ(dictionary["sourceJob"], job_->lease().job_id);
    EXPECT_EQ(nlohmann::json::parse(outcome.dictionary->summary)["id"], outcome.dictionary->id);
    EXPECT_TRUE(bytes_of(outcome, ResultKind::Fields).starts_with("ply\n"));
    EXPECT_FALSE(job_->info().resolved_parameters.empty());
}

TEST_F(RunnerTest, ResamplingCarriesAttributesOfTheNearestPoint) {
    JobInputs inputs;
    inputs.factor = 2.0;
    const Document document = points_of(run(Task::Resample, inputs, square_));
    EXPECT_GT(document.shape.size(), 576U);
    const Attribute* number = attribute(document, "number");
    ASSERT_NE(number, nullptr);
    for (std::size_t i = 0; i < document.shape.size(); i += 50) {
        const double source = value_at(*number, i);
        const Eigen::Vector3d point = document.shape.cloud.points.col(static_cast<Eigen::Index>(i));
        const double x = std::fmod(source, 24.0);
        const double y = std::floor(source / 24.0);
        EXPECT_LT(std::hypot(point.x() - x, point.y() - y), 1.5);
    }
}

TEST_F(RunnerTest, AnalysisHasNoPoints) {
    const JobOutcome outcome = run(Task::Analyze, {}, square_);
    EXPECT_EQ(outcome.results.size(), 3U);
    EXPECT_TRUE(bytes_of(outcome, ResultKind::Points).empty());
    EXPECT_TRUE(outcome.dictionary);
}

TEST_F(RunnerTest, ResultsComeInTheFormatAskedFor) {
    JobInputs inputs;
    inputs.format = FileFormat::Draco;
    const Document document = points_of(run(Task::Denoise, inputs, square_));
    EXPECT_EQ(document.format, FileFormat::Draco);
    EXPECT_EQ(document.shape.size(), 576U);
    EXPECT_NE(attribute(document, "number"), nullptr);
}

TEST_F(RunnerTest, DuplicatesAreCountedAndRemovedOnRequest) {
    std::string twice = square_;
    twice.replace(twice.find("vertex 576"), 10, "vertex 577");
    twice += "0 0 0.1 7 576\n0 0 0.1 7 577\n";
    twice.replace(twice.find("vertex 577"), 10, "vertex 578");
    EXPECT_EQ(points_of(run(Task::Denoise, {}, twice)).shape.size(), 578U);
    EXPECT_TRUE(warned("duplicate-points"));
    JobInputs inputs;
    inputs.duplicates = DuplicatePolicy::Remove;
    EXPECT_LT(points_of(run(Task::Denoise, inputs, twice)).shape.size(), 578U);
}

TEST_F(RunnerTest, OutliersAreMarkedOrRemoved) {
    std::string far = square_;
    far.replace(far.find("vertex 576"), 10, "vertex 577");
    far += "12 12 500 0 576\n";
    JobInputs inputs;
    inputs.outliers = OutlierPolicy::Mark;
    const Document marked = points_of(run(Task::Denoise, inputs, far));
    ASSERT_NE(attribute(marked, "outlier"), nullptr);
    EXPECT_EQ(value_at(*attribute(marked, "outlier"), 576), 1.0);
    EXPECT_EQ(value_at(*attribute(marked, "outlier"), 0), 0.0);
    inputs.outliers = OutlierPolicy::Remove;
    const Document removed = points_of(run(Task::Denoise, inputs, far));
    EXPECT_LT(removed.shape.size(), 577U);
    EXPECT_TRUE(warned("outliers-removed"));
}

TEST_F(RunnerTest, AttributesAndNormalsFollowThePolicies) {
    JobInputs inputs;
    inputs.attributes = AttributePolicy::Drop;
    inputs.normals = NormalPolicy::Estimate;
    const Document document = points_of(run(Task::Denoise, inputs, square_));
    EXPECT_EQ(attribute(document, "red"), nullptr);
    ASSERT_NE(attribute(document, "nz"), nullptr);
    EXPECT_GT(std::abs(value_at(*attribute(document, "nz"), 300)), 0.5);
}

TEST_F(RunnerTest, ADictionaryIsKeptFixed) {
    JobInputs few;
    few.atoms = 4;
    const JobOutcome first = run(Task::Analyze, few, square_);
    const StoredDictionary stored = *first.dictionary;
    const auto atoms = nlohmann::json::parse(bytes_of(first, ResultKind::Dictionary))["atoms"];
    books_.add_job({.info = job_->info()}, {});
    const auto claim = books_.claim_next({.now = 0, .lease_until = 1, .rules = {}});
    ASSERT_TRUE(books_.finish(claim->lease, claim->info, first.results, stored, 0));

    JobInputs inputs;
    inputs.dictionary = stored.id;
    inputs.dictionary_mode = DictionaryMode::Fixed;
    const JobOutcome second = run(Task::Analyze, inputs, wavy_square(20));
    const auto again = nlohmann::json::parse(bytes_of(second, ResultKind::Dictionary));
    EXPECT_EQ(again["atoms"], atoms);
}

TEST_F(RunnerTest, ACancelledJobStopsWithCancelled) {
    ShapeInfo shape;
    shape.id = new_id();
    shape.sha256 = blobs_.put(square_);
    StatusInfo info;
    info.job_id = new_id();
    info.shape = books_.add_shape(shape).id;
    RunningJob job({info, {info.job_id, "token"}}, 600);
    job.stop(StopReason::Dismissed);
    try {
        (void)Runner(storage_, {.limits = {}, .threads = 1, .version = "test"}).run(job);
        FAIL() << "it had been told to stop";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
}

TEST_F(RunnerTest, AMissingDictionaryIsAProblem) {
    JobInputs inputs;
    inputs.dictionary = new_id();
    EXPECT_THROW(run(Task::Denoise, inputs, square_), ProblemException);
}

}  // namespace
}  // namespace lpf::server
