#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/field/piece.h"
#include "core/field/target_area.h"

namespace lpf {

/// The points of a target area that a piece is grown from, in rings around the centre, so that
/// those of a ball come first. Structure of arrays, in units of the LPF's radius; reused from LPF
/// to LPF.
class PieceSample {
public:
    /// Takes the target area over; a large one is thinned to about `most` points.
    /// @param first   radius of the innermost ball
    /// @param growth  ratio of the radii of a ball and the one within it
    /// @param extent  radius of the outermost ball; what lies beyond it belongs to it
    void assign(const TargetArea& target, std::size_t most, float first, float growth,
                float extent);

    [[nodiscard]] std::size_t size() const { return px.size(); }
    [[nodiscard]] float extent() const { return extent_; }

    /// How many points each stands for.
    [[nodiscard]] float stride() const { return stride_; }

    [[nodiscard]] std::size_t balls() const { return ball_end_.size(); }
    /// Number of points in a ball: they are the first ones.
    [[nodiscard]] std::size_t points_in(std::size_t ball) const { return ball_end_[ball]; }

    /// Writes the first `count` points in the axes of a piece.
    void look_along(const Piece& piece, std::size_t count);

    /// Measures how far the first `count` points lie off a piece, in the axes last looked along.
    void measure(const Piece& piece, std::size_t count);

    [[nodiscard]] bool is_member(const Piece& piece, std::size_t i) const {
        return squared_offset[i] <= piece.reach * piece.reach;
    }
    [[nodiscard]] std::size_t count_members(const Piece& piece) const {
        return count_within(piece.reach);
    }
    /// Number of points that lie so far off the piece last measured, at most.
    [[nodiscard]] std::size_t count_within(float distance) const;

    std::vector<float> px, py, pz;        ///< relative to the centre
    std::vector<float> squared_distance;  ///< to the centre
    std::vector<float> x, y, z;           ///< in the axes last looked along
    std::vector<float> squared_offset;    ///< from the piece last measured

private:
    float extent_ = 1.0F;
    float stride_ = 1.0F;
    std::vector<float> ball_radius_;
    std::vector<std::size_t> ball_end_;
    std::vector<std::uint32_t> ring_;  // of each point of the target area
};

}  // namespace lpf
