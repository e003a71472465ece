#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Finds the pieces of target areas. One for each thread.
class PieceGrower {
public:
    /// @param refuses_edges whether smooth surfaces that meet an edge of the shape count as
    /// useless.
    ///                      Where there are no smaller LPFs, they are the best there is
    explicit PieceGrower(bool refuses_edges) : refuses_edges_(refuses_edges) {}

    /// Grows the piece through the centre of a target area from a small ball to the whole of it:
    /// what does not continue what is there already stays outside.
    /// @param target in centre-relative coordinates
    /// @param noise  standard deviation of the points off the shape [radius], >= 0
    /// @param extent of the target area [radius]
    /// @param enough a squared error [squared radius]: of what errs less, no folds or sheets are
    ///               looked for
    /// @returns a piece that does not exist where there are too few points
    [[nodiscard]] Piece grow(const TargetArea& target, float noise, float extent,
                             float enough = 0.0F);

private:
    [[nodiscard]] Piece grow_as(Dimension dimension, float noise);
    bool grow_through_balls(Piece& piece);
    [[nodiscard]] bool is_strip(const Piece& curve) const;
    bool straighten(std::size_t ball, Piece& piece);

    bool refuses_edges_;
    PieceSample sample_;
    TargetArea members_;
};

}  // namespace lpf
