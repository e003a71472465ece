#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace lpf {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored \
    "-Wshadow"  // g++ 12 takes scoped names for those of lpf::Points, ...
/// What a job can leave behind.
enum class ResultKind { Points, Dictionary, Report, Fields };
#pragma GCC diagnostic pop

[[nodiscard]] std::string_view result_name(ResultKind kind);  ///< "points", ...

/// One result of a job as GET /v1/jobs/{id}/results lists it.
struct ResultFile {
    ResultKind kind = ResultKind::Points;
    std::string type;  ///< media type
    std::uint64_t bytes = 0;
    std::string sha256;
};

/// {"points": {href, type, bytes, sha256}, ...}
[[nodiscard]] nlohmann::json results_to_json(std::string_view job_id,
                                             const std::vector<ResultFile>& files);

}  // namespace lpf
