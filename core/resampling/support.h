#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/field/piece.h"
#include "core/field/target_area.h"

namespace lpf {

/// Whether target points lie around places of the plane: sorted into cells of one support distance.
class Support {
public:
    /// @param target flattened, as the piece says
    /// @param distance over which the shape goes on between points [radius]
    Support(const Piece& piece, const TargetArea& target, float distance);

    /// A place is on the shape if a point is very near, or if one is within the distance and points
    /// within twice of it do not all lie to one side.
    /// @param on_piece where the piece has the place
    [[nodiscard]] bool covers(const Eigen::Vector2f& place, const Eigen::Vector3f& on_piece) const;

private:
    [[nodiscard]] int cell_of(float coordinate) const;

    float distance_;
    int side_ = 1;
    std::vector<std::uint32_t> first_;       // of each cell, into the points
    std::vector<float> x_, y_;               // of the points in the plane, cell by cell
    std::vector<float> at_x_, at_y_, at_z_;  // and in space
};

}  // namespace lpf
