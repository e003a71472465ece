#pragma once

#include <Eigen/Core>

#include "core/base/crease_kernels.h"
#include "core/field/local_probing_field.h"
#include "core/field/target_area.h"

namespace lpf {

/// A straight fold of a surface: the height changes by `slope` times the distance to the line
/// normal_x x + normal_y y = at, on both sides of it. No fold: slope 0.
struct Crease {
    float slope = 0.0F;
    float normal_x = 1.0F;  ///< unit normal of the line, in the plane
    float normal_y = 0.0F;
    float at = 0.0F;

    [[nodiscard]] float signed_distance(float x, float y) const {
        return normal_x * x + normal_y * y - at;
    }
};

/// The one part of the shape that an LPF is about: a parabolic surface, perhaps with a crease, two
/// such surfaces at a small distance, a cubic curve, or a tube around one. What lies further off
/// than noise carries is another part: the other side of a plate, a wire above a wall. Departs from
/// the paper, where an LPF is about all points in its target area and its field starts from a
/// plane. Lengths in units of the LPF's radius, relative to the centre of the target area.
///
/// Isotropic noise blurs what bends: points near an edge lie inside of it on average. A piece
/// therefore knows both where the noisy points lie, `mean`, and where the shape is, `shape`.
struct Piece {
    Dimension dimension = kTooFewPoints;  ///< kTooFewPoints: the LPF is about all its target area
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();
    Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns t1, t2, n; in SO(3)
    /// Surface: height over (1, x, y, xx, xy, yy). Curve: y over (1, x, xx, xxx), then height.
    float coefficients[8] = {};
    Crease crease;
    /// Two sheets: squared half of their distance over (1, x, y). A tube: its squared radius over
    /// (1, x). One sheet, or a curve: the first value is 0.
    float sheets[3] = {};
    float noise = 0.0F;          ///< standard deviation of the points off the shape
    float reach = 0.0F;          ///< points further off do not belong to the piece
    float steepness = 1.0F;      ///< distance along n for a distance across the surface
    float squared_bias = 0.0F;   ///< what the piece leaves of the shape
    float squared_error = 0.0F;  ///< that, and the noise that goes into the coefficients

    [[nodiscard]] bool exists() const { return dimension != kTooFewPoints; }
    [[nodiscard]] bool is_curve() const { return dimension == kCurve; }

    /// Where the noisy points lie on average over (x, y), relative to the plane of the axes: in y
    /// and z on a curve, in z on a surface; between two sheets.
    [[nodiscard]] Eigen::Vector3f mean(float x, float y) const;

    /// Where the shape is: the mean without what noise adds to it.
    [[nodiscard]] Eigen::Vector3f shape(float x, float y) const;

    [[nodiscard]] bool is_tube() const { return is_curve() && sheets[0] != 0; }

    /// Half the distance of two sheets at (x, y), or the radius of a tube; 0 where there is none.
    [[nodiscard]] float half_gap(float x, float y) const;

    /// Takes from the offset (y, z) of a place over (x, y0) to the mean what leads to the nearer
    /// sheet, or to the tube.
    void to_nearer_sheet(float x, float y0, float& y, float& z) const {
        if (sheets[0] != 0) take_off_sheet(x, y0, y, z);
    }

    /// Squared distance of a place in the piece's axes to the mean of the nearer sheet, along n on
    /// a surface.
    [[nodiscard]] float squared_offset(float x, float y, float z) const;

private:
    void take_off_sheet(float x, float y0, float& y, float& z) const;
};

/// A surface with a crease, for kernels.
[[nodiscard]] kernels::CreasedSurface creased_surface(const Piece& piece);

/// Adds to out how the mean of the noisy points changes from n places (x, y) to others that lie
/// (dx, dy) further, times `sign`. @param out_y used on curves alone
void add_mean_change(const Piece& piece, float sign, const float* x, const float* y,
                     const float* dx, const float* dy, std::size_t n, float* out_y, float* out_z);

/// Adds to out what leads from the mean to the shape at n places (x + dx, y + dy).
void add_shape(const Piece& piece, const float* x, const float* y, const float* dx, const float* dy,
               std::size_t n, float* out_y, float* out_z);

/// From the piece's axes to coordinates in which the mean of its points is flat.
void flatten(const Piece& piece, TargetArea& target);

/// Leaves of a flattened target area what lies within `share` of the piece's reach, relative to the
/// nearer sheet. A piece that does not exist keeps all.
void keep_members(const Piece& piece, float share, TargetArea& target);

}  // namespace lpf
