#pragma once

#include <array>

#include "core/field/piece.h"

namespace lpf {

/// How densely the members of a piece lie over its disk: a piece says less where it has no points.
/// A raster over the disk, or along a curve, read bilinearly.
class DensityMap {
public:
    /// Counts the members of a flattened target area.
    /// @param reach members lie no further off than this [radius]
    void count(const Piece& piece, const TargetArea& flattened, float reach);

    /// Density at (x, y) relative to where the members lie, in [.001, 1].
    [[nodiscard]] float at(float x, float y) const;

private:
    static constexpr int kCells = 12;
    static constexpr int kSide = kCells + 2;

    /// Lower left of four cells, and the weights of the right and the upper ones.
    struct Place {
        int cell;
        float right;
        float up;
    };
    [[nodiscard]] Place place(float x, float y) const;

    bool along_curve_ = false;
    float level_ = 0.0F;  // mean density that a member sees; 0 = no members
    std::array<float, kSide * kSide> cells_{};
};

}  // namespace lpf
