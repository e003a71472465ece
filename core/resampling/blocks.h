#pragma once

#include <cstdint>
#include <vector>

#include "core/field/frame.h"
#include "core/resampling/cells.h"

namespace lpf {

/// LPFs propose points no further than this from the centres of their target areas [radius]; what
/// few do is of no use to cells that far away.
inline constexpr double kProposalReach = 1.25;

/// A box of cells and the LPFs that may propose points in it or near it, ascending.
struct Block {
    CellBox box;
    std::vector<std::uint32_t> fields;
};

/// Divides the cells into boxes of about as many LPFs each, so that the candidates of one box fit
/// in little memory. LPFs at borders belong to several.
/// @param margin around a box within which its candidates may lie [input length]
/// @param most LPFs of a block, if cells are small enough
[[nodiscard]] std::vector<Block> divide(const std::vector<Frame>& frames, const CellLattice& cells,
                                        double margin, std::size_t most);

/// Those of some LPFs that may propose points in a part of space.
[[nodiscard]] std::vector<std::uint32_t> fields_near(const std::vector<Frame>& frames,
                                                     const std::vector<std::uint32_t>& numbers,
                                                     const Eigen::AlignedBox3d& space);

}  // namespace lpf
