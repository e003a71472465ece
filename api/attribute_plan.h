#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/document.h"
#include "api/job_inputs.h"

namespace lpf {

/// What a job does to something that a file holds.
enum class Fate {
    Kept,      ///< each point keeps its own
    Carried,   ///< each new point gets that of the nearest point of the input
    Computed,  ///< made anew
    Dropped,   ///< not in the result
    Unused     ///< the process makes no points
};

[[nodiscard]] std::string_view fate_name(Fate fate);  ///< "kept", ...

struct AttributePlan {
    std::string name;
    std::string element;  ///< "vertex", "face", or as in the file
    Fate fate = Fate::Kept;
    std::string detail;  ///< one sentence: why, how exactly
};

/// The format that the points of a job come in. auto: that of the input, but big-endian input comes
/// back in the machine's order.
[[nodiscard]] FileFormat result_format(const JobInputs& inputs, FileFormat of_input);

/// What becomes of every attribute, face and element: found by doing to a few rows of the document
/// what the job will do to all of them.
/// @param quantization_bits of Draco positions; 0 = exact
[[nodiscard]] std::vector<AttributePlan> plan_attributes(Task task, const Document& document,
                                                         const JobInputs& inputs,
                                                         int quantization_bits);

[[nodiscard]] nlohmann::json to_json(const std::vector<AttributePlan>& plan);

}  // namespace lpf
