// Any bytes as a Draco stream, up to where its decoder would be started: the claims are read and
// compared with the limits, or the stream is refused in words.

#include "api/codec/draco_claim.h"
#include "tests/api/codec/sample_documents.h"
#include "tests/fuzz/target.h"

namespace lpf::fuzz {

std::vector<std::string> seeds() {
    std::vector<std::string> files;
    for (const Document& document : {points_with_every_type(), mesh_with_everything()}) {
        EncodeOptions options;
        options.format = FileFormat::Draco;
        files.push_back(written(document, options));
    }
    Document bare;
    bare.shape.cloud.points = Points::Ones(3, 300);
    EncodeOptions options{.format = FileFormat::Draco, .quantization_bits = 11};
    files.push_back(written(bare, options));
    bare.shape.triangles = Triangles::Zero(3, 200);
    files.push_back(written(bare, options));
    files.push_back(std::string("DRACO\1\1\1\1\0\0\0", 12) + std::string(40, '\1'));  // edgebreaker
    files.push_back(std::string("DRACO\2\2\1\1\0\0\0\4\2", 14) + std::string(40, '\1'));
    return files;
}

}  // namespace lpf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lpf;
    const DecodeLimits limits{.max_points = 100'000, .max_faces = 200'000, .decode_helper = {}};
    try {
        const DracoClaim claim = read_draco_claim(std::as_bytes(std::span(data, size)));
        check_draco_claim(claim, size, limits);
        fuzz::require(claim.points <= limits.max_points && claim.faces <= limits.max_faces,
                      "a checked claim keeps to the limits");
        fuzz::require(claim.points <= 1024 * size && claim.faces <= 1024 * size,
                      "a checked claim can lie in the bytes there are");
        fuzz::require(claim.major == 1 || claim.major == 2, "only known versions pass");
    } catch (const Error& error) {
        fuzz::require(error.code() == ErrorCode::MalformedFile ||
                          error.code() == ErrorCode::UnsupportedFormat ||
                          error.code() == ErrorCode::LimitExceeded,
                      "a stream that is refused is malformed, unknown or too large");
    }
    return 0;
}
