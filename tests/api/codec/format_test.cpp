#include "api/codec/format.h"

#include <gmock/gmock.h>

#include "tests/api/codec/sample_documents.h"

namespace lpf {
namespace {

using testing::HasSubstr;

TEST(Sniff, TellsThePlyKindsApartByContent) {
    EXPECT_EQ(sniff(bytes_of("ply\nformat ascii 1.0\n")), FileFormat::PlyAscii);
    EXPECT_EQ(sniff(bytes_of("ply\r\nformat binary_little_endian 1.0\r\n")), FileFormat::PlyBinary);
    EXPECT_EQ(sniff(bytes_of("ply\rcomment a\rformat binary_big_endian 1.0\r")),
              FileFormat::PlyBigEndian);
}

TEST(Sniff, KnowsDracoByItsMagic) {
    EXPECT_EQ(sniff(bytes_of("DRACO\x02\x02")), FileFormat::Draco);
}

TEST(Sniff, FindsNothingInOtherContent) {
    for (const char* text : {"", "pl", "ply", "plyy\n", "PLY\n", "DRAC", "OFF\n", "v 0 0 0\n"}) {
        EXPECT_EQ(sniff(bytes_of(text)), std::nullopt) << text;
    }
}

TEST(Format, NamesAreReadBackAsTheSameFormat) {
    for (const FileFormat format : all_formats()) {
        EXPECT_EQ(parse_format_name(format_name(format)), format);
    }
    EXPECT_EQ(parse_format_name("PLY"), std::nullopt);
    EXPECT_EQ(parse_format_name("obj"), std::nullopt);
}

TEST(Format, EveryFormatHasAnExtensionAndAMediaType) {
    EXPECT_EQ(all_formats().size(), 4U);
    EXPECT_EQ(file_extension(FileFormat::PlyAscii), "ply");
    EXPECT_EQ(file_extension(FileFormat::Draco), "drc");
    EXPECT_EQ(media_type(FileFormat::PlyBinary), media_type(FileFormat::PlyBigEndian));
    EXPECT_NE(media_type(FileFormat::PlyBinary), media_type(FileFormat::Draco));
}

struct Foreign {
    std::string name;
    std::string bytes;
    std::string said;
};

void PrintTo(const Foreign& foreign, std::ostream* out) { *out << foreign.name; }

class ForeignFile : public testing::TestWithParam<Foreign> {};

TEST_P(ForeignFile, IsRefusedByContentAndNamed) {
    const auto error = refusal(GetParam().bytes);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code(), ErrorCode::UnsupportedFormat);
    EXPECT_THAT(error->what(), HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    Content, ForeignFile,
    testing::Values(
        Foreign{"Empty", "", "an empty file"},
        Foreign{"LfsPointer", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
                "Git LFS pointer"},
        Foreign{"Off", "OFF\n353535235358 6 0\n0 0 0\n", "OFF mesh"},
        Foreign{"Obj", "# made by hand\nv 0 0 0\nf 1 1 1", "OBJ"},
        Foreign{"Las", "LASF" + std::string(200, '\0'), "LAS"},
        Foreign{"Pcd", "# .PCD v0.7 - Point Cloud Data\nVERSION 0.7\n", "PCD"},
        Foreign{"PcdWithoutComment", "VERSION .7\nFIELDS x y z\n", "PCD"},
        Foreign{"XyzText", "\n665187.52 5648349.89 241.76 117 73 49\n", "XYZ"},
        Foreign{"Gzip", std::string("\x1f\x8b\x08\x00", 4) + "ply\nformat", "gzip"},
        Foreign{"Zip", "PK\x03\x04zip", "ZIP"},
        Foreign{"Html", "  <!DOCTYPE html><html></html>", "HTML"},
        Foreign{"Stl", "solid cube\nfacet normal 0 0 1\n", "STL"},
        Foreign{"ByteOrderMark", "\xef\xbb\xbfply\nformat ascii 1.0\n", "byte order mark"},
        Foreign{"UpperCaseMagic", "PLY\nformat ascii 1.0\n", "begins with 'PLY"},
        Foreign{"Binary", std::string("\0\1\2\3", 4), "\\x00\\x01"}),
    [](const auto& test) { return test.param.name; });

TEST(Encode, RefusesQuantizationOutsideItsRange) {
    for (const int bits : {-1, 31}) {
        EncodeOptions options;
        options.format = FileFormat::Draco;
        options.quantization_bits = bits;
        try {
            (void)written(points_with_every_type(), options);
            ADD_FAILURE() << bits;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
            EXPECT_EQ(error.field(), "quantizationBits");
        }
    }
}

}  // namespace
}  // namespace lpf
