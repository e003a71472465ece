#pragma once

#include <span>
#include <string>

#include "api/codec/format.h"
#include "api/codec/ply_points.h"
#include "api/report.h"
#include "core/base/parallel.h"
#include "server/jobs/running_job.h"
#include "server/store/storage.h"

namespace lpf::server {

/// Encodes the results of one job and stores their bytes. What a format cannot hold becomes a
/// warning.
class ResultWriter {
public:
    /// @param execution  of the encoding and storing; a stop ends either with Error{Cancelled}
    ResultWriter(Storage& storage, RunningJob& job, std::string version, Execution execution);

    void add_points(const Document& document, const JobInputs& inputs,
                    const Measurements& measurements);
    /// The points of a file, moved. @param finite how many of them are finite
    WrittenPoints add_moved(const PlyPoints& points, std::span<const Eigen::Vector3f> moves,
                            std::uint64_t finite);
    void add_dictionary(const AnalysisResult& analysis);
    void add_fields(const AnalysisResult& analysis);
    void add_report(const Report& report);

    /// Call once, at the end.
    [[nodiscard]] JobOutcome take_outcome() { return std::move(outcome_); }

private:
    void store(ResultKind kind, std::string_view type, const std::string& bytes);
    void keep(ResultKind kind, std::string_view type, BlobWriter& writer);
    [[nodiscard]] std::string made_by() const { return "made by lpf-server " + version_; }

    Storage& storage_;
    RunningJob& job_;
    std::string version_;
    Execution execution_;
    JobOutcome outcome_;
};

/// Bits that a Draco result needs: what was asked for, or enough for the spacing.
[[nodiscard]] int quantization_bits(const JobInputs& inputs, const Points& points,
                                    double mean_spacing);

}  // namespace lpf::server
