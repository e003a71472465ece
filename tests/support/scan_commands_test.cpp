#include "tests/support/scan_commands.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "api/codec/format.h"
#include "core/base/error.h"
#include "tests/support/meshes.h"

namespace lpf::test {
namespace {

class ScanCommands : public testing::Test {
protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return folder_ / name; }

    std::string write_cube_mesh() const {
        Document document;
        document.shape = cube_mesh(1.0, 2);
        std::vector<Warning> lost;
        std::ofstream(path("cube.ply"), std::ios::binary) << encode(document, {}, lost);
        return path("cube.ply");
    }

private:
    std::filesystem::path folder_ =
        std::filesystem::path(testing::TempDir()) /
        ("scan_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(ScanCommands, ScansOfAMeshAreMeasuredToIt) {
    const std::string mesh = write_cube_mesh();
    const auto told = simulate({.mesh = mesh,
                                .sampling = {.points = 20000},
                                .noise_percent = 1,
                                .output = path("noisy.ply"),
                                .clean_output = path("clean.ply")});
    EXPECT_NEAR(told.at("noise"), 0.01 * told.at("diagonal").get<double>(), 1e-12);
    EXPECT_NEAR(told.at("area"), 24.0, 1e-9);
    EXPECT_EQ(told.at("pointsOnCurves"), 0);
    const auto error_of = [&](const std::string& name) {
        return measure_error({.result = path(name), .reference = {.file = mesh}}).at("rmse");
    };
    EXPECT_LT(error_of("clean.ply"), 1e-6);
    EXPECT_NEAR(error_of("noisy.ply"), told.at("noise"), 0.1 * told.at("noise").get<double>());
}

TEST_F(ScanCommands, DetailsTellThePartsThatAShapeHas) {
    (void)simulate({.shape = "cube_with_curve",
                    .sampling = {.points = 20000, .noise = 0.02},
                    .output = path("noisy.ply")});
    const auto report = measure_error({.result = path("noisy.ply"),
                                       .reference = {.shape = "cube_with_curve"},
                                       .detailed = true,
                                       .edge_distance = 0.1});
    const auto& parts = report.at("parts");
    EXPECT_EQ(
        parts.at("surface").at("points").get<int>() + parts.at("curve").at("points").get<int>(),
        20000);
    EXPECT_GT(parts.at("nearEdges").at("points"), 500);
    for (const char* part : {"surface", "curve", "edge", "end"}) {
        EXPECT_GT(report.at("coverage").at(part), 0.0) << part;
    }
    EXPECT_FALSE(report.at("coverage").contains("border"));
    EXPECT_NEAR(report.at("spacing").at("variation"), 0.52, 0.15);  // that of random points
}

TEST_F(ScanCommands, WithoutDetailsThereAreNone) {
    (void)simulate({.shape = "plane", .sampling = {.points = 100}, .output = path("plane.ply")});
    const auto report =
        measure_error({.result = path("plane.ply"), .reference = {.shape = "plane"}});
    EXPECT_FALSE(report.contains("parts"));
    EXPECT_FALSE(report.contains("spacing"));
}

TEST_F(ScanCommands, ACloudIsNoMeshToSample) {
    (void)simulate({.shape = "plane", .sampling = {.points = 100}, .output = path("plane.ply")});
    EXPECT_THROW((void)simulate({.mesh = path("plane.ply"), .output = path("no.ply")}), Error);
}

}  // namespace
}  // namespace lpf::test
