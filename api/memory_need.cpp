#include "api/memory_need.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "api/attribute_plan.h"
#include "api/codec/draco_claim.h"
#include "api/estimate.h"
#include "api/problem.h"

namespace lpf {
namespace {

constexpr double kDocumentPerByte = 4;  // of a PLY: "0 0 0" of a text are three doubles
/// There are never more LPFs than points that they are placed on, and by far fewer of the automatic
/// radius.
constexpr double kMostFieldsPerPoint = 0.05;

constexpr double kUnknownRow = 16;  // attributes of a point

double type_bytes(const std::string& type) {
    const std::size_t digits = type.find_first_of("0123456789");
    return digits == std::string::npos ? 8.0 : std::stod(type.substr(digits)) / 8.0;
}

/// Of the attributes of a point; lists are told from the size of the file.
double row_bytes(const ShapeInfo& shape) {
    double bytes = 0;
    bool lists = false;
    for (const AttributeInfo& attribute : shape.attributes) {
        bytes += attribute.list ? 8.0 : type_bytes(attribute.type);
        lists = lists || attribute.list;
    }
    if (!lists) return bytes;
    return bytes + static_cast<double>(shape.bytes) /
                       static_cast<double>(std::max<std::uint64_t>(shape.points, 1));
}

bool is_draco(const JobInputs& inputs, const ShapeInfo& shape) {
    return shape.format == file_extension(FileFormat::Draco) || inputs.format == FileFormat::Draco;
}

/// @param fields per point
Workload workload(Task task, const JobInputs& inputs, const ShapeInfo& shape, double fields) {
    const auto points = static_cast<double>(shape.points);
    return {.task = task,
            .points = points,
            .file_bytes = static_cast<double>(shape.bytes),
            .row_bytes = row_bytes(shape),
            .faces = static_cast<double>(shape.faces),
            .probed_points = points,
            .fields = fields * points,
            .output_points = points,
            .decoded_apart = is_draco(inputs, shape)};
}

/// As far as memory depends on them. The radius cancels out, unless points are asked for by their
/// spacing.
ResolvedParameters parameters(Task task, const JobInputs& inputs, Workload& work) {
    ResolvedParameters p;
    AnalysisParams& a = p.analysis;
    a.radius = 1;
    a.pattern.points = static_cast<int>(inputs.pattern_points.value_or(a.pattern.points));
    a.atoms = static_cast<int>(inputs.atoms.value_or(a.atoms));
    if (task != Task::Resample) return p;
    if (inputs.target_points) work.output_points = static_cast<double>(*inputs.target_points);
    if (inputs.factor) work.output_points = *inputs.factor * work.points;
    p.resample.denoise = DenoiseParams{};
    return p;
}

/// What does not follow from the number of points: samples of a mesh, results of a certain spacing,
/// patterns of a dictionary.
bool needs_a_look(Task task, const JobInputs& inputs, const ShapeInfo& shape) {
    const bool samples = task != Task::Denoise && shape.faces > 0;
    return samples || inputs.target_spacing || inputs.dictionary ||
           inputs.probing == ProbingKind::NearestTriangle;
}

/// What a Draco stream claims, as far as it will be believed.
Workload claimed(std::span<const std::byte> file, const Limits& limits) {
    const DracoClaim claim = read_draco_claim(file);
    return {.points = static_cast<double>(std::min(claim.points, limits.points)),
            .row_bytes = kUnknownRow,
            .faces = static_cast<double>(std::min(claim.faces, limits.faces)),
            .decoded_apart = true};
}

double bytes_with(Task task, const JobInputs& inputs, const ShapeInfo& shape, double fields,
                  int streaming_threads) {
    Workload work = workload(task, inputs, shape, fields);
    work.streamed = streaming_threads > 0;
    const ResolvedParameters p = parameters(task, inputs, work);
    return estimate(work, p, 1.0, std::max(1, streaming_threads)).memory_bytes;
}

std::string mebibytes(double bytes) {
    std::ostringstream out;
    out << static_cast<std::uint64_t>(std::ceil(bytes / (1 << 20))) << " MiB";
    return out.str();
}

}  // namespace

MemoryRange memory_range(Task task, const JobInputs& inputs, const ShapeInfo& shape,
                         int streaming_threads) {
    const double most = streaming_threads > 0 && !inputs.radius ? kMostFieldsPerPoint : 1.0;
    MemoryRange range{.least = bytes_with(task, inputs, shape, 0.0, streaming_threads)};
    if (!needs_a_look(task, inputs, shape)) {
        range.most = bytes_with(task, inputs, shape, most, streaming_threads);
    }
    return range;
}

double summary_bytes(std::span<const std::byte> file, const Limits& limits) {
    if (sniff(file) != FileFormat::Draco) return kLookBytes;
    const Workload work = claimed(file, limits);
    return kLookBytes + apart_bytes(work);
}

double decoding_bytes(std::span<const std::byte> file, const Limits& limits) {
    if (sniff(file) != FileFormat::Draco)
        return kLookBytes + kDocumentPerByte * static_cast<double>(file.size());
    const Workload work = claimed(file, limits);
    return kLookBytes + document_bytes(work) + apart_bytes(work);
}

void require_memory(double needed, std::uint64_t budget) {
    if (needed <= static_cast<double>(budget)) return;
    Problem problem{.problem = ProblemCode::OutOfMemory};
    problem.detail = "The job would need about " + mebibytes(needed) +
                     " of memory; all jobs together may use " +
                     mebibytes(static_cast<double>(budget)) +
                     " (memoryBytes). Ask for less: fewer points of the result, a smaller pattern, "
                     "fewer points of the shape. Or give the server more memory.";
    problem.members = {{"limitName", std::string("memoryBytes")},
                       {"limit", static_cast<std::int64_t>(budget)},
                       {"estimate", static_cast<std::int64_t>(needed)}};
    throw ProblemException(std::move(problem));
}

}  // namespace lpf
