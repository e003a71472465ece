#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "api/codec/document.h"
#include "api/codec/ply_points.h"
#include "api/job_inputs.h"
#include "api/limits.h"
#include "api/shape_info.h"
#include "server/shapes/examination.h"
#include "server/store/mapped_file.h"

namespace lpf::server {

/// What is asked of a shape.
struct Question {
    Task task = Task::Denoise;
    const JobInputs& inputs;
    std::uint64_t file_bytes = 0;
};

/// A shape, as far as a request looks at it.
struct Subject {
    Document document;             ///< of a streamed shape the first rows alone
    std::size_t points = 0;        ///< finite ones
    std::optional<Bounds> bounds;  ///< none without points
    ShapePart part;                ///< that is looked at
    bool streamed = false;         ///< the job will not hold it, either

    [[nodiscard]] double diagonal() const {
        return bounds ? (bounds->maximum - bounds->minimum).norm() : 0.0;
    }
};

/// Memory that it takes to read the subject [bytes].
[[nodiscard]] double subject_bytes(const Question& question, const MappedFile& file,
                                   const Limits& limits);

/// @throws as decode
[[nodiscard]] Subject read_subject(const Question& question, const MappedFile& file,
                                   const Limits& limits, const Execution& execution);

/// Of a shape that the job streams.
[[nodiscard]] Subject streamed_subject(const PlyPoints& points, const DecodeLimits& limits,
                                       const Execution& execution);

}  // namespace lpf::server
