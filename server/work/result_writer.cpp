#include "server/work/result_writer.h"

#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "api/fields_document.h"
#include "api/json_text.h"
#include "server/ids.h"

namespace lpf::server {
namespace {

constexpr std::size_t kPiece = 8U << 20U;  // bytes between two questions whether to stop

/// auto: the format of the input, but big-endian input comes back in the machine's order.
FileFormat chosen_format(const JobInputs& inputs, const Document& document) {
    if (inputs.format) return *inputs.format;
    return document.format == FileFormat::PlyBigEndian ? FileFormat::PlyBinary : document.format;
}

}  // namespace

int quantization_bits(const JobInputs& inputs, const Points& points, double mean_spacing) {
    if (inputs.quantization_bits) return static_cast<int>(*inputs.quantization_bits);
    const Bounds bounds = bounds_of(points);
    return automatic_quantization_bits((bounds.maximum - bounds.minimum).norm(), mean_spacing);
}

ResultWriter::ResultWriter(Storage& storage, RunningJob& job, std::string version,
                           Execution execution)
    : storage_(storage), job_(job), version_(std::move(version)), execution_(std::move(execution)) {
    outcome_.files_held = FileHold(storage_);
}

void ResultWriter::store(ResultKind kind, std::string_view type, const std::string& bytes) {
    const auto writer = storage_.blobs().create();
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
        throw_if_cancelled(execution_);
        writer->write(std::string_view(bytes).substr(at, kPiece));
    }
    keep(kind, type, *writer);
}

void ResultWriter::keep(ResultKind kind, std::string_view type, BlobWriter& writer) {
    throw_if_cancelled(execution_);
    const std::uint64_t bytes = writer.size();
    outcome_.results.push_back(
        {kind, std::string(type), bytes, outcome_.files_held.commit(writer)});
}

void ResultWriter::add_points(const Document& document, const JobInputs& inputs,
                              const Measurements& measurements) {
    EncodeOptions options;
    options.format = chosen_format(inputs, document);
    options.double_positions = document.double_positions;
    options.comments = {made_by()};
    if (options.format == FileFormat::Draco) {
        options.quantization_bits =
            quantization_bits(inputs, document.shape.cloud.points, measurements.mean_spacing);
    }
    std::vector<Warning> lost;
    const std::string bytes = encode(document, options, lost, execution_);
    for (const Warning& warning : lost) job_.warn(warning.code, warning.detail);
    store(ResultKind::Points, media_type(options.format), bytes);
}

WrittenPoints ResultWriter::add_moved(const PlyPoints& points,
                                      std::span<const Eigen::Vector3f> moves,
                                      std::uint64_t finite) {
    const auto writer = storage_.blobs().create();
    const WrittenPoints written = write_moved(
        points, moves, finite, made_by(), [&](std::string_view piece) { writer->write(piece); },
        execution_);
    keep(ResultKind::Points, media_type(FileFormat::PlyBinary), *writer);
    return written;
}

void ResultWriter::add_dictionary(const AnalysisResult& analysis) {
    const StatusInfo info = job_.info();
    const UnixMillis now = now_millis();
    const DictionaryDocument document =
        make_dictionary_document(analysis, new_id(), info.job_id, now);
    store(ResultKind::Dictionary, "application/json", dump_json(to_json(document)));
    outcome_.dictionary =
        StoredDictionary{document.id, info.job_id, outcome_.results.back().sha256,
                         now,         0,           dump_json(summary_to_json(document))};
}

void ResultWriter::add_fields(const AnalysisResult& analysis) {
    std::vector<Warning> lost;
    const std::string bytes =
        encode(fields_document(analysis),
               {.format = FileFormat::PlyBinary, .double_positions = true}, lost, execution_);
    store(ResultKind::Fields, media_type(FileFormat::PlyBinary), bytes);
}

void ResultWriter::add_report(const Report& report) {
    store(ResultKind::Report, "application/json", dump_json(to_json(report)));
}

}  // namespace lpf::server
