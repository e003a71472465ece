#pragma once

#include "core/field/frame.h"
#include "core/shape/point_grid.h"

namespace lpf {

/// The points of the shape that one LPF accounts for (paper Sec. 3.1), in units of the LPF's
/// radius.
struct TargetArea : NearPoints {
    /// From centre-relative coordinates to those of the frame.
    void to_frame(const Frame& frame);
};

}  // namespace lpf
