#pragma once

#include "api/codec/document.h"
#include "api/job_inputs.h"
#include "api/report.h"
#include "server/computation.h"
#include "server/running_job.h"

namespace lpf::server {

/// A report that knows what came in.
[[nodiscard]] Report start_report(const StatusInfo& job, const Document& document,
                                  const std::string& version, int threads);

/// Finds duplicates and outliers, and keeps, marks or removes them as the inputs say.
[[nodiscard]] Document apply_policies(Document document, const JobInputs& inputs,
                                      const Execution& execution, RunningJob& job, Report& report);

/// Gives the computed points the attributes of the points that they come from, as the inputs say,
/// and measures how far points went.
[[nodiscard]] Document carry_attributes(Document document, Computation& result,
                                        const JobInputs& inputs, const Execution& execution,
                                        RunningJob& job, Report& report);

/// Adds what the computation found.
void finish_report(Report& report, const Computation& result, const StatusInfo& job);

}  // namespace lpf::server
