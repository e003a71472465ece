#pragma once

#include <string>

#include "api/codec/format.h"
#include "api/codec/ply_points.h"
#include "api/limits.h"
#include "api/shape_info.h"
#include "core/auto_parameters.h"
#include "server/jobs/running_job.h"
#include "server/store/mapped_file.h"
#include "server/store/storage.h"

namespace lpf::server {

struct RunnerOptions {
    Limits limits = {};
    int threads = 1;  ///< of each job
    std::string version;
    std::size_t most_in_memory = kMostAtOnce;  ///< points; larger clouds are streamed, if they can
};

/// Does the work of a job, from its shape to its results. Holds no state of a job.
class Runner {
public:
    Runner(Storage& storage, RunnerOptions options);

    /// @throws Error, ProblemException
    [[nodiscard]] JobOutcome run(RunningJob& job) const;

private:
    /// The story of a job that holds its shape.
    [[nodiscard]] JobOutcome run(RunningJob& job, const MappedFile& file) const;
    /// The story of one that reads it part by part.
    [[nodiscard]] JobOutcome run(RunningJob& job, const ShapeInfo& shape,
                                 const PlyPoints& points) const;

    [[nodiscard]] ShapeInfo find_shape(const std::string& shape_id) const;
    [[nodiscard]] Dictionary load_dictionary(const std::string& dictionary_id) const;
    [[nodiscard]] ResolvedParameters resolve(RunningJob& job, const Shape& shape,
                                             const Measurements& measurements) const;
    [[nodiscard]] Execution execution(RunningJob& job, double low, double high) const;

    Storage& storage_;
    RunnerOptions options_;
};

}  // namespace lpf::server
