// Any bytes as a PLY file: decoded or refused in words; what was decoded can be written in every
// kind of PLY and comes back the same.

#include <array>

#include "api/codec/ply.h"
#include "api/codec/summary.h"
#include "tests/api/codec/sample_documents.h"
#include "tests/fuzz/same_document.h"
#include "tests/fuzz/target.h"

namespace lpf::fuzz {
namespace {

constexpr std::array kKinds{FileFormat::PlyBinary, FileFormat::PlyBigEndian, FileFormat::PlyAscii};

DecodeLimits tight_limits() {
    DecodeLimits limits;
    limits.max_points = 4096;
    limits.max_faces = 4096;
    limits.decode_helper.clear();
    return limits;
}

void require_round_trip(const Document& document, FileFormat kind) {
    EncodeOptions options;
    options.format = kind;
    options.double_positions = document.double_positions;
    std::vector<Warning> lost;
    const std::string file = encode_ply(document, options, lost);
    Document again;
    try {
        again = decode_ply(bytes_of(file), tight_limits());
    } catch (const Error& error) {
        require(false, error.what());
    }
    if (!lost.empty()) return;  // names were changed, and it was said
    const auto nan_bits = kind == FileFormat::PlyAscii ? NanBits::AnyNan : NanBits::Compared;
    require(same_document(document, again, nan_bits), "what is written is what is read");
}

/// A summary reads the same file in another way, and must see the same.
void require_summary(std::span<const std::byte> bytes, const Document& document) {
    try {
        const FileSummary summary = summarize(bytes, tight_limits(), {});
        require(summary.points == document.shape.size(), "a summary counts the points");
        require(summary.faces == document.face_count(), "a summary counts the faces");
        require(summary.sample == document.shape.cloud.points, "a summary sees every point");
        require(summary.columns.size() == document.shape.cloud.attributes.size(),
                "a summary names the columns");
        require(summary.warnings.size() == document.warnings.size(), "a summary warns as well");
    } catch (const Error& error) {
        require(false, error.what());
    }
}

void require_refused_summary(std::span<const std::byte> bytes) {
    try {
        (void)summarize(bytes, tight_limits(), {});
    } catch (const Error&) {
        return;
    }
    require(false, "what cannot be decoded cannot be summarised");
}

}  // namespace

std::vector<std::string> seeds() {
    std::vector<std::string> files;
    for (const Document& document : {points_with_every_type(), mesh_with_everything()}) {
        for (const FileFormat kind : kKinds) {
            EncodeOptions options;
            options.format = kind;
            files.push_back(written(document, options));
        }
    }
    files.emplace_back(
        "ply\rformat ascii 1.0\rcomment old\relement vertex 2\rproperty double x\r"
        "property double y\rproperty int z\rend_header\r1.#QNAN 1e400 +3\r-0 .5 2.0\r");
    return files;
}

}  // namespace lpf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lpf;
    const auto bytes = std::as_bytes(std::span(data, size));
    if (sniff(bytes) == FileFormat::Draco) return 0;
    Document document;
    try {
        document = decode_ply(bytes, fuzz::tight_limits());
    } catch (const Error& error) {
        fuzz::require(
            error.code() == ErrorCode::MalformedFile || error.code() == ErrorCode::LimitExceeded,
            "a file that is not read is malformed or too large");
        fuzz::require_refused_summary(bytes);
        return 0;
    }
    fuzz::require_summary(bytes, document);
    for (const FileFormat kind : fuzz::kKinds) fuzz::require_round_trip(document, kind);
    return 0;
}
