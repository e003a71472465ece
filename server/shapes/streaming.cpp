#include "server/shapes/streaming.h"

namespace lpf::server {

DecodeLimits decode_limits(const Limits& limits) {
    DecodeLimits out;
    out.max_points = limits.points;
    out.max_faces = limits.faces;
    return out;
}

bool can_stream(Task task, const JobInputs& inputs) {
    return task == Task::Denoise &&
           inputs.outliers.value_or(OutlierPolicy::Keep) == OutlierPolicy::Keep &&
           inputs.duplicates.value_or(DuplicatePolicy::Keep) == DuplicatePolicy::Keep &&
           inputs.attributes.value_or(AttributePolicy::Keep) == AttributePolicy::Keep &&
           inputs.normals.value_or(NormalPolicy::Keep) == NormalPolicy::Keep &&
           inputs.format.value_or(FileFormat::PlyBinary) == FileFormat::PlyBinary;
}

std::optional<PlyPoints> streamed_points(Task task, const JobInputs& inputs, const MappedFile& file,
                                         const Limits& limits, std::size_t most) {
    if (!can_stream(task, inputs)) return std::nullopt;
    auto points = PlyPoints::open(file.bytes(), decode_limits(limits),
                                  [&file] { file.let_go(file.bytes().size()); });
    if (points && points->size() <= most) return std::nullopt;
    return points;
}

std::vector<float> lengths_of(const std::vector<Eigen::Vector3f>& moves, std::size_t finite) {
    std::vector<float> lengths;
    lengths.reserve(moves.size());
    // Points that are not finite do not move: as many zeros are none of the others.
    std::size_t others = moves.size() - finite;
    for (const Eigen::Vector3f& move : moves) {
        const float length = move.norm();
        if (length == 0 && others > 0) {
            --others;
        } else {
            lengths.push_back(length);
        }
    }
    return lengths;
}

}  // namespace lpf::server
