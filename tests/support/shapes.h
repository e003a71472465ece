#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/shape/shape.h"
#include "tests/support/pieces.h"

namespace lpf::test {

/// How a shape is sampled. Same options, same points: on every machine and for any thread count.
struct Sampling {
    std::size_t points = 10000;
    double noise = 0.0;  ///< standard deviation of isotropic Gaussian noise, per coordinate
    std::uint64_t seed = 1;
};

/// A shape with a known answer: the exact curves and surfaces, and noisy samples of them.
struct TestShape {
    std::string name;
    std::vector<PiecePtr> pieces;
    std::vector<PiecePtr> borders = {};  ///< of open surfaces
    std::vector<Vector3d> ends = {};     ///< of open curves that end in the air
    std::vector<PiecePtr> edges = {};    ///< sharp ones, where surfaces meet at an angle

    Points clean = {};                       ///< 3 x N, on the pieces
    Points points = {};                      ///< 3 x N, row i is row i of `clean` with noise
    std::vector<std::uint32_t> piece = {};   ///< N, which piece each point was drawn from
    std::vector<std::uint8_t> outlier = {};  ///< N ones and zeros, or empty: no outliers

    /// From `point` to the exact noise-free shape. Outliers do not belong to it.
    [[nodiscard]] double distance(const Vector3d& point) const;

    /// Diagonal of the bounding box of the exact shape (outliers left out).
    [[nodiscard]] double diagonal() const;

    /// One where the point was drawn from a curve.
    [[nodiscard]] std::vector<std::uint8_t> on_curve() const;
};

/// From `point` to the nearest of the pieces; infinite if there are none.
double distance_to_pieces(const std::vector<PiecePtr>& pieces, const Vector3d& point);

/// Draws the samples of a shape whose pieces are set. For the other arguments see sample_pieces.
TestShape sampled(TestShape shape, const Sampling& sampling, double curve_share = 0.1,
                  const std::vector<double>& weights = {});

/// `count` points on the pieces, uniform by length or area: a share of `curve_share` of them on the
/// curves where there are both. @param weights density of each piece, or empty: all the same
Points sample_pieces(const std::vector<PiecePtr>& pieces, std::size_t count, std::uint64_t seed,
                     double curve_share = 0.1, const std::vector<double>& weights = {},
                     std::vector<std::uint32_t>* piece_of = nullptr);

TestShape make_plane(const Sampling& sampling);   ///< [-1, 1]^2 at z = 0
TestShape make_sphere(const Sampling& sampling);  ///< radius 1

/// Hollow, [-half, half]^3.
TestShape make_cube(const Sampling& sampling, double half = 1.0);

/// Two sheets [-1, 1]^2 at z = +-gap / 2.
TestShape make_thin_plate(const Sampling& sampling, double gap = 0.08);

/// Two sheets of 1 x 2 that meet in the y axis at an angle.
TestShape make_fin(const Sampling& sampling, double degrees = 40.0);

/// A line and a parabola that cross at the origin.
TestShape make_crossing_curves(const Sampling& sampling);

/// The plane [-1, 1]^2 and an arc that rises from its centre.
TestShape make_curve_on_surface(const Sampling& sampling);

/// A hollow cube of edge 4 with a wave going right through it; diagonal about 8.8.
TestShape make_cube_with_curve(const Sampling& sampling);

TestShape make_open_sheet(const Sampling& sampling);  ///< one wave, [-2, 2]^2

/// The plane [-1, 1]^2, four times as dense where x < 0.
TestShape make_density_step(const Sampling& sampling);

/// make_plane with 2 % of the points far from it and from each other (flagged in `outlier`).
TestShape make_isolated_points(const Sampling& sampling);

TestShape make_line(const Sampling& sampling);    ///< length 2 along x
TestShape make_circle(const Sampling& sampling);  ///< radius 1 at z = 0
TestShape make_helix(const Sampling& sampling);   ///< radius 1, three turns, height 2

/// An open wavy sheet under a net of curves: eight arches and four posts, one tenth of the points
/// on them. The default of 400 000 points is the benchmark's.
TestShape make_curvenet(const Sampling& sampling = {.points = 400000});

/// The surface of a mesh, uniform by area.
TestShape make_from_mesh(std::string name, const Shape& mesh, const Sampling& sampling);

TestShape make_pyramid(const Sampling& sampling);       ///< pyramid_mesh(), diagonal 125.5
TestShape make_disk_segment(const Sampling& sampling);  ///< disk_segment_mesh(), diagonal 7.6
TestShape make_head(const Sampling& sampling);          ///< head_mesh(), diagonal 52

/// A frame of 1 x 1.8 around 24 tilted slats, all of them open sheets; diagonal 2.06.
TestShape make_shutter(const Sampling& sampling);

/// Ten bodies of 10 000 points each, with thin limbs, plates and holes; the noise is as large as
/// the spacing of the points.
std::vector<TestShape> make_small_bodies(std::uint64_t seed);

/// The names that make_shape knows: each function of one shape above without its make_.
const std::vector<std::string>& shape_names();

/// @throws Error{InvalidParameter} for a name that is not in shape_names()
TestShape make_shape(const std::string& name, const Sampling& sampling);

}  // namespace lpf::test
