#include "api/codec/summary.h"

#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::HasSubstr;

FileSummary summary_of(std::string_view file, std::size_t most_sampled = 500'000) {
    return summarize(bytes_of(file), {}, {.most_sampled = most_sampled});
}

/// The summary is what decoding would have found.
void expect_summary_of(const std::string& file) {
    const Document document = read(file);
    const FileSummary summary = summary_of(file);
    const Points& points = document.shape.cloud.points;
    EXPECT_EQ(summary.format, document.format);
    EXPECT_EQ(summary.points, document.shape.size());
    EXPECT_EQ(summary.faces, document.face_count());
    EXPECT_EQ(summary.sample, points);
    EXPECT_TRUE(summary.sample_is_whole());
    EXPECT_EQ(summary.minimum, points.rowwise().minCoeff());
    EXPECT_EQ(summary.maximum, points.rowwise().maxCoeff());
    ASSERT_EQ(summary.columns.size(), document.shape.cloud.attributes.size());
    for (std::size_t i = 0; i < summary.columns.size(); ++i) {
        const Attribute& attribute = document.shape.cloud.attributes[i];
        EXPECT_EQ(summary.columns[i].name, attribute.name);
        EXPECT_EQ(summary.columns[i].type, attribute.type);
        EXPECT_EQ(summary.columns[i].is_list(), attribute.is_list());
    }
    ASSERT_EQ(summary.warnings.size(), document.warnings.size());
    for (std::size_t i = 0; i < summary.warnings.size(); ++i) {
        EXPECT_EQ(summary.warnings[i].detail, document.warnings[i].detail);
    }
}

class Summary : public testing::TestWithParam<FileFormat> {
protected:
    [[nodiscard]] static std::string file_of(const Document& document) {
        EncodeOptions options;
        options.format = GetParam();
        return written(document, options);
    }
};

TEST_P(Summary, IsWhatDecodingFinds) {
    expect_summary_of(file_of(points_with_every_type()));
    expect_summary_of(file_of(mesh_with_everything()));
}

TEST_P(Summary, LeavesOutPointsThatAreNotFinite) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 50);
    document.shape.cloud.points(1, 7) = std::numeric_limits<double>::quiet_NaN();
    document.shape.cloud.points(2, 30) = std::numeric_limits<double>::infinity();
    expect_summary_of(file_of(document));
    document.shape.triangles = Triangles::Constant(3, 2, 7);
    document.shape.triangles.col(1).setConstant(8);
    expect_summary_of(file_of(document));
}

TEST_P(Summary, SamplesEveryPartOfALargeFile) {
    Document document;
    document.shape.cloud.points.resize(3, 40'000);
    for (Eigen::Index i = 0; i < 40'000; ++i) {
        document.shape.cloud.points.col(i).setConstant(static_cast<double>(i));
    }
    const FileSummary summary = summary_of(file_of(document), 1000);
    EXPECT_FALSE(summary.sample_is_whole());
    ASSERT_EQ(summary.sample.cols(), 1000);
    for (Eigen::Index i = 0; i < 1000; ++i) {
        EXPECT_DOUBLE_EQ(summary.sample(0, i), 40.0 * static_cast<double>(i));
    }
    EXPECT_EQ(summary.maximum, Eigen::Vector3d::Constant(39'999));
}

TEST_P(Summary, RefusesWhatDecodingRefuses) {
    const std::string whole = file_of(mesh_with_everything());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::string file = whole.substr(0, size);
        const auto refused = refusal(file);
        if (!refused) continue;
        try {
            (void)summary_of(file);
            FAIL() << "cut at " << size;
        } catch (const Error& error) {
            EXPECT_STREQ(error.what(), refused->what());
            EXPECT_EQ(error.code(), refused->code());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, Summary, testing::ValuesIn(all_formats()), [](const auto& test) {
    std::string name(format_name(test.param));
    std::erase(name, '-');
    return name;
});

TEST(SummaryOfFaces, CountsThemInTheWholeFile) {
    std::string file =
        "ply\nformat ascii 1.0\nelement face 1000\nproperty list uchar int vertex_indices\n"
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (int i = 0; i < 999; ++i) file += "3 0 1 2\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    expect_summary_of(file + "4 0 1 2 0\n" + points);
    try {
        (void)summary_of(file + "3 0 1 3\n" + points);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("face 999 refers to vertex 3"));
    }
    DecodeLimits limits;
    limits.max_faces = 1000;
    EXPECT_THROW((void)summarize(bytes_of(file + "5 0 1 2 0 1\n" + points), limits, {}), Error);
}

TEST(SummaryOfAFile, TellsWhatIsDoneWith) {
    Document document;
    document.shape.cloud.points = Points::Random(3, 100'000);
    const std::string file = written(document, {});
    std::vector<std::size_t> passed;
    (void)summarize(bytes_of(file), {},
                    {.passed = [&](std::size_t bytes) { passed.push_back(bytes); }});
    EXPECT_GT(passed.size(), 3U);
    EXPECT_TRUE(std::is_sorted(passed.begin(), passed.end()));
    EXPECT_EQ(passed.back(), file.size());
}

TEST(SummaryOfAFile, OfAnotherKindSaysWhatItLooksLike) {
    for (const char* file : {"", "{}", "plyx", "ply", "solid x"}) {
        const auto refused = refusal(file);
        ASSERT_TRUE(refused.has_value()) << file;
        EXPECT_THROW((void)summary_of(file), Error) << file;
    }
}

}  // namespace
}  // namespace lpf
