#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/shape/shape.h"
#include "tests/support/bvh.h"

namespace lpf::test {

using Eigen::Vector3d;

/// A part of a shape that is known exactly: a curve or a surface of finite extent.
class Piece {
public:
    virtual ~Piece() = default;
    [[nodiscard]] virtual int dimension() const = 0;                  ///< 1 curve, 2 surface
    [[nodiscard]] virtual double measure() const = 0;                 ///< length or area
    [[nodiscard]] virtual Vector3d sample(Random& random) const = 0;  ///< uniform by measure
    [[nodiscard]] virtual double squared_distance(const Vector3d& point) const = 0;
    [[nodiscard]] virtual Eigen::AlignedBox3d box() const = 0;
};

using PiecePtr = std::shared_ptr<const Piece>;

/// corner + a edge_u + b edge_v, a and b in [0, 1]. @pre the edges are orthogonal
PiecePtr rectangle(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v);

PiecePtr sphere_surface(const Vector3d& centre, double radius);

PiecePtr segment(const Vector3d& from, const Vector3d& to);

/// All triangles of a mesh as one surface. Exact to rounding.
PiecePtr mesh_surface(const Shape& mesh);

/// c(t) for t in [begin, end]. Distances: nearest piece of a polyline of 2048 parts, then a search
/// in t around it; exact to about 1e-8 of the length while the curve bends little within a part.
PiecePtr curve(std::function<Vector3d(double)> c, double begin, double end);

/// The open sheet z = height sin(x / wave_x) cos(y / wave_y) over [-half, half]^2.
struct WavySheet {
    double half = 16.55;
    double height = 1.2;
    double wave_x = 4.0;
    double wave_y = 5.0;

    [[nodiscard]] double z(double x, double y) const;
    [[nodiscard]] Vector3d at(double x, double y) const { return {x, y, z(x, y)}; }
};

/// Distances by Newton's method from the nearest node of a fine lattice; exact to rounding.
PiecePtr wavy_sheet(const WavySheet& sheet);

/// The four border curves of the sheet.
std::vector<PiecePtr> borders_of(const WavySheet& sheet);

}  // namespace lpf::test
