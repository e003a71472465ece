// The loop that asks for more points than any other: which of them lie in a ball.
#include "core/base/kernels.h"
#include "core/base/multiversion.h"

#if defined(LPF_HAS_AVX512)
#include <immintrin.h>
#endif

namespace lpf::kernels {
namespace {

/// Points of a run, and where those in the ball go.
struct Run {
    const double *x, *y, *z;
    std::size_t n;
    const double* centre;
    double scale;
    float limit;
    std::size_t first;
    float *out_x, *out_y, *out_z;
    unsigned* out_index;
};

#if defined(LPF_HAS_AVX512)

// The compiler makes no use of the instruction that packs the lanes that are kept.
#define LPF_WIDE __attribute__((target("arch=x86-64-v4")))

LPF_WIDE inline __m256 relative_half(__mmask8 lanes, const double* values, double origin,
                                     double scale) {
    return _mm512_cvtpd_ps(
        _mm512_mul_pd(_mm512_sub_pd(_mm512_maskz_loadu_pd(lanes, values), _mm512_set1_pd(origin)),
                      _mm512_set1_pd(scale)));
}

LPF_WIDE inline __m512 relative(__mmask16 lanes, const double* values, double origin,
                                double scale) {
    const auto low = static_cast<__mmask8>(lanes);
    const auto high = static_cast<__mmask8>(lanes >> 8);
    return _mm512_insertf32x8(_mm512_castps256_ps512(relative_half(low, values, origin, scale)),
                              relative_half(high, values + 8, origin, scale), 1);
}

LPF_WIDE std::size_t gather(const Run& run) {
    const __m512 squared_limit = _mm512_set1_ps(run.limit * run.limit);
    const __m512i count = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < run.n; i += kLanes) {
        const std::size_t left = run.n - i;
        const auto lanes = static_cast<__mmask16>(left < kLanes ? (1U << left) - 1 : 0xffffU);
        const __m512 dx = relative(lanes, run.x + i, run.centre[0], run.scale);
        const __m512 dy = relative(lanes, run.y + i, run.centre[1], run.scale);
        const __m512 dz = relative(lanes, run.z + i, run.centre[2], run.scale);
        const __m512 squared =
            _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dx, dx, _mm512_mul_ps(dy, dy)));
        const __mmask16 inside = _mm512_mask_cmp_ps_mask(lanes, squared, squared_limit, _CMP_LE_OQ);
        const __m512i index =
            _mm512_add_epi32(count, _mm512_set1_epi32(static_cast<int>(run.first + i)));
        _mm512_storeu_ps(run.out_x + kept, _mm512_maskz_compress_ps(inside, dx));
        _mm512_storeu_ps(run.out_y + kept, _mm512_maskz_compress_ps(inside, dy));
        _mm512_storeu_ps(run.out_z + kept, _mm512_maskz_compress_ps(inside, dz));
        _mm512_storeu_si512(run.out_index + kept, _mm512_maskz_compress_epi32(inside, index));
        kept += static_cast<std::size_t>(__builtin_popcount(inside));
    }
    return kept;
}

__attribute__((target("default")))
#endif
std::size_t
gather(const Run& run) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < run.n; ++i) {
        const auto dx = static_cast<float>((run.x[i] - run.centre[0]) * run.scale);
        const auto dy = static_cast<float>((run.y[i] - run.centre[1]) * run.scale);
        const auto dz = static_cast<float>((run.z[i] - run.centre[2]) * run.scale);
        run.out_x[kept] = dx;
        run.out_y[kept] = dy;
        run.out_z[kept] = dz;
        run.out_index[kept] = static_cast<unsigned>(run.first + i);
        kept += static_cast<std::size_t>(dx * dx + dy * dy + dz * dz <= run.limit * run.limit);
    }
    return kept;
}

}  // namespace

std::size_t gather_ball(const double* x, const double* y, const double* z, std::size_t n,
                        const double centre[3], double scale, float limit, std::size_t first,
                        float* out_x, float* out_y, float* out_z, unsigned* out_index) {
    return gather({x, y, z, n, centre, scale, limit, first, out_x, out_y, out_z, out_index});
}

}  // namespace lpf::kernels
