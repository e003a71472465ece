#include "core/field/piece.h"

#include <algorithm>
#include <cmath>

#include "core/base/blur.h"
#include "core/base/kernels.h"
#include "core/base/polynomial.h"
#include "core/base/vote_kernels.h"

namespace lpf {
namespace {

/// Nearer to the axis of a tube than this, no direction leads to it [radius].
constexpr float kOnAxis = 1e-6F;

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

void Piece::take_off_sheet(float x, float y0, float& y, float& z) const {
    if (!is_curve()) {
        z -= std::copysign(half_gap(x, y0), z);
        return;
    }
    const float radius = half_gap(x, 0);
    const float distance = std::hypot(y, z);
    const float left = distance > kOnAxis ? 1 - radius / distance : 0.0F;
    y *= left;
    z = distance > kOnAxis ? z * left : -radius;
}

float Piece::squared_offset(float x, float y, float z) const {
    float dy = is_curve() ? y - cubic(coefficients, x) : 0.0F;
    float dz = z - (is_curve() ? cubic(coefficients + 4, x) : height(*this, x, y));
    to_nearer_sheet(x, y, dy, dz);
    return dy * dy + dz * dz;
}

kernels::CreasedSurface creased_surface(const Piece& piece) {
    const Crease& crease = piece.crease;
    return {piece.coefficients, crease.slope, crease.normal_x,
            crease.normal_y,    crease.at,    piece.noise};
}

void add_mean_change(const Piece& piece, float sign, const float* x, const float* y,
                     const float* dx, const float* dy, std::size_t n, float* out_y, float* out_z) {
    if (!piece.exists()) return;
    if (piece.is_curve()) {
        kernels::add_cubic_change(piece.coefficients, sign, x, dx, n, out_y);
        kernels::add_cubic_change(piece.coefficients + 4, sign, x, dx, n, out_z);
        return;
    }
    kernels::add_parabola_change(piece.coefficients, sign, x, y, dx, dy, n, out_z);
    if (piece.crease.slope == 0) return;
    const auto fold = [&](float px, float py) {
        return blur(piece.crease.signed_distance(px, py), piece.noise).distance;
    };
    for (std::size_t i = 0; i < n; ++i) {
        out_z[i] +=
            sign * piece.crease.slope * (fold(x[i] + dx[i], y[i] + dy[i]) - fold(x[i], y[i]));
    }
}

void add_shape(const Piece& piece, const float* x, const float* y, const float* dx, const float* dy,
               std::size_t n, float* out_y, float* out_z) {
    if (!piece.exists()) return;
    // A Gaussian blur adds the variance times half the second derivative.
    const float variance = piece.noise * piece.noise;
    const float* c = piece.coefficients;
    const float bend_y = piece.is_curve() ? variance * c[2] : 0.0F;
    const float bend_z = variance * (piece.is_curve() ? c[6] : c[3] + c[5]);
    for (std::size_t i = 0; i < n; ++i) out_y[i] -= bend_y;
    for (std::size_t i = 0; i < n; ++i) out_z[i] -= bend_z;
    if (piece.crease.slope == 0) return;
    for (std::size_t i = 0; i < n; ++i) {
        const float d = piece.crease.signed_distance(x[i] + dx[i], y[i] + dy[i]);
        out_z[i] += piece.crease.slope * (std::abs(d) - blur(d, piece.noise).distance);
    }
}

void flatten(const Piece& piece, TargetArea& target) {
    if (!piece.exists()) return;
    if (piece.is_curve() || piece.crease.slope != 0) {
        for (std::size_t i = 0; i < target.size; ++i) {
            const Eigen::Vector3f mean = piece.mean(target.x[i], target.y[i]);
            target.y[i] -= mean.y();
            target.z[i] -= mean.z();
        }
        return;
    }
    kernels::subtract_parabola(piece.coefficients, target.x.data(), target.y.data(), target.size,
                               target.z.data());
}

void keep_members(const Piece& piece, float share, TargetArea& target) {
    if (!piece.exists()) return;
    const float limit = share * share * piece.reach * piece.reach;
    const float across = piece.is_curve() ? 1.0F : 0.0F;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < target.size; ++i) {
        float y = target.y[i];
        float z = target.z[i];
        piece.to_nearer_sheet(target.x[i], target.y[i], y, z);
        target.x[kept] = target.x[i];
        target.y[kept] = y;
        target.z[kept] = z;
        target.index[kept] = target.index[i];
        kept += static_cast<std::size_t>(across * y * y + z * z <= limit);
    }
    target.size = kept;
}

}  // namespace lpf
