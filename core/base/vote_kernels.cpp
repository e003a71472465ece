#include "core/base/vote_kernels.h"

#include "core/base/multiversion.h"
#include "core/base/polynomial.h"

namespace lpf::kernels {
namespace {

inline float within(float value, float limit) {
    const float least = value > 0 ? value : 0;
    return least < limit ? least : limit;
}

/// Lower left of four values of an image, and the shares of the right and the upper ones.
struct Place {
    int at;
    float right;
    float up;
};

inline Place place_in(const Image& image, float x, float y) {
    const float column =
        within(x * image.scale_x + image.offset_x, static_cast<float>(image.columns - 1));
    const float row =
        within(y * image.scale_y + image.offset_y, static_cast<float>(image.rows - 1));
    int left = static_cast<int>(column);
    int low = static_cast<int>(row);
    left = left < image.columns - 2 ? left : image.columns - 2;
    low = low < image.rows - 2 ? low : image.rows - 2;
    return {low * image.columns + left, column - static_cast<float>(left),
            row - static_cast<float>(low)};
}

constexpr std::size_t kBlock = 64;

struct PlacesOfBlock {
    int at[kBlock];
    float right[kBlock];
    float up[kBlock];
};

LPF_MULTIVERSION
void find_places(const Image& image, const float* x, const float* y, std::size_t size,
                 PlacesOfBlock& places) {
#pragma omp simd
    for (std::size_t i = 0; i < size; ++i) {
        const Place place = place_in(image, x[i], y[i]);
        places.at[i] = place.at;
        places.right[i] = place.right;
        places.up[i] = place.up;
    }
}

}  // namespace

LPF_MULTIVERSION
void read_image(const Image& image, const float* x, const float* y, std::size_t n, float* out) {
    const int columns = image.columns;
    const float* const values = image.values;
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const auto [at, right, up] = place_in(image, x[i], y[i]);
        const float lower = values[at] + right * (values[at + 1] - values[at]);
        const float upper =
            values[at + columns] + right * (values[at + columns + 1] - values[at + columns]);
        out[i] = lower + up * (upper - lower);
    }
}

LPF_MULTIVERSION
void read_three(const Image& image, const float* x, const float* y, std::size_t n,
                float* const out[3]) {
    PlacesOfBlock places;
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
        const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
        find_places(image, x + begin, y + begin, size, places);
        for (std::size_t i = 0; i < size; ++i) {
            const FourFloats* const low =
                reinterpret_cast<const FourFloats*>(image.values) + places.at[i];
            const FourFloats* const high = low + image.columns;
            const FourFloats lower = low[0] + places.right[i] * (low[1] - low[0]);
            const FourFloats upper = high[0] + places.right[i] * (high[1] - high[0]);
            const FourFloats value = lower + places.up[i] * (upper - lower);
            for (int c = 0; c < 3; ++c) out[c][begin + i] = value[c];
        }
    }
}

LPF_MULTIVERSION
void add_parabola_change(const float c[6], float sign, const float* x, const float* y,
                         const float* dx, const float* dy, std::size_t n, float* out) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        out[i] += sign * (parabola(c, x[i] + dx[i], y[i] + dy[i]) - parabola(c, x[i], y[i]));
    }
}

LPF_MULTIVERSION
void add_cubic_change(const float c[4], float sign, const float* x, const float* dx, std::size_t n,
                      float* out) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) out[i] += sign * (cubic(c, x[i] + dx[i]) - cubic(c, x[i]));
}

LPF_MULTIVERSION
void add_to_four(const Image& image, const float* x, const float* y, const float* const weight[4],
                 std::size_t n, float* values) {
    PlacesOfBlock places;
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
        const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
        find_places(image, x + begin, y + begin, size, places);
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t k = begin + i;
            const float right = places.right[i];
            const float up = places.up[i];
            const FourFloats weights = {weight[0][k], weight[1][k], weight[2][k], weight[3][k]};
            FourFloats* const low = reinterpret_cast<FourFloats*>(values) + places.at[i];
            FourFloats* const high = low + image.columns;
            low[0] += weights * (1 - right) * (1 - up);
            low[1] += weights * right * (1 - up);
            high[0] += weights * (1 - right) * up;
            high[1] += weights * right * up;
        }
    }
}

LPF_MULTIVERSION
void rotate(const float axes[9], float* x, float* y, float* z, std::size_t n) {
    const float a0 = axes[0], a1 = axes[1], a2 = axes[2];
    const float a3 = axes[3], a4 = axes[4], a5 = axes[5];
    const float a6 = axes[6], a7 = axes[7], a8 = axes[8];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float px = x[i], py = y[i], pz = z[i];
        x[i] = a0 * px + a1 * py + a2 * pz;
        y[i] = a3 * px + a4 * py + a5 * pz;
        z[i] = a6 * px + a7 * py + a8 * pz;
    }
}

LPF_MULTIVERSION
void weigh(const Weighing& how, const float* x, const float* y, const float* mx, const float* my,
           const float* mz, std::size_t n, float* weight) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float inside = 1.0F - (x[i] * x[i] + y[i] * y[i]);
        const float fade = how.fades ? inside * inside : 1.0F;
        float density = weight[i] < 1.0F ? weight[i] : 1.0F;
        density = density > how.least_density ? density : how.least_density;
        const float squared = mx[i] * mx[i] + my[i] * my[i] + mz[i] * mz[i];
        const float root = 1.0F / (1.0F + 0.125F * how.precision * squared);
        const float likelihood = root * root * root * root;
        const float counted = how.reliability * fade * density * likelihood;
        weight[i] = inside > 0.0F ? counted : 0.0F;
    }
}

LPF_MULTIVERSION
void add_votes(const unsigned* point, const float* weight, const float* mx, const float* my,
               const float* mz, std::size_t n, float scale, float least, float largest,
               std::int64_t* sums) {
    std::int64_t votes[4][kBlock];
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
        const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t k = begin + i;
            float counted = weight[k] > least ? weight[k] : least;
            counted = counted < largest ? counted : largest;
            counted = weight[k] > 0 ? scale * counted : 0;
            votes[0][i] = static_cast<std::int64_t>(counted);
            votes[1][i] = static_cast<std::int64_t>(counted * mx[k]);
            votes[2][i] = static_cast<std::int64_t>(counted * my[k]);
            votes[3][i] = static_cast<std::int64_t>(counted * mz[k]);
        }
        for (std::size_t i = 0; i < size; ++i) {
            std::int64_t* const to = sums + std::size_t{4} * point[begin + i];
            for (int c = 0; c < 4; ++c) to[c] += votes[c][i];
        }
    }
}

}  // namespace lpf::kernels
