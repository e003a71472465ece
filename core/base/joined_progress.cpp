#include "core/base/joined_progress.h"

#include <algorithm>
#include <mutex>

namespace lpf {

struct JoinedProgress::Sum {
    std::mutex mutex;
    Progress shown;
    double done = 0.0;  // in parts
};

JoinedProgress::JoinedProgress(const Execution& execution, std::string_view phase,
                               std::string_view unit, std::size_t parts)
    : execution_(execution), sum_(std::make_shared<Sum>()) {
    sum_->shown = {.phase = phase, .done = 0, .total = parts, .unit = unit, .fraction = 0.0};
}

Execution JoinedProgress::part(int threads) const {
    Execution part{.threads = threads, .stop = execution_.stop};
    if (!execution_.progress) return part;
    // Shared, as sinks are copied.
    part.progress = [sink = execution_.progress, sum = sum_,
                     before = std::make_shared<double>(0.0)](const Progress& progress) {
        const std::scoped_lock lock(sum->mutex);
        sum->done += std::max(0.0, progress.fraction - *before);
        *before = std::max(*before, progress.fraction);
        // What is missing from rounding alone does not keep a part from being done.
        constexpr double kRounding = 1e-6;
        const auto total = static_cast<double>(sum->shown.total);
        sum->shown.done = static_cast<std::size_t>(std::min(total, sum->done + kRounding));
        sum->shown.fraction = std::min(1.0, sum->done / std::max(1.0, total));
        sink(sum->shown);
    };
    return part;
}

}  // namespace lpf
