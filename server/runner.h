#pragma once

#include <string>

#include "api/codec/format.h"
#include "api/limits.h"
#include "core/auto_parameters.h"
#include "server/running_job.h"
#include "server/storage.h"

namespace lpf::server {

struct RunnerOptions {
    Limits limits = {};
    int threads = 1;  ///< of each job
    std::string version;
};

/// Limits of decoding that follow from those of the service.
[[nodiscard]] DecodeLimits decode_limits(const Limits& limits);

/// Does the work of a job, from its shape to its results. Holds no state of a job.
class Runner {
public:
    Runner(Storage& storage, RunnerOptions options);

    /// @throws Error, ProblemException
    [[nodiscard]] JobOutcome run(RunningJob& job) const;

private:
    [[nodiscard]] Document load_shape(const std::string& shape_id,
                                      const Execution& execution) const;
    [[nodiscard]] Dictionary load_dictionary(const std::string& dictionary_id) const;
    [[nodiscard]] ResolvedParameters resolve(RunningJob& job, const Document& document,
                                             const Measurements& measurements) const;
    [[nodiscard]] Execution execution(RunningJob& job, double low, double high) const;

    Storage& storage_;
    RunnerOptions options_;
};

}  // namespace lpf::server
