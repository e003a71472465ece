#include "core/field/piece.h"

#include <algorithm>
#include <cmath>

#include "core/field/blur.h"

namespace lpf {
namespace {

float parabola(const float* c, float x, float y) {
    return c[0] + x * (c[1] + x * c[3] + y * c[4]) + y * (c[2] + y * c[5]);
}

float cubic(const float* c, float x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }

float height(const Piece& piece, float x, float y) {
    const float smooth = parabola(piece.coefficients, x, y);
    const Crease& crease = piece.crease;
    if (crease.slope == 0) return smooth;
    return smooth + crease.slope * blur(crease.signed_distance(x, y), piece.noise).distance;
}

}  // namespace

Eigen::Vector3f Piece::mean(float x, float y) const {
    if (!exists()) return Eigen::Vector3f::Zero();
    if (is_curve()) return {0, cubic(coefficients, x), cubic(coefficients + 4, x)};
    return {0, 0, height(*this, x, y)};
}

Eigen::Vector3f Piece::shape(float x, float y) const {
    Eigen::Vector3f place = mean(x, y);
    // A Gaussian blur adds the variance times half the second derivative.
    const float variance = noise * noise;
    if (is_curve()) {
        place.y() -= variance * coefficients[2];
        place.z() -= variance * coefficients[6];
        return place;
    }
    place.z() -= variance * (coefficients[3] + coefficients[5]);
    if (crease.slope != 0) {
        const float d = crease.signed_distance(x, y);
        place.z() += crease.slope * (std::abs(d) - blur(d, noise).distance);
    }
    return place;
}

float Piece::half_gap(float x, float y) const {
    if (sheets[0] == 0) return 0.0F;
    return std::sqrt(std::max(0.0F, sheets[0] + sheets[1] * x + sheets[2] * y));
}

float Piece::squared_offset(float x, float y, float z) const {
    if (is_curve()) {
        const float dy = y - cubic(coefficients, x);
        const float dz = z - cubic(coefficients + 4, x);
        return dy * dy + dz * dz;
    }
    const float dz = std::abs(z - height(*this, x, y)) - half_gap(x, y);
    return dz * dz;
}

void flatten(const Piece& piece, TargetArea& target) {
    if (!piece.exists()) return;
    for (std::size_t i = 0; i < target.size; ++i) {
        const float x = target.x[i];
        if (piece.is_curve()) {
            target.y[i] -= cubic(piece.coefficients, x);
            target.z[i] -= cubic(piece.coefficients + 4, x);
        } else {
            target.z[i] -= height(piece, x, target.y[i]);
        }
    }
}

void keep_members(const Piece& piece, float share, TargetArea& target) {
    if (!piece.exists()) return;
    const float limit = share * share * piece.reach * piece.reach;
    const float across = piece.is_curve() ? 1.0F : 0.0F;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < target.size; ++i) {
        const float y = across * target.y[i];
        float z = target.z[i];
        if (piece.sheets[0] != 0) z -= std::copysign(piece.half_gap(target.x[i], target.y[i]), z);
        target.x[kept] = target.x[i];
        target.y[kept] = target.y[i];
        target.z[kept] = z;
        target.index[kept] = target.index[i];
        kept += static_cast<std::size_t>(y * y + z * z <= limit);
    }
    target.size = kept;
}

}  // namespace lpf
