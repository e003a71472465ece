#include "api/codec/ply_points.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stop_token>
#include <vector>

#include "api/codec/ply.h"
#include "core/base/error.h"

namespace lpf {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

/// A document of n points with a colour before and a number behind each.
Document numbered(Eigen::Index n, bool doubles = false) {
    Document document;
    document.double_positions = doubles;
    document.comments = {"scanned on a rainy day"};
    document.obj_info = {"a garden gate"};
    document.shape.cloud.points = Points::Random(3, n);
    std::vector<float> numbers(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
    document.shape.cloud.attributes.push_back(float_attribute("number", numbers));
    return document;
}

std::string file_of(const Document& document, FileFormat format = FileFormat::PlyBinary) {
    std::vector<Warning> lost;
    return encode_ply(document, {.format = format, .double_positions = document.double_positions},
                      lost);
}

std::string moved(const PlyPoints& points, const std::vector<Eigen::Vector3f>& moves,
                  std::uint64_t finite, WrittenPoints& written) {
    std::string out;
    written = write_moved(points, moves, finite, "made by a test",
                          [&](std::string_view piece) { out += piece; }, {});
    return out;
}

class PlyPointsOf : public testing::TestWithParam<bool> {
protected:
    const Document document = numbered(100'000, GetParam());
    const std::string file = file_of(document);
    const Document decoded = decode_ply(bytes_of(file), {});
    const PlyPoints points = PlyPoints::open(bytes_of(file), {}).value();
};

TEST_P(PlyPointsOf, AreThoseThatDecodingFinds) {
    ASSERT_EQ(points.size(), 100'000U);
    Points run(3, 500);
    points.read(99'500, run);
    EXPECT_EQ(run, decoded.shape.cloud.points.rightCols(500));
    const std::vector<std::uint32_t> some{0, 7, 99'999};
    points.read(some, run);
    ASSERT_EQ(run.cols(), 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
        EXPECT_EQ(
            Eigen::Vector3d(run.col(i)),
            Eigen::Vector3d(decoded.shape.cloud.points.col(some[static_cast<std::size_t>(i)])));
    }
}

TEST_P(PlyPointsOf, AreWrittenWithAllThatTheFileHad) {
    std::vector<Eigen::Vector3f> moves(100'000, Eigen::Vector3f(0.5F, 0.0F, -2.0F));
    moves[5].setZero();
    WrittenPoints written;
    const std::string out = moved(points, moves, 100'000, written);
    const Document result = decode_ply(bytes_of(out), {});
    EXPECT_EQ(written.points, 100'000U);
    EXPECT_EQ(result.double_positions, GetParam());
    const Points& was = decoded.shape.cloud.points;
    const Points& is = result.shape.cloud.points;
    EXPECT_EQ(Eigen::Vector3d(is.col(5)), Eigen::Vector3d(was.col(5)));
    const double rounding = GetParam() ? 1e-15 : 1e-6;
    EXPECT_LT((is.col(6) - was.col(6) - Eigen::Vector3d(0.5, 0, -2)).norm(), rounding);
    EXPECT_EQ(written.minimum, Eigen::Vector3d(is.rowwise().minCoeff()));
    EXPECT_EQ(written.maximum, Eigen::Vector3d(is.rowwise().maxCoeff()));
    EXPECT_EQ(result.shape.cloud.attributes[0].data, decoded.shape.cloud.attributes[0].data);
    EXPECT_EQ(result.comments,
              (std::vector<std::string>{"made by a test", "scanned on a rainy day"}));
    EXPECT_EQ(result.obj_info, decoded.obj_info);
}

INSTANTIATE_TEST_SUITE_P(Types, PlyPointsOf, testing::Bool(),
                         [](const auto& test) { return test.param ? "Float64" : "Float32"; });

TEST(PlyPoints, LeavesOutWhatIsNotFinite) {
    Document document = numbered(10, true);
    document.shape.cloud.points(1, 3) = kNan;
    const std::string file = file_of(document);
    const PlyPoints points = PlyPoints::open(bytes_of(file), {}).value();
    EXPECT_FALSE(points.position(3).allFinite());
    WrittenPoints written;
    const std::string out =
        moved(points, std::vector<Eigen::Vector3f>(10, Eigen::Vector3f::Zero()), 9, written);
    const Document result = decode_ply(bytes_of(out), {});
    EXPECT_EQ(written.points, 9U);
    ASSERT_EQ(result.shape.size(), 9U);
    EXPECT_EQ(value_at(result.shape.cloud.attributes[0], 3), 4.0);
}

TEST(PlyPoints, FirstRowsAreADocumentOfTheirOwn) {
    const std::string file = file_of(numbered(100));
    const PlyPoints points = PlyPoints::open(bytes_of(file), {}).value();
    const Document few = first_rows(points, 8, {});
    EXPECT_EQ(few.shape.cloud.points,
              decode_ply(bytes_of(file), {}).shape.cloud.points.leftCols(8));
    EXPECT_EQ(few.shape.cloud.attributes[0].rows(), 8U);
    EXPECT_EQ(first_rows(points, 1000, {}).shape.size(), 100U);
}

TEST(PlyPoints, OtherFilesAreNotOpened) {
    const Document document = numbered(10);
    for (const FileFormat format : {FileFormat::PlyAscii, FileFormat::PlyBigEndian}) {
        const std::string file = file_of(document, format);
        EXPECT_FALSE(PlyPoints::open(bytes_of(file), {}));
    }
    Document mesh = document;
    mesh.shape.triangles = Triangles(3, 1);
    mesh.shape.triangles << 0, 1, 2;
    const std::string file = file_of(mesh);
    EXPECT_FALSE(PlyPoints::open(bytes_of(file), {}));
    const std::string integers =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty int x\n"
        "property int y\nproperty int z\nend_header\n" +
        std::string(12, '\1');
    EXPECT_FALSE(PlyPoints::open(bytes_of(integers), {}));
    EXPECT_FALSE(PlyPoints::open(bytes_of("DRACO..."), {}));
}

TEST(PlyPoints, AnEmptyElementOfFacesIsNoFace) {
    const std::string file =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
        "property float y\nproperty float z\nelement face 0\n"
        "property list uchar int vertex_indices\nend_header\n" +
        std::string(12, '\0');
    const auto points = PlyPoints::open(bytes_of(file), {});
    ASSERT_TRUE(points);
    EXPECT_EQ(points->position(0), Eigen::Vector3d(0, 0, 0));
}

TEST(PlyPoints, ATruncatedFileIsRefused) {
    std::string file = file_of(numbered(1000));
    file.resize(file.size() - 1);
    EXPECT_THROW((void)PlyPoints::open(bytes_of(file), {}), Error);
    DecodeLimits small;
    small.max_points = 999;
    EXPECT_THROW((void)PlyPoints::open(bytes_of(file_of(numbered(1000))), small), Error);
}

TEST(PlyPoints, WritingStopsWhenAsked) {
    const std::string file = file_of(numbered(10));
    const PlyPoints points = PlyPoints::open(bytes_of(file), {}).value();
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)write_moved(points, std::vector<Eigen::Vector3f>(10), 10, "",
                                   [](std::string_view) {}, {.stop = stop.get_token()}),
                 Error);
}

}  // namespace
}  // namespace lpf
