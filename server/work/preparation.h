#pragma once

#include "api/codec/document.h"
#include "api/job_inputs.h"
#include "api/report.h"
#include "api/shape_info.h"
#include "server/jobs/running_job.h"
#include "server/work/computation.h"

namespace lpf::server {

/// A report that knows what came in.
[[nodiscard]] Report start_report(const StatusInfo& job, const Document& document,
                                  const std::string& version, int threads);

/// The same of a shape that is not held. @param rows of the file, also those that are not finite
[[nodiscard]] Report start_report(const StatusInfo& job, const ShapeInfo& shape, std::size_t rows,
                                  const std::string& version, int threads);

/// Warns of points that repeat the position of an earlier one, if there are any.
void tell_duplicates(std::uint64_t count, DuplicatePolicy policy, RunningJob& job);

/// Finds duplicates and outliers, and keeps, marks or removes them as the inputs say.
[[nodiscard]] Document apply_policies(Document document, const JobInputs& inputs,
                                      const Execution& execution, RunningJob& job, Report& report);

/// Gives the computed points the attributes of the points that they come from, as the inputs say,
/// and measures how far points went.
[[nodiscard]] Document carry_attributes(Document document, Computation& result,
                                        const JobInputs& inputs, const Execution& execution,
                                        RunningJob& job, Report& report);

/// Adds what the computation found.
void finish_report(Report& report, const AnalysisResult& analysis,
                   const std::vector<double>& rms_moves, const StatusInfo& job);

}  // namespace lpf::server
