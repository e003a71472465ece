#pragma once

// One binary runs on every x86-64 and uses what the machine has. Elsewhere, and under sanitizers,
// the plain loops are compiled once.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LPF_NO_MULTIVERSION)
#define LPF_HAS_MULTIVERSION
#if !defined(LPF_NO_AVX512)
#define LPF_HAS_AVX512
#endif
#endif

#if defined(LPF_HAS_AVX512)
#define LPF_MULTIVERSION \
    __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#define LPF_WITH_WIDEST_REGISTERS(result, name, parameters, arguments)        \
    __attribute__((target("arch=x86-64-v4"))) result name##_here parameters { \
        return name##_in<16> arguments;                                       \
    }
#elif defined(LPF_HAS_MULTIVERSION)
#define LPF_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3")))
#define LPF_WITH_WIDEST_REGISTERS(result, name, parameters, arguments)
#else
#define LPF_MULTIVERSION
#endif

// For loops that name the registers they work in: a function `<name>_in` over the width of these
// (floats in a register) becomes `name`, compiled for each instruction set with registers of its
// own. What is wider than a register would be kept in memory. All of it is inlined: a vector that
// is an argument would be passed in ways that differ between instruction sets.
#if defined(LPF_HAS_MULTIVERSION)
#define LPF_WITH_REGISTERS(result, name, parameters, arguments)               \
    namespace {                                                               \
    LPF_WITH_WIDEST_REGISTERS(result, name, parameters, arguments)            \
    __attribute__((target("arch=x86-64-v3"))) result name##_here parameters { \
        return name##_in<8> arguments;                                        \
    }                                                                         \
    __attribute__((target("default"))) result name##_here parameters {        \
        return name##_in<4> arguments;                                        \
    }                                                                         \
    }                                                                         \
    result name parameters { return name##_here arguments; }
#else
#define LPF_WITH_REGISTERS(result, name, parameters, arguments) \
    result name parameters { return name##_in<4> arguments; }
#endif
#define LPF_INLINE [[gnu::always_inline]] inline

namespace lpf::kernels {

// Most floats of a register: arrays that are read by whole registers are filled up to these.
inline constexpr int kLanes = 16;

// A register of so many floats, or as many bytes of others; those in arrays begin anywhere.
template <int kWidth>
struct Registers {
    typedef float Floats __attribute__((vector_size(4 * kWidth)));
    typedef int Ints __attribute__((vector_size(4 * kWidth)));
    typedef float FloatsAt __attribute__((vector_size(4 * kWidth), aligned(4), may_alias));
    typedef double DoublesAt __attribute__((vector_size(4 * kWidth), aligned(8), may_alias));
};

template <int kWidth>
LPF_INLINE const typename Registers<kWidth>::FloatsAt& floats_at(const float* from) {
    return *reinterpret_cast<const typename Registers<kWidth>::FloatsAt*>(from);
}

template <int kWidth>
LPF_INLINE typename Registers<kWidth>::FloatsAt& floats_at(float* to) {
    return *reinterpret_cast<typename Registers<kWidth>::FloatsAt*>(to);
}

template <int kWidth>
LPF_INLINE const typename Registers<kWidth>::DoublesAt& doubles_at(const double* from) {
    return *reinterpret_cast<const typename Registers<kWidth>::DoublesAt*>(from);
}

template <int kWidth>
LPF_INLINE typename Registers<kWidth>::DoublesAt& doubles_at(double* to) {
    return *reinterpret_cast<typename Registers<kWidth>::DoublesAt*>(to);
}

// Four values that lie together in memory, wherever they begin.
typedef float FourFloats __attribute__((vector_size(16), aligned(4), may_alias));

}  // namespace lpf::kernels
