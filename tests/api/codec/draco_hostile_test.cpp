#include <gmock/gmock.h>

#include "api/codec/draco_claim.h"
#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

std::string stream(bool mesh, bool metadata) {
    Document document = mesh ? mesh_with_everything() : points_with_every_type();
    if (!metadata) {
        document = {};
        document.shape.cloud.points = Points::Random(3, 12);
        if (mesh) document.shape.triangles = Triangles::Zero(3, 4);
    }
    EncodeOptions options;
    options.format = FileFormat::Draco;
    return written(document, options);
}

std::optional<Error> refused_claim(const std::string& file) {
    try {
        const DracoClaim claim = read_draco_claim(bytes_of(file));
        check_draco_claim(claim, file.size(), {});
    } catch (const Error& error) {
        return error;
    }
    return std::nullopt;
}

/// A header as it stands at the beginning of every stream.
std::string draco_header(int major, int minor, int geometry, int method, int flags = 0) {
    std::string bytes = "DRACO";
    for (const int value : {major, minor, geometry, method, flags & 255, flags >> 8}) {
        bytes += static_cast<char>(value);
    }
    return bytes;
}

class DracoClaimOf : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(DracoClaimOf, AValidStreamIsItsSize) {
    const auto [mesh, metadata] = GetParam();
    const DracoClaim claim = read_draco_claim(bytes_of(stream(mesh, metadata)));
    EXPECT_EQ(claim.is_mesh, mesh);
    EXPECT_EQ(claim.points, metadata ? 4U : 12U);
    EXPECT_EQ(claim.faces, mesh ? (metadata ? 3U : 4U) : 0U);
    EXPECT_TRUE(claim.is_current());
}

INSTANTIATE_TEST_SUITE_P(Kinds, DracoClaimOf, testing::Combine(testing::Bool(), testing::Bool()));

TEST(DracoClaim, ReadsOldEdgebreakerCountsAsFixedIntegers) {
    std::string file = draco_header(1, 1, 1, 1) + std::string(1, '\0');
    append(file, 7U);
    append(file, 34834U);
    append(file, 69451U);
    const DracoClaim claim = read_draco_claim(bytes_of(file));
    EXPECT_EQ(claim.points, 34834U);
    EXPECT_EQ(claim.faces, 69451U);
    EXPECT_FALSE(claim.is_current());
}

TEST(DracoClaim, ReadsOldSequentialCountsAsFixedIntegers) {
    std::string file = draco_header(2, 0, 1, 0);
    append(file, 170U);
    append(file, 97U);
    const DracoClaim claim = read_draco_claim(bytes_of(file));
    EXPECT_EQ(claim.points, 97U);
    EXPECT_EQ(claim.faces, 170U);
}

TEST(DracoClaim, OfBillionsOfPointsInAFewBytesIsRefused) {
    for (const std::uint32_t points : {0xffffffffU, 4104922368U, 0x7fffffffU, 100000U}) {
        std::string file = draco_header(2, 3, 0, 0);
        append(file, points);
        file += std::string(33, '\1');
        const auto error = refusal(file);
        ASSERT_TRUE(error.has_value());
        EXPECT_EQ(error->code(), ErrorCode::MalformedFile);
        EXPECT_THAT(error->what(), HasSubstr("claims " + std::to_string(points) + " points"));
    }
}

TEST(DracoClaim, OfBillionsOfFacesInAFewBytesIsRefused) {
    const auto error =
        refusal(draco_header(2, 2, 1, 0) + "\xff\xff\xff\xff\x0f\x04" + std::string(40, '\1'));
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("claims 4294967295 faces"));
}

TEST(DracoClaim, HiddenBehindMetadataIsFound) {
    // One attribute with one entry, then geometry metadata with one child.
    std::string file = draco_header(2, 3, 0, 0, 0x8000);
    file += std::string("\x01\x00\x01\x01n\x02zz\x00", 9);
    file += std::string("\x00\x01\x01k\x00\x00", 6);
    append(file, 4000000000U);
    const auto error = refused_claim(file);
    ASSERT_TRUE(error.has_value());
    EXPECT_THAT(error->what(), HasSubstr("claims 4000000000 points"));
}

TEST(DracoClaim, OverTheLimitNamesTheLimit) {
    DecodeLimits limits;
    limits.max_points = 11;
    const auto error = refusal(stream(false, false), limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::LimitExceeded);
    EXPECT_THAT(error->what(), HasSubstr("the limit is 11"));
}

struct BadDraco {
    std::string name;
    std::string bytes;
    ErrorCode code;
    std::string said;
};

void PrintTo(const BadDraco& bad, std::ostream* out) { *out << bad.name; }

class DracoMistake : public testing::TestWithParam<BadDraco> {};

TEST_P(DracoMistake, IsRefusedInWords) {
    const auto error = refusal(GetParam().bytes);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), GetParam().code);
    EXPECT_THAT(error->what(), HasSubstr(GetParam().said));
}

const std::string kRest(60, '\1');

INSTANTIATE_TEST_SUITE_P(
    Headers, DracoMistake,
    testing::Values(
        BadDraco{"MagicAlone", "DRACO", ErrorCode::MalformedFile, "ends at byte 5"},
        BadDraco{"Version9", draco_header(9, 9, 0, 0) + kRest, ErrorCode::UnsupportedFormat, "9.9"},
        BadDraco{"Version0", draco_header(0, 1, 0, 0) + kRest, ErrorCode::UnsupportedFormat, "0.1"},
        BadDraco{"Mesh23", draco_header(2, 3, 1, 0) + kRest, ErrorCode::UnsupportedFormat, "2.3"},
        BadDraco{"Geometry2", draco_header(2, 2, 2, 0) + kRest, ErrorCode::MalformedFile,
                 "geometry type 2"},
        BadDraco{"Method255", draco_header(2, 2, 0, 255) + kRest, ErrorCode::MalformedFile,
                 "method 255"},
        BadDraco{"NoCount", draco_header(2, 3, 0, 0) + "\1\1", ErrorCode::MalformedFile,
                 "the number of points"},
        BadDraco{"EndlessVarint", draco_header(2, 2, 1, 0) + std::string(60, '\xff'),
                 ErrorCode::MalformedFile, "longer than 64 bits"},
        BadDraco{"MetadataPastTheEnd", draco_header(2, 3, 0, 0, 0x8000) + "\1\1\1\x05" + "ab",
                 ErrorCode::MalformedFile, "metadata"},
        BadDraco{"Garbage", draco_header(2, 3, 0, 0) + std::string("\4\0\0\0", 4) + kRest,
                 ErrorCode::MalformedFile, "Draco stream"}),
    [](const auto& test) { return test.param.name; });

TEST(DracoWithoutHelper, RefusesOldBitstreamsWithAdvice) {
    std::string file = draco_header(1, 1, 0, 0);
    append(file, 24U);
    file += kRest;
    DecodeLimits limits;
    limits.decode_helper.clear();
    const auto error = refusal(file, limits);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::UnsupportedFormat);
    EXPECT_THAT(error->what(), HasSubstr("encode the shape again"));
}

void expect_defined_answer(const std::string& file, const std::string& what) {
    const auto error = refusal(file);
    if (!error) return;
    EXPECT_THAT(error->code(), AnyOf(ErrorCode::MalformedFile, ErrorCode::UnsupportedFormat,
                                     ErrorCode::LimitExceeded))
        << what << ": " << error->what();
}

class DracoDamage : public testing::TestWithParam<bool> {};

TEST_P(DracoDamage, TruncationAtAnyByteHasADefinedAnswer) {
    const std::string whole = stream(GetParam(), false);
    for (std::size_t size = 5; size < whole.size(); ++size) {
        expect_defined_answer(whole.substr(0, size), "cut at " + std::to_string(size));
    }
}

TEST_P(DracoDamage, AnyChangedByteOfTheHeaderHasADefinedAnswer) {
    for (const bool metadata : {false, true}) {
        const std::string whole = stream(GetParam(), metadata);
        for (std::size_t at = 5; at < std::min<std::size_t>(64, whole.size()); ++at) {
            for (const char change : {'\x01', '\x80', '\xff'}) {
                std::string damaged = whole;
                damaged[at] = static_cast<char>(damaged[at] ^ change);
                expect_defined_answer(damaged, "byte " + std::to_string(at));
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, DracoDamage, testing::Bool(),
                         [](const auto& test) { return test.param ? "Mesh" : "PointCloud"; });

}  // namespace
}  // namespace lpf
