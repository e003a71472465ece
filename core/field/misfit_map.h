#pragma once

#include "core/field/disk_raster.h"
#include "core/field/piece.h"

namespace lpf {

/// How far the members of an LPF lie off its field on average, place by place, beyond what noise
/// explains: an LPF is less to be believed where it does not suit its own points, as beside an
/// edge that it does not know of.
class MisfitMap {
public:
    /// @param flattened a flattened target area; its members count
    /// @param field_y, field_z the field at each of its points, y used on curves alone
    void measure(const Piece& piece, const TargetArea& flattened, const float* field_y,
                 const float* field_z);

    /// Mean over the members [squared radius].
    [[nodiscard]] float mean() const { return mean_; }

    /// Squared misfit at n places [squared radius].
    void read(const float* x, const float* y, std::size_t n, float* out) const {
        raster_.read(cells_, x, y, n, out);
    }

private:
    DiskRaster raster_;
    DiskRaster::Values cells_{};
    float mean_ = 0.0F;
};

}  // namespace lpf
