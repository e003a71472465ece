#include "tests/support/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "core/base/error.h"
#include "tests/support/shapes.h"

namespace lpf::test {
namespace {

const Colour kWhite(1, 1, 1);
const Colour kRed(1, 0, 0);
const Colour kBlue(0, 0, 1);

Scene flat_scene(const Points& points, const Colour& colour) {
    Scene scene{points, Eigen::Matrix3Xf::Zero(3, points.cols()), {}};
    scene.normals.row(2).setOnes();
    scene.colours.assign(static_cast<std::size_t>(points.cols()), colour);
    return scene;
}

Scene both(const Scene& a, const Scene& b) {
    Scene scene;
    scene.points.resize(3, a.points.cols() + b.points.cols());
    scene.points << a.points, b.points;
    scene.normals.resize(3, scene.points.cols());
    scene.normals << a.normals, b.normals;
    scene.colours = a.colours;
    scene.colours.insert(scene.colours.end(), b.colours.begin(), b.colours.end());
    return scene;
}

TEST(Render, PlaneFromAboveFillsTheMiddleAndLeavesTheRim) {
    const Scene scene = flat_scene(make_plane({.points = 20000}).points, kRed);
    const Image image = render(scene, {.elevation = 90, .extent = 4}, {100, 100});
    int painted = 0;
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x) painted += image.at(x, y) != kWhite;
    }
    EXPECT_NEAR(painted, 50 * 50, 250);
    EXPECT_GT(image.at(50, 50).x(), 0.5F);
    EXPECT_LT(image.at(50, 50).y(), 0.1F);
    EXPECT_EQ(image.at(5, 5), kWhite);
}

TEST(Render, TheNearerPointsHideTheOthers) {
    const Points low = make_plane({.points = 5000}).points;
    const Points high = low.colwise() + Vector3d(0, 0, 0.5);
    const Scene scene = both(flat_scene(low, kBlue), flat_scene(high, kRed));
    const Image above = render(scene, {.elevation = 90, .extent = 2}, {64, 64});
    const Image below = render(scene, {.elevation = -90, .extent = 2}, {64, 64});
    EXPECT_GT(above.at(32, 32).x(), 0.3F);
    EXPECT_LT(above.at(32, 32).z(), 0.05F);
    EXPECT_LT(below.at(32, 32).x(), 0.05F);
    EXPECT_GT(below.at(32, 32).z(), 0.3F);
}

TEST(Render, XIsToTheRightWhenLookedAtFromTheSouth) {
    Points points = make_sphere({.points = 3000}).points * 0.2;
    points.row(0).array() += 0.6;
    const Image image =
        render(flat_scene(points, kRed), {.azimuth = -90, .elevation = 0, .extent = 2}, {100, 100});
    EXPECT_NE(image.at(80, 50), kWhite);
    EXPECT_EQ(image.at(20, 50), kWhite);
}

TEST(Render, FitShowsEveryPoint) {
    const Points points = make_cube({.points = 40000}).points.colwise() + Vector3d(5e6, 4e5, 100);
    for (const double aspect : {0.5, 1.0, 3.0}) {
        const View view = fit_view(points, -60, 30, aspect);
        const int width = static_cast<int>(120 * aspect);
        const Image image = render(flat_scene(points, kRed), view, {width, 120});
        for (int x = 0; x < width; ++x) ASSERT_EQ(image.at(x, 0), kWhite);
        for (int y = 0; y < 120; ++y) ASSERT_EQ(image.at(0, y), kWhite);
        ASSERT_NE(image.at(width / 2, 60), kWhite);
    }
}

TEST(Render, NothingToDrawIsAWhitePicture) {
    const Image image =
        render(flat_scene(Points(3, 0), kRed), fit_view(Points(3, 0), 0, 0, 1), {64, 64});
    EXPECT_EQ(image.at(32, 32), kWhite);
}

TEST(Image, LettersAreDrawn) {
    Image image(80, 30, kWhite);
    image.write("a-b 1", 2, 5, 14, kBlue);
    int dark = 0;
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 80; ++x) dark += image.at(x, y).x() < 0.5F;
    }
    EXPECT_GT(dark, 60);
    EXPECT_LT(dark, 600);
}

TEST(Image, SavesAPng) {
    const std::string path = testing::TempDir() + "lpf_render_test.png";
    Image(32, 16, kRed).save_png(path);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\x20\0\0\0\x10", 8));
    std::remove(path.c_str());
    EXPECT_THROW(Image(32, 16, kRed).save_png(testing::TempDir() + "no/such/folder/x.png"), Error);
}

}  // namespace
}  // namespace lpf::test
