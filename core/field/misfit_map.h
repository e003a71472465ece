#pragma once

#include <Eigen/Core>

#include "core/field/disk_raster.h"
#include "core/field/piece.h"

namespace lpf {

/// How far the members of an LPF lie off its piece.
class MemberOffsets {
public:
    /// @param flattened a flattened target area; its members count
    MemberOffsets(const Piece& piece, const TargetArea& flattened);

private:
    friend class MisfitMap;

    const Piece& piece_;
    const TargetArea& target_;
    DiskRaster raster_;
    Eigen::ArrayXf is_member_;  // ones and zeros
    Eigen::ArrayXf y_, z_;      // y on curves alone; 0 of what is no member
};

/// How far the members of an LPF lie off its field on average, place by place, beyond what noise
/// explains: an LPF is less to be believed where it does not suit its own points, as beside an
/// edge that it does not know of.
class MisfitMap {
public:
    /// @param field_y, field_z the field at each point of the target area, y used on curves alone
    void measure(const MemberOffsets& members, const float* field_y, const float* field_z);

    /// The same for the piece alone: a field of zeros.
    void measure(const MemberOffsets& members) { measure_means(members, members.y_, members.z_); }

    /// Mean over the members [squared radius].
    [[nodiscard]] float mean() const { return mean_; }

    /// Squared misfit at n places [squared radius].
    void read(const float* x, const float* y, std::size_t n, float* out) const {
        raster_.read(cells_, x, y, n, out);
    }

private:
    void measure_means(const MemberOffsets& members, const Eigen::ArrayXf& off_y,
                       const Eigen::ArrayXf& off_z);

    DiskRaster raster_;
    DiskRaster::Values cells_{};
    float mean_ = 0.0F;
};

}  // namespace lpf
