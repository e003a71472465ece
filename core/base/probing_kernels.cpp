#include "core/base/probing_kernels.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/multiversion.h"

namespace lpf::kernels {

LPF_MULTIVERSION
void convolve(const float* in, float* out, std::size_t n, int stride, const float* taps,
              int reach) {
    // A block of outputs stays in registers while all taps pass over it.
    constexpr std::size_t kBlock = 64;
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
        const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
        float sums[kBlock] = {};
        for (int k = -reach; k <= reach; ++k) {
            const float* from =
                in + static_cast<std::ptrdiff_t>(begin) + static_cast<std::ptrdiff_t>(k) * stride;
            const float tap = taps[k];
            if (size == kBlock) {
#pragma omp simd
                for (std::size_t i = 0; i < kBlock; ++i) sums[i] += tap * from[i];
            } else {
#pragma omp simd
                for (std::size_t i = 0; i < size; ++i) sums[i] += tap * from[i];
            }
        }
        for (std::size_t i = 0; i < size; ++i) out[begin + i] = sums[i];
    }
}

LPF_MULTIVERSION
void nearest_to_nodes(const float* x, const float* y, const float* z, std::size_t n, float first_x,
                      float step, float row_y, float squared[16], float* out, std::size_t stride) {
    Floats node;
    for (int k = 0; k < kLanes; ++k) node[k] = first_x + step * static_cast<float>(k);
    Floats nearest = std::numeric_limits<float>::infinity() - Floats{};
    // What is kept of a point are its coordinates; a number would have to be looked up.
    Floats its_x = node, its_y = row_y - Floats{}, its_z = Floats{};
    for (std::size_t i = 0; i < n; ++i) {
        const Floats dx = x[i] - node;
        const float dy = y[i] - row_y;
        const Floats d = dx * dx + dy * dy;
        const Ints is_nearer = d < nearest;
        its_x = is_nearer ? x[i] - Floats{} : its_x;
        its_y = is_nearer ? y[i] - Floats{} : its_y;
        its_z = is_nearer ? z[i] - Floats{} : its_z;
        nearest = is_nearer ? d : nearest;
    }
    *reinterpret_cast<FloatsAt*>(out) = its_x - node;
    *reinterpret_cast<FloatsAt*>(out + stride) = its_y - row_y;
    *reinterpret_cast<FloatsAt*>(out + 2 * stride) = its_z;
    std::memcpy(squared, &nearest, sizeof nearest);
}

LPF_MULTIVERSION
void add_to_cells(const float* x, const float* y, const float* z, std::size_t n, float step,
                  int side, int rows, float* cells) {
    constexpr std::size_t kBlock = 64;
    const int to_side = side / 2;
    const int to_rows = rows / 2;
    const auto half = static_cast<float>(to_side);
    const auto half_rows = static_cast<float>(to_rows);
    int cell[kBlock];
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
        const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) {
            float column = std::floor(x[begin + i] / step + 0.5F);
            float row = std::floor(y[begin + i] / step + 0.5F);
            column = column < -half ? -half : column > half ? half : column;
            row = row < -half_rows ? -half_rows : row > half_rows ? half_rows : row;
            cell[i] = static_cast<int>(row + half_rows) * side + static_cast<int>(column + half);
        }
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t k = begin + i;
            const FourFloats point = {1.0F, x[k], y[k], z[k]};
            reinterpret_cast<FourFloats*>(cells)[cell[i]] += point;
        }
    }
}

LPF_MULTIVERSION
std::size_t nearest_to_place(const float* x, const float* y, std::size_t n, float at_x,
                             float at_y) {
    Floats nearest = std::numeric_limits<float>::infinity() - Floats{};
    Ints who = static_cast<int>(n) - Ints{};
    Ints number;
    for (int k = 0; k < kLanes; ++k) number[k] = k;
    for (std::size_t i = 0; i < n; i += kLanes) {
        Floats dx, dy;
        std::memcpy(&dx, x + i, sizeof dx);
        std::memcpy(&dy, y + i, sizeof dy);
        dx -= at_x;
        dy -= at_y;
        const Floats d = dx * dx + dy * dy;
        const Ints is_nearer = d < nearest;
        who = is_nearer ? number : who;
        nearest = is_nearer ? d : nearest;
        number += kLanes;
    }
    std::size_t best = n;
    float least = std::numeric_limits<float>::infinity();
    for (int k = 0; k < kLanes; ++k) {
        const auto point = static_cast<std::size_t>(who[k]);
        if (nearest[k] > least || (nearest[k] == least && point >= best)) continue;
        least = nearest[k];
        best = point;
    }
    return best;
}

}  // namespace lpf::kernels
