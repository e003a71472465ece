#include <gmock/gmock.h>
#include <sys/resource.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

long peak_kibibytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

std::string claiming(const std::string& format, const std::string& count) {
    return "ply\nformat " + format + " 1.0\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" +
           std::string(60, '1');
}

class PlyCountAttack : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(PlyCountAttack, IsRefusedBeforeMemoryIsTaken) {
    const long before = peak_kibibytes();
    const auto [format, count] = GetParam();
    const auto error = refusal(claiming(format, count));
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::MalformedFile);
    EXPECT_THAT(error->what(), HasSubstr("promises " + count));
    EXPECT_LT(peak_kibibytes() - before, 8 * 1024);
}

INSTANTIATE_TEST_SUITE_P(
    Counts, PlyCountAttack,
    testing::Combine(testing::Values("ascii", "binary_little_endian", "binary_big_endian"),
                     testing::Values("11", "2147483648", "4294967296", "353535235358",
                                     "9223372036854775807", "18446744073709551615")));

TEST(PlyCountAttack, ListsOfEmptyListsTakeLittleMoreThanTheFile) {
    std::string file =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char x\n"
        "property char y\nproperty char z\nelement a 8000000\nproperty list uchar double l\n"
        "end_header\nabc" +
        std::string(8000000, '\0');
    const long before = peak_kibibytes();
    const Document document = read(file);
    EXPECT_EQ(document.elements.at(0).rows, 8000000U);
    EXPECT_LT(peak_kibibytes() - before, 9 * 16 * 1024);
}

TEST(PlyCountAttack, TakesOverTheSumOfAllElements) {
    const auto error = refusal(
        "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty char x\n"
        "property char y\nproperty char z\nelement a 18446744073709551610\n"
        "property char b\nend_header\nabcdefgh");
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("element 'a' promises"));
}

TEST(PlyLimit, OfPointsIsNamed) {
    DecodeLimits limits;
    limits.max_points = 4;
    EXPECT_EQ(refusal(claiming("binary_little_endian", "4"), limits), std::nullopt);
    const auto error = refusal(claiming("binary_little_endian", "5"), limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
    EXPECT_THAT(error->what(), HasSubstr("the limit is 4"));
}

TEST(PlyLimit, OfFacesIsNamed) {
    DecodeLimits limits;
    limits.max_faces = 1;
    const auto error = refusal(written(mesh_with_everything(), {}), limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
    EXPECT_THAT(error->what(), HasSubstr("element 'face'; the limit is 1"));
}

class PlyDamage : public testing::TestWithParam<FileFormat> {
protected:
    [[nodiscard]] std::string file() const {
        EncodeOptions options;
        options.format = GetParam();
        return written(mesh_with_everything(), options);
    }
};

/// Refused in words, or read: nothing else may happen.
void expect_defined_answer(const std::string& file) {
    const auto error = refusal(file);
    if (!error) return;
    EXPECT_THAT(error->code(), AnyOf(ErrorCode::MalformedFile, ErrorCode::UnsupportedFormat,
                                     ErrorCode::LimitExceeded))
        << error->what();
    EXPECT_GT(std::string(error->what()).size(), 20U);
}

TEST_P(PlyDamage, TruncationAtAnyByteIsRefused) {
    const std::string whole = file();
    // The last line end of an ASCII file is not needed.
    const std::size_t needed = whole.size() - (GetParam() == FileFormat::PlyAscii ? 1 : 0);
    for (std::size_t size = 0; size < needed; ++size) {
        const auto error = refusal(whole.substr(0, size));
        // An ASCII number that is cut short may be another number.
        if (GetParam() == FileFormat::PlyAscii && size + 2 >= needed) continue;
        ASSERT_TRUE(error.has_value()) << "cut at byte " << size;
        EXPECT_NE(error->code(), ErrorCode::Internal);
    }
}

TEST_P(PlyDamage, AnyChangedByteHasADefinedAnswer) {
    const std::string whole = file();
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const char change : {'\x01', '\x20', '\x40', '\x80', '\xff'}) {
            std::string damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ change);
            expect_defined_answer(damaged);
        }
    }
}

TEST_P(PlyDamage, AnyRemovedOrDoubledByteHasADefinedAnswer) {
    const std::string whole = file();
    for (std::size_t at = 0; at < whole.size(); ++at) {
        expect_defined_answer(whole.substr(0, at) + whole.substr(at + 1));
        expect_defined_answer(whole.substr(0, at) + whole[at] + whole.substr(at));
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, PlyDamage,
                         testing::Values(FileFormat::PlyBinary, FileFormat::PlyAscii,
                                         FileFormat::PlyBigEndian),
                         [](const auto& test) {
                             std::string name(format_name(test.param));
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace lpf
