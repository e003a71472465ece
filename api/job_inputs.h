#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "api/codec/format.h"
#include "api/limits.h"
#include "core/auto_parameters.h"

namespace lpf {

enum class RadiusUnit { Absolute, Spacing, Diagonal };  ///< of `radius`
enum class OutlierPolicy { Keep, Mark, Remove };
enum class DuplicatePolicy { Keep, Remove };
enum class AttributePolicy { Keep, Drop };
enum class NormalPolicy { Keep, Estimate, Drop };
enum class DictionaryMode { Start, Fixed };

/// What the client asked of a process. Empty = "auto". The names are those of the wire.
struct JobInputs {
    std::optional<double> radius = {};           ///< [radius_unit]
    std::optional<RadiusUnit> radius_unit = {};  ///< auto: Absolute
    std::optional<std::int64_t> pattern_points = {};
    std::optional<std::int64_t> atoms = {};
    std::optional<double> lambda = {};
    std::optional<std::int64_t> analysis_iterations = {};
    std::optional<std::int64_t> denoise_iterations = {};
    std::optional<double> gamma = {};           ///< auto: the full step
    std::optional<double> target_spacing = {};  ///< [input length]
    std::optional<std::int64_t> target_points = {};
    std::optional<double> factor = {};
    std::optional<OutlierPolicy> outliers = {};          ///< auto: Keep
    std::optional<DuplicatePolicy> duplicates = {};      ///< auto: Keep
    std::optional<AttributePolicy> attributes = {};      ///< auto: Keep
    std::optional<NormalPolicy> normals = {};            ///< auto: Keep
    std::optional<std::string> dictionary = {};          ///< ID of a stored dictionary
    std::optional<DictionaryMode> dictionary_mode = {};  ///< auto: Start
    std::optional<ProbingKind> probing = {};
    std::optional<std::int64_t> random_seed = {};  ///< auto: 1
    std::optional<FileFormat> format = {};         ///< auto: that of the input
    std::optional<std::int64_t> quantization_bits =
        {};                                  ///< 0 = exact; auto: see automatic_quantization_bits
    std::optional<double> max_seconds = {};  ///< auto: limits.job_seconds

    bool operator==(const JobInputs&) const = default;
};

/// Inputs from the JSON object "inputs", without its member "shape". Every fault is collected.
/// @param pointer where the object lies in the request, for the errors: "/inputs"
/// @throws ProblemException{InvalidParameter} with one entry in `errors` per fault
[[nodiscard]] JobInputs inputs_from_json(Task task, const nlohmann::json& inputs,
                                         const Limits& limits,
                                         const std::string& pointer = "/inputs");

/// Inputs from a query string or from the text fields of a multipart body, already percent-decoded.
/// Numbers come as text here; an empty value is a fault; so is a name given twice.
/// @throws as inputs_from_json; pointers are those of the JSON form ("/inputs/radius")
[[nodiscard]] JobInputs inputs_from_query(Task task,
                                          const std::multimap<std::string, std::string>& query,
                                          const Limits& limits);

/// Body of a JSON execution request.
struct ExecuteRequest {
    std::string shape;  ///< ID of an uploaded shape
    JobInputs inputs;
};

/// {"inputs": {"shape": ID or {"href": "/v1/shapes/ID"}, ...}}
/// @throws ProblemException{InvalidParameter} with one entry per fault
[[nodiscard]] ExecuteRequest execute_request_from_json(Task task, const nlohmann::json& body,
                                                       const Limits& limits);

/// Every parameter of the process, "auto" where nothing was asked: stored with the job and shown as
/// its `parameters`.
[[nodiscard]] nlohmann::json to_json(Task task, const JobInputs& inputs);

/// The inverse, for what was stored: no limit is applied again, unknown names are passed over.
[[nodiscard]] JobInputs stored_inputs_from_json(const nlohmann::json& json);

/// The request to the method, lengths in the input's unit. The caller loads the dictionary.
[[nodiscard]] ParameterRequest to_request(const JobInputs& inputs,
                                          const Measurements& measurements);

/// Refuses a factor that asks for more points than a result may have.
/// @throws lpf::Error{LimitExceeded, "factor"}
void check_result_size(const JobInputs& inputs, std::uint64_t input_points, const Limits& limits);

/// Bits of Draco positions such that one step is under a hundredth of the mean spacing: 11 to 24.
[[nodiscard]] int automatic_quantization_bits(double diagonal, double mean_spacing);

}  // namespace lpf
