#pragma once

// One binary runs on every x86-64 and uses what the machine has. Elsewhere, and under sanitizers,
// the plain loops are compiled once.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LPF_NO_MULTIVERSION)
#define LPF_HAS_MULTIVERSION
#define LPF_MULTIVERSION \
    __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define LPF_MULTIVERSION
#endif

namespace lpf::kernels {

// For loops with choices that the compiler would make branches of. A lane is a float of any vector
// unit: the compiler cuts these into as many registers as it takes.
inline constexpr int kLanes = 16;
typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef int Ints __attribute__((vector_size(4 * kLanes)));

// The same lanes in arrays, wherever they begin. Copies of them in arrays of vectors would be
// stored, and never read.
typedef float FloatsAt __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

// Four values that lie together in memory, wherever they begin.
typedef float FourFloats __attribute__((vector_size(16), aligned(4), may_alias));

// As many bytes of doubles; for arrays that are laid out in lanes, wherever they begin.
inline constexpr int kDoubleLanes = 8;
typedef double Doubles __attribute__((vector_size(8 * kDoubleLanes), aligned(8), may_alias));

}  // namespace lpf::kernels
