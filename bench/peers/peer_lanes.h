// SPDX-License-Identifier: Apache-2.0
/// @file
/// Vector instructions for the peers: a function is written once as plain loops, compiled for what
/// every x86-64 has, for AVX2 and for AVX-512, and the best that the processor has is called. The
/// library does the same for itself (src/lanes.c), so the peers get it too.
#ifndef OCC_BENCH_PEER_LANES_H
#define OCC_BENCH_PEER_LANES_H

#include <stdint.h>

#define PEER_INLINE static inline __attribute__((always_inline))

/// After `PEER_INLINE type name(...)`: defines `name_best` with the same parameters. `parameters`
/// and `arguments` are in parentheses.
#if defined(__x86_64__)
#define PEER_LANES_VARIANTS(type, name, parameters, arguments)                                     \
    __attribute__((                                                                                \
        target("avx512f,avx512dq,avx512bw,avx512vl"))) static type name##_avx512 parameters        \
    {                                                                                              \
        return name arguments;                                                                     \
    }                                                                                              \
    __attribute__((target("avx2"))) static type name##_avx2 parameters                             \
    {                                                                                              \
        return name arguments;                                                                     \
    }                                                                                              \
    static type name##_best parameters                                                             \
    {                                                                                              \
        if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&            \
            __builtin_cpu_supports("avx512dq"))                                                    \
            return name##_avx512 arguments;                                                        \
        if (__builtin_cpu_supports("avx2")) return name##_avx2 arguments;                          \
        return name arguments;                                                                     \
    }
#else
#define PEER_LANES_VARIANTS(type, name, parameters, arguments)                                     \
    static type name##_best parameters                                                             \
    {                                                                                              \
        return name arguments;                                                                     \
    }
#endif

/// Bit i is 1 where values[i] is not negative, for 32 values.
PEER_INLINE uint32_t peer_lanes_not_negative(const float *values)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 32; i++)
        bits |= (uint32_t)(values[i] >= 0.0f) << i;
    return bits;
}

#endif
