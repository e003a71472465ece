#include "core/field/misfit_map.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace lpf {
namespace {

/// A mean is off by noise alone within about so many variances of it.
constexpr float kVariancesOfChance = 2.0F;

/// Bilinear sharing spreads a point over this many cells: the mean in one has so many more points.
constexpr float kCellsOfPoint = 2.25F;

constexpr float kFewestPoints = 1e-6F;

}  // namespace

void MisfitMap::measure(const Piece& piece, const TargetArea& flattened, const float* field_y,
                        const float* field_z) {
    const bool is_curve = piece.is_curve();
    raster_ = DiskRaster(is_curve);
    const std::size_t n = flattened.size;
    const float limit = piece.reach * piece.reach;
    Eigen::ArrayXf is_member(n);
    Eigen::ArrayXf off_y(is_curve ? n : 0);
    Eigen::ArrayXf off_z(n);
    for (std::size_t i = 0; i < n; ++i) {
        float y = is_curve ? flattened.y[i] : 0.0F;
        float z = flattened.z[i];
        piece.to_nearer_sheet(flattened.x[i], flattened.y[i], y, z);
        is_member[i] = y * y + z * z <= limit ? 1.0F : 0.0F;
        off_z[i] = is_member[i] * (z - field_z[i]);
        if (is_curve) off_y[i] = is_member[i] * (y - field_y[i]);
    }
    const auto total = [&](const Eigen::ArrayXf& values) {
        DiskRaster::Values sums{};
        raster_.add(flattened.x.data(), flattened.y.data(), values.data(),
                    static_cast<std::size_t>(values.size()), sums);
        return sums;
    };
    const DiskRaster::Values points = total(is_member);
    const DiskRaster::Values sum_y = total(off_y);
    const DiskRaster::Values sum_z = total(off_z);
    const float across = piece.steepness * piece.steepness;
    const float variance = piece.noise * piece.noise * (is_curve ? 2.0F : across);
    float sum = 0.0F;
    float members = kFewestPoints;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
        const float count = std::max(points[k], kFewestPoints);
        const float square = (sum_y[k] * sum_y[k] + sum_z[k] * sum_z[k]) / (count * count);
        const float chance = kVariancesOfChance * variance / (kCellsOfPoint * count);
        cells_[k] = std::max(0.0F, square - chance) / across;
        sum += points[k] * cells_[k];
        members += points[k];
    }
    mean_ = sum / members;
}

}  // namespace lpf
