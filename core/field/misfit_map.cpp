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

MemberOffsets::MemberOffsets(const Piece& piece, const TargetArea& flattened)
    : piece_(piece),
      target_(flattened),
      raster_(piece.is_curve()),
      is_member_(flattened.size),
      y_(piece.is_curve() ? flattened.size : 0),
      z_(flattened.size) {
    const float limit = piece.reach * piece.reach;
    for (std::size_t i = 0; i < flattened.size; ++i) {
        float y = piece.is_curve() ? flattened.y[i] : 0.0F;
        float z = flattened.z[i];
        piece.to_nearer_sheet(flattened.x[i], flattened.y[i], y, z);
        is_member_[i] = y * y + z * z <= limit ? 1.0F : 0.0F;
        z_[i] = is_member_[i] * z;
        if (piece.is_curve()) y_[i] = is_member_[i] * y;
    }
}

void MisfitMap::measure(const MemberOffsets& members, const float* field_y, const float* field_z) {
    using Field = Eigen::Map<const Eigen::ArrayXf>;
    const Eigen::ArrayXf& ones = members.is_member_;
    Eigen::ArrayXf off_y = members.y_;
    if (off_y.size() > 0) off_y -= ones * Field(field_y, ones.size());
    measure_means(members, off_y, members.z_ - ones * Field(field_z, ones.size()));
}

void MisfitMap::measure_means(const MemberOffsets& members, const Eigen::ArrayXf& off_y,
                              const Eigen::ArrayXf& off_z) {
    const Piece& piece = members.piece_;
    raster_ = members.raster_;
    DiskRaster::Values points{};
    DiskRaster::Values sum_y{};
    DiskRaster::Values sum_z{};
    const float* const x = members.target_.x.data();
    const float* const y = members.target_.y.data();
    if (piece.is_curve()) {
        raster_.add(
            x, y, members.target_.size,
            {{members.is_member_.data(), &points}, {off_z.data(), &sum_z}, {off_y.data(), &sum_y}});
    } else {
        raster_.add(x, y, members.target_.size,
                    {{members.is_member_.data(), &points}, {off_z.data(), &sum_z}});
    }
    const float across = piece.steepness * piece.steepness;
    const float variance = piece.noise * piece.noise * (piece.is_curve() ? 2.0F : across);
    float sum = 0.0F;
    float all = kFewestPoints;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
        const float count = std::max(points[k], kFewestPoints);
        const float square = (sum_y[k] * sum_y[k] + sum_z[k] * sum_z[k]) / (count * count);
        const float chance = kVariancesOfChance * variance / (kCellsOfPoint * count);
        cells_[k] = std::max(0.0F, square - chance) / across;
        sum += points[k] * cells_[k];
        all += points[k];
    }
    mean_ = sum / all;
}

}  // namespace lpf
