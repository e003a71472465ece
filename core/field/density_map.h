#pragma once

#include "core/field/disk_raster.h"
#include "core/field/piece.h"

namespace lpf {

/// How densely the members of a piece lie over its disk: a piece says less where it has no points.
/// On surfaces also less where many other points are near, since another part of the shape is.
class DensityMap {
public:
    /// Counts the members of a flattened target area.
    /// @param reach members lie no further off than this [radius]
    void count(const Piece& piece, const TargetArea& flattened, float reach);

    /// Density at n places, times the share of members in all points there on a surface, relative
    /// to where the members lie: 0 to about 1.
    void read(const float* x, const float* y, std::size_t n, float* out) const;

private:
    void weigh_by_share(const DiskRaster::Values& all);

    DiskRaster raster_;
    float level_ = 0.0F;  // mean density that a member sees; 0 = no members
    DiskRaster::Values cells_{};
};

}  // namespace lpf
