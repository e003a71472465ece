#include "core/field/target_area.h"

#include "core/base/kernels.h"

namespace lpf {

void TargetArea::to_frame(const Frame& frame) {
    Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes = frame.axes;
    kernels::to_frame(axes.data(), frame.origin.data(), x.data(), y.data(), z.data(), size);
}

}  // namespace lpf
