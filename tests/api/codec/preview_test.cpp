#include "api/codec/preview.h"

#include <gtest/gtest.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

/// Points on a line, each with its number as its colour (mod 256) and as an attribute.
Document line(int count, double offset = 0) {
    Document document;
    document.double_positions = true;
    PointCloud& cloud = document.shape.cloud;
    cloud.points.resize(3, count);
    std::vector<std::uint8_t> shade;
    for (int i = 0; i < count; ++i) {
        cloud.points.col(i) = Eigen::Vector3d(offset + 0.001 * i, 2, 3);
        shade.push_back(static_cast<std::uint8_t>(i));
    }
    for (const char* name : {"red", "green", "blue"})
        cloud.attributes.push_back(column(name, ScalarType::UInt8, shade));
    return document;
}

std::string file_of(const Document& document, FileFormat format) {
    return written(document, {.format = format, .double_positions = document.double_positions});
}

class PreviewOfEachKind : public testing::TestWithParam<FileFormat> {
protected:
    static PointSample sample(const Document& document, std::size_t most) {
        const std::string file = file_of(document, GetParam());
        if (GetParam() == FileFormat::Draco || GetParam() == FileFormat::PlyAscii)
            return sample_document(read(file), most);
        return sample_rows(bytes_of(file), most).value();
    }
};

TEST_P(PreviewOfEachKind, HoldsAllPointsOfASmallFile) {
    const PointSample all = sample(line(300), 1000);
    EXPECT_EQ(all.total, 300U);
    ASSERT_EQ(all.points.cols(), 300);
    ASSERT_EQ(all.colours.size(), 300U);
    EXPECT_NEAR(all.points(0, 299), 0.299, 1e-9);
    EXPECT_EQ(all.colours[299][1], 299 % 256);
}

TEST_P(PreviewOfEachKind, TakesAsManyPointsOfEveryStretch) {
    const PointSample some = sample(line(10'000), 100);
    EXPECT_EQ(some.total, 10'000U);
    ASSERT_EQ(some.points.cols(), 100);
    for (int i = 0; i < 100; ++i) {
        EXPECT_GE(some.points(0, i), 0.1 * i - 1e-6);
        EXPECT_LE(some.points(0, i), 0.1 * (i + 1) + 1e-6);
        const int number = static_cast<int>(std::lround(some.points(0, i) / 0.001));
        EXPECT_EQ(some.colours[static_cast<std::size_t>(i)][0], number % 256);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, PreviewOfEachKind,
                         testing::Values(FileFormat::PlyBinary, FileFormat::PlyBigEndian,
                                         FileFormat::PlyAscii, FileFormat::Draco),
                         [](const auto& file) {
                             std::string name(format_name(file.param));
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

TEST(Preview, IsTheSameEachTime) {
    const std::string file = file_of(line(5000), FileFormat::PlyBinary);
    EXPECT_EQ(encode_preview(*sample_rows(bytes_of(file), 50)),
              encode_preview(*sample_rows(bytes_of(file), 50)));
}

TEST(Preview, IsAFileThatCanBeReadAndSaysWhatItShows) {
    const std::string file = file_of(line(5000), FileFormat::PlyBinary);
    const std::string preview = encode_preview(*sample_rows(bytes_of(file), 50));
    const PreviewHead head = read_preview_head(bytes_of(preview));
    EXPECT_EQ(head.points, 50U);
    EXPECT_EQ(head.total, 5000U);
    EXPECT_EQ(head.offset, Eigen::Vector3d::Zero());
    const Document shown = read(preview);
    EXPECT_EQ(shown.shape.size(), 50U);
    EXPECT_EQ(attribute_of(shown, "green").type, ScalarType::UInt8);
}

TEST(Preview, FarFromTheOriginIsRelativeToAnOffset) {
    const double far = 4'500'000.0;
    const std::string file = file_of(line(1000, far), FileFormat::PlyBinary);
    const std::string preview = encode_preview(*sample_rows(bytes_of(file), 1000));
    const PreviewHead head = read_preview_head(bytes_of(preview));
    EXPECT_NEAR(head.offset.x(), far + 0.4995, 1e-6);
    const Document shown = read(preview);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_NEAR(shown.shape.cloud.points(0, i) + head.offset.x(), far + 0.001 * i, 1e-6);
    }
}

TEST(Preview, LeavesOutPointsThatAreNotFinite) {
    Document document = line(10);
    document.shape.cloud.points(1, 4) = std::numeric_limits<double>::quiet_NaN();
    const std::string file = file_of(document, FileFormat::PlyBinary);
    const PointSample sample = *sample_rows(bytes_of(file), 10);
    EXPECT_EQ(sample.points.cols(), 9);
    EXPECT_EQ(sample.colours.size(), 9U);
    EXPECT_TRUE(sample.points.allFinite());
}

TEST(Preview, OfFractionsAndWideColours) {
    Document document = line(2);
    auto& attributes = document.shape.cloud.attributes;
    attributes[0] = column<float>("red", ScalarType::Float32, {0.5F, 2.0F});
    attributes[1] = column<std::uint16_t>("green", ScalarType::UInt16, {65535, 0});
    const std::string file = file_of(document, FileFormat::PlyBinary);
    const PointSample sample = *sample_rows(bytes_of(file), 2);
    EXPECT_EQ(sample.colours[0][0], 128);
    EXPECT_EQ(sample.colours[1][0], 255);
    EXPECT_EQ(sample.colours[0][1], 255);
}

TEST(Preview, OfAFileWithoutColoursHasNone) {
    Document document = line(20);
    document.shape.cloud.attributes.pop_back();  // blue is missing
    const std::string preview =
        encode_preview(*sample_rows(bytes_of(file_of(document, FileFormat::PlyBinary)), 20));
    EXPECT_TRUE(read(preview).shape.cloud.attributes.empty());
    EXPECT_TRUE(sample_document(document, 20).colours.empty());
}

TEST(Preview, RowsOfDifferentLengthsAreLeftToTheDecoder) {
    const std::string file = written(mesh_with_everything(), {.format = FileFormat::PlyBinary});
    EXPECT_FALSE(sample_rows(bytes_of(file), 3));
    EXPECT_GT(sample_document(read(file), 3).points.cols(), 0);
}

TEST(Preview, ATruncatedFileIsLeftToTheDecoder) {
    const std::string file = file_of(line(100), FileFormat::PlyBinary);
    EXPECT_FALSE(sample_rows(bytes_of(file.substr(0, file.size() - 30)), 10));
}

TEST(Preview, OfNoPointsIsAnEmptyFile) {
    Document document;
    const std::string preview = encode_preview(sample_document(document, 10));
    EXPECT_EQ(read(preview).shape.size(), 0U);
    EXPECT_EQ(read_preview_head(bytes_of(preview)).total, 0U);
}

}  // namespace
}  // namespace lpf
