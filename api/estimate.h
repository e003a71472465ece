#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "api/codec/document.h"
#include "api/job_inputs.h"
#include "core/auto_parameters.h"

namespace lpf {

/// What a job will have to do, counted before it runs.
struct Workload {
    Task task = Task::Denoise;
    double points = 0;
    double file_bytes = 0;
    double row_bytes = 0;  ///< of the attributes of a point, without its position
    double faces = 0;
    double probed_points = 0;     ///< those that target areas are gathered from: samples of a mesh
    double fields = 0;            ///< LPFs
    double points_per_field = 0;  ///< in a target area
    double output_points = 0;
    bool decoded_apart = false;  ///< the format is decoded and encoded with more effort (Draco)
    bool streamed = false;       ///< read and written part by part, never held
    bool finds_outliers = false;
    bool estimates_normals = false;
};

/// What a job will take. Seconds are those of a machine that does nothing else.
struct Estimate {
    double seconds = 0;
    double memory_bytes = 0;  ///< most that the job holds at a time; rather too high than too low
};

/// A cost model: each step's count times what one unit was measured to cost.
/// @param speed   of this machine relative to the one that the costs were measured on
/// @param threads of the job
[[nodiscard]] Estimate estimate(const Workload& work, const ResolvedParameters& parameters,
                                double speed, int threads);

/// A decoded file with its attributes [bytes].
[[nodiscard]] double document_bytes(const Workload& work);

/// What a decoder or encoder of its own process takes besides [bytes].
[[nodiscard]] double apart_bytes(const Workload& work);

/// Bytes of the attributes in a row of points.
[[nodiscard]] double attribute_row_bytes(const PointCloud& cloud);

/// Points that a process makes, as far as they can be told before.
[[nodiscard]] double expected_points(Task task, double points, double fields,
                                     const ResolvedParameters& parameters);

/// Time that the reference work takes here [seconds]: a short, fixed piece of the method.
[[nodiscard]] double reference_seconds();

/// Speed of this machine relative to the one that the costs were measured on. Measured once, in
/// some 20 milliseconds; later calls cost nothing.
[[nodiscard]] double machine_speed();

[[nodiscard]] nlohmann::json to_json(const Estimate& estimate, const Workload& work, int threads);

}  // namespace lpf
