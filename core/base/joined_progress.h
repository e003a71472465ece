#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "core/base/parallel.h"

namespace lpf {

/// The progress of parts that are worked on at the same time, as one rising fraction.
class JoinedProgress {
public:
    /// @param unit what the parts are called, e.g. "tiles"  @param parts how many there are
    JoinedProgress(const Execution& execution, std::string_view phase, std::string_view unit,
                   std::size_t parts);

    /// To work on one more of them with.
    [[nodiscard]] Execution part(int threads) const;

private:
    struct Sum;
    Execution execution_;
    std::shared_ptr<Sum> sum_;
};

}  // namespace lpf
