#pragma once

#include <vector>

#include "core/shape/spread.h"

namespace lpf {

/// What balls whose points scatter more than noise should, or not as it should, hold.
struct HiddenSheets {
    double share = 0.0;          ///< of the variance that is the distance of two sheets, not noise
    bool are_parted = false;     ///< they are so far apart that many balls tell them apart
    bool is_flat_noise = false;  ///< there are none: noise itself is flatter than a Gaussian
};

/// Two sheets that noise hides, or flat noise, as that of rounded coordinates? Either has a small
/// kurtosis, but between two sheets lie fewer points than about the middle of flat noise.
/// @param spreads of balls of one size that hold both sheets, if there are two
[[nodiscard]] HiddenSheets find_hidden_sheets(const std::vector<Spread>& spreads);

}  // namespace lpf
