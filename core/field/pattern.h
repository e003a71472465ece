#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/aligned_floats.h"

namespace lpf {

/// The sampling pattern (paper Sec. 2.1): M offsets u_i from the seed, in the LPF's own frame and
/// in units of the pattern radius, so |u_i| <= 1 in the plane. Stored as three channels x, y, z,
/// each padded with zeros to a multiple of 16 floats so that kernels run over whole vectors.
class Pattern {
public:
    /// A regular n x n grid cut to the open disk: nodes (i, j) with i^2 + j^2 < (n/2)^2, step 2/n.
    /// n = 16, 32, 64 give M = 193, 793, 3205 (paper Sec. 4.1).
    /// @throws Error{InvalidParameter} unless 4 <= n <= 128
    static Pattern grid(int n);

    /// M points drawn uniformly in the unit disk (paper Fig. 2, right), the centre first.
    /// @throws Error{InvalidParameter} unless 5 <= points <= 12849
    static Pattern random_disk(int points, std::uint64_t random_seed);

    /// A pattern of the caller's own. offsets: 3 x M in radius units.
    /// @throws Error{InvalidParameter} unless M >= 5 and every offset is finite with |(x, y)| <= 1
    static Pattern from_points(const Eigen::Matrix3Xf& offsets);

    /// The grid whose number of points is nearest to `points` (the smaller on a tie).
    static int grid_size_for(int points);

    [[nodiscard]] int size() const { return size_; }            ///< M
    [[nodiscard]] int padded_size() const { return padded_; }   ///< M rounded up to 16
    [[nodiscard]] int grid_size() const { return grid_size_; }  ///< n, or 0 if it is not a grid
    [[nodiscard]] float step() const {
        return step_;
    }  ///< tau_s: grid step, or sqrt(pi / M) [radius]

    /// Channel c (0 = x, 1 = y, 2 = z): padded_size() floats.
    [[nodiscard]] const float* channel(int c) const { return data_.data() + c * padded_; }
    [[nodiscard]] Eigen::Vector3f point(int i) const;

    /// The nodes in order of their distance to the centre.
    [[nodiscard]] const std::vector<int>& by_distance() const { return by_distance_; }

    /// Of a grid: the node at each corner of its lattice, row by row, n / 2 * 2 + 1 to a row;
    /// beyond the disk the nearest one.
    [[nodiscard]] const std::vector<int>& raster() const { return raster_; }

    /// Four nodes and weights that interpolate a field at (x, y): bilinear on a grid, inverse
    /// distance on the nearest nodes otherwise. Weights sum to 1. Outside the nodes: the nearest
    /// ones.
    struct Stencil {
        int node[4];
        float weight[4];
    };
    [[nodiscard]] Stencil stencil(float x, float y) const;

private:
    Pattern(const Eigen::Matrix3Xf& offsets, int grid_size, float step);
    void index_nodes();

    int size_ = 0;
    int padded_ = 0;
    int grid_size_ = 0;
    float step_ = 0;
    AlignedFloats data_;  // x, y, z channels
    std::vector<int> by_distance_;
    int raster_size_ = 0;      // lookup raster over [-1, 1]^2, raster_size_ cells a side
    std::vector<int> raster_;  // grid: node at lattice corner; otherwise: four nearest nodes
};

}  // namespace lpf
