#include "core/field/piece.h"

#include <algorithm>
#include <cmath>

#include "core/base/blur.h"
#include "core/base/kernels.h"
#include "core/base/polynomial.h"
#include "core/base/vote_kernels.h"

namespace lpf {
namespace {

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
