#include "server/shapes/subject.h"

#include <utility>

#include "api/codec/faces.h"
#include "api/memory_need.h"
#include "server/shapes/streaming.h"

namespace lpf::server {
namespace {

constexpr std::size_t kExaminedPoints = 200'000;
constexpr std::size_t kFirstRows = 64;

Subject held_subject(Document document) {
    Subject subject{.document = std::move(document), .points = 0, .bounds = {}, .part = {}};
    const Shape& shape = subject.document.shape;
    subject.points = shape.size();
    if (shape.size() > 0) subject.bounds = bounds_of(shape.cloud.points);
    subject.part = part_of_shape(shape, kExaminedPoints);
    return subject;
}

}  // namespace

Subject streamed_subject(const PlyPoints& points, const DecodeLimits& limits,
                         const Execution& execution) {
    const Sketch sketch = make_sketch(points, execution);
    Subject subject{.document = first_rows(points, kFirstRows, limits),
                    .points = sketch.of,
                    .bounds = {},
                    .part = {},
                    .streamed = true};
    subject.document.warnings.clear();
    if (sketch.of < points.size()) {
        subject.document.warnings.push_back(
            dropped_points_warning(points.size() - sketch.of, points.size()));
    }
    if (sketch.of > 0) {
        subject.bounds = Bounds{sketch.low, sketch.high};
        subject.part = part_of_points(points, sketch, kExaminedPoints, execution);
    }
    return subject;
}

double subject_bytes(const Question& question, const MappedFile& file, const Limits& limits) {
    const bool streamed = streamed_points(question.task, question.inputs, file, limits).has_value();
    return streamed ? kLookBytes : decoding_bytes(file.bytes(), limits);
}

Subject read_subject(const Question& question, const MappedFile& file, const Limits& limits,
                     const Execution& execution) {
    const auto points = streamed_points(question.task, question.inputs, file, limits);
    return points ? streamed_subject(*points, decode_limits(limits), execution)
                  : held_subject(decode(file.bytes(), decode_limits(limits), execution));
}

}  // namespace lpf::server
