#include "core/base/probing_kernels.h"

#include <cmath>
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

namespace {

template <int kWidth>
LPF_INLINE float nearest_to_nodes_in(const float* x, const float* y, const float* z, std::size_t n,
                                     float first_x, float step, float row_y, int nodes, float* out,
                                     std::size_t stride) {
    using Floats = typename Registers<kWidth>::Floats;
    using Ints = typename Registers<kWidth>::Ints;
    constexpr std::size_t kBlock = 64;
    Ints lane;
    for (int k = 0; k < kWidth; ++k) lane[k] = k;
    Floats furthest{};
    for (int first = 0; first < 16; first += kWidth) {
        const Floats node = first_x + step * __builtin_convertvector(lane + first, Floats);
        Floats nearest = std::numeric_limits<float>::infinity() - Floats{};
        // What is kept of a point are its coordinates; a number would have to be looked up.
        Floats its_x = node, its_y = row_y - Floats{}, its_z = Floats{};
        for (std::size_t begin = 0; begin < n; begin += kBlock) {
            const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
            float across[kBlock];  // what all nodes share, a register of points at a time
            for (std::size_t i = 0; i < size; i += kWidth) {
                const Floats dy = floats_at<kWidth>(y + begin + i) - row_y;
                floats_at<kWidth>(across + i) = dy * dy;
            }
            for (std::size_t i = 0; i < size; ++i) {
                const std::size_t point = begin + i;
                const Floats dx = x[point] - node;
                const Floats d = dx * dx + across[i];
                const Ints is_nearer = d < nearest;
                its_x = is_nearer ? x[point] - Floats{} : its_x;
                its_y = is_nearer ? y[point] - Floats{} : its_y;
                its_z = is_nearer ? z[point] - Floats{} : its_z;
                nearest = is_nearer ? d : nearest;
            }
        }
        floats_at<kWidth>(out + first) = its_x - node;
        floats_at<kWidth>(out + stride + first) = its_y - row_y;
        floats_at<kWidth>(out + 2 * stride + first) = its_z;
        const Floats counts = lane + first < nodes ? nearest : Floats{};
        furthest = counts > furthest ? counts : furthest;
    }
    // The largest of them, found by halves.
#pragma GCC unroll 4
    for (int half = kWidth / 2; half > 0; half /= 2) {
        const Floats others = __builtin_shuffle(furthest, (lane + half) % kWidth);
        furthest = others > furthest ? others : furthest;
    }
    return furthest[0];
}

template <int kWidth>
LPF_INLINE std::size_t nearest_to_place_in(const float* x, const float* y, std::size_t n,
                                           float at_x, float at_y) {
    using Floats = typename Registers<kWidth>::Floats;
    using Ints = typename Registers<kWidth>::Ints;
    Floats nearest = std::numeric_limits<float>::infinity() - Floats{};
    Ints who = static_cast<int>(n) - Ints{};
    Ints number;
    for (int k = 0; k < kWidth; ++k) number[k] = k;
    for (std::size_t i = 0; i < n; i += kWidth) {
        const Floats dx = floats_at<kWidth>(x + i) - at_x;
        const Floats dy = floats_at<kWidth>(y + i) - at_y;
        const Floats d = dx * dx + dy * dy;
        const Ints is_nearer = d < nearest;
        who = is_nearer ? number : who;
        nearest = is_nearer ? d : nearest;
        number += kWidth;
    }
    std::size_t best = n;
    float least = std::numeric_limits<float>::infinity();
    for (int k = 0; k < kWidth; ++k) {
        const auto point = static_cast<std::size_t>(who[k]);
        if (nearest[k] > least || (nearest[k] == least && point >= best)) continue;
        least = nearest[k];
        best = point;
    }
    return best;
}

}  // namespace

LPF_WITH_REGISTERS(float, nearest_to_nodes,
                   (const float* x, const float* y, const float* z, std::size_t n, float first_x,
                    float step, float row_y, int nodes, float* out, std::size_t stride),
                   (x, y, z, n, first_x, step, row_y, nodes, out, stride))

LPF_WITH_REGISTERS(std::size_t, nearest_to_place,
                   (const float* x, const float* y, std::size_t n, float at_x, float at_y),
                   (x, y, n, at_x, at_y))

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

}  // namespace lpf::kernels
