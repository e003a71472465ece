#include "core/field/density_map.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace lpf {
namespace {

constexpr float kFewestPoints = 1e-6F;

}  // namespace

void DensityMap::count(const Piece& piece, const TargetArea& flattened, float reach) {
    raster_ = DiskRaster(piece.is_curve());
    cells_.fill(0.0F);
    Eigen::ArrayXf is_member(flattened.size);
    for (std::size_t i = 0; i < flattened.size; ++i) {
        float across = piece.is_curve() ? flattened.y[i] : 0.0F;
        float height = flattened.z[i];
        piece.to_nearer_sheet(flattened.x[i], flattened.y[i], across, height);
        is_member[i] = height * height + across * across <= reach * reach ? 1.0F : 0.0F;
    }
    const Eigen::ArrayXf ones = Eigen::ArrayXf::Ones(is_member.size());
    DiskRaster::Values all{};
    raster_.add(flattened.x.data(), flattened.y.data(), flattened.size,
                {{is_member.data(), &cells_}, {ones.data(), &all}});
    float sum = 0;
    float squares = 0;
    for (const float count : cells_) {
        sum += count;
        squares += count * count;
    }
    level_ = sum > 0 ? squares / sum : 0.0F;
    for (float& count : cells_) count /= std::max(level_, 1e-9F);
    if (!piece.is_curve()) weigh_by_share(all);
}

/// Where many points are none of its members, another part of the shape is near.
void DensityMap::weigh_by_share(const DiskRaster::Values& all) {
    for (std::size_t k = 0; k < cells_.size(); ++k) {
        cells_[k] *= level_ * cells_[k] / std::max(all[k], kFewestPoints);
    }
}

void DensityMap::read(const float* x, const float* y, std::size_t n, float* out) const {
    if (level_ == 0) {
        std::fill_n(out, n, 1.0F);
        return;
    }
    raster_.read(cells_, x, y, n, out);
}

}  // namespace lpf
