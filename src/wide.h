// SPDX-License-Identifier: Apache-2.0
// Vectors of 8 and 16 floats, and their comparisons as bits. Include before geometry.h.
#ifndef OCC_WIDE_H
#define OCC_WIDE_H

#ifndef __GNUC__
#error "occlude needs the vector extension of gcc or clang"
#endif

#include <math.h>
#include <stdint.h>
#include <string.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif
#pragma GCC diagnostic ignored "-Wpsabi" // vectors are passed between inlined functions only

typedef float f8 __attribute__((vector_size(32)));
typedef float f16 __attribute__((vector_size(64)));
typedef int32_t i8 __attribute__((vector_size(32)));
typedef int32_t i16 __attribute__((vector_size(64)));

static inline f8 abs8(f8 x)
{
    return (f8)((i8)x & 0x7fffffff);
}

static inline f16 abs16(f16 x)
{
    return (f16)((i16)x & 0x7fffffff);
}

#define OCC_FABS(x) _Generic((x), float : fabsf, f8 : abs8, f16 : abs16)(x)

static inline f16 load16(const float *from)
{
    f16 x;
    memcpy(&x, from, sizeof x);
    return x;
}

// Bit l is lane l's sign: of a comparison's result, whether it holds.
static inline uint32_t bits8(i8 truth)
{
#if defined(__AVX2__)
    return (uint32_t)_mm256_movemask_ps((__m256)truth);
#else
    uint32_t bits = 0;
    for (uint32_t l = 0; l < 8; l++)
        bits |= ((uint32_t)truth[l] >> 31) << l;
    return bits;
#endif
}

static inline uint32_t bits16(i16 truth)
{
#if defined(__AVX512DQ__)
    return _mm512_movepi32_mask((__m512i)truth);
#else
    i8 half[2];
    memcpy(half, &truth, sizeof half);
    return bits8(half[0]) | bits8(half[1]) << 8;
#endif
}

#endif
