// SPDX-License-Identifier: Apache-2.0
// Vectors as wide as the target has them, and their comparisons as bits. Include before geometry.h.
// No wider: compilers spill what they must split.
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

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define OCC_WIDTH 16
#elif defined(__AVX2__)
#define OCC_WIDTH 8
#else
#define OCC_WIDTH 4 // SSE2, NEON, or whatever the compiler makes of it
#endif

// As wide as the target, for objects and shadows; and at most 8 wide, for siblings.
typedef float fwide __attribute__((vector_size(4 * OCC_WIDTH)));
typedef int32_t iwide __attribute__((vector_size(4 * OCC_WIDTH)));
#if OCC_WIDTH > 8
#define OCC_NODE_WIDTH 8
#else
#define OCC_NODE_WIDTH OCC_WIDTH
#endif
typedef float fnode __attribute__((vector_size(4 * OCC_NODE_WIDTH)));
typedef int32_t inode __attribute__((vector_size(4 * OCC_NODE_WIDTH)));

static inline fwide abs_wide(fwide x)
{
    return (fwide)((iwide)x & 0x7fffffff);
}

#if OCC_WIDTH > 8
static inline fnode abs_node(fnode x)
{
    return (fnode)((inode)x & 0x7fffffff);
}
#define OCC_FABS(x) _Generic((x), float : fabsf, fnode : abs_node, fwide : abs_wide)(x)
#else
#define OCC_FABS(x) _Generic((x), float : fabsf, fwide : abs_wide)(x)
#endif

static inline fwide load_wide(const float *from)
{
    fwide x;
    memcpy(&x, from, sizeof x);
    return x;
}

// Bit l says whether a comparison holds in lane l.
static inline uint32_t bits_node(inode truth)
{
#if OCC_NODE_WIDTH == 8
    return (uint32_t)_mm256_movemask_ps((__m256)truth);
#elif defined(__SSE2__)
    return (uint32_t)_mm_movemask_ps((__m128)truth);
#else
    uint32_t bits = 0;
    for (uint32_t l = 0; l < OCC_NODE_WIDTH; l++)
        bits |= ((uint32_t)truth[l] >> 31) << l;
    return bits;
#endif
}

static inline uint32_t bits_wide(iwide truth)
{
#if OCC_WIDTH == 16
    return _mm512_movepi32_mask((__m512i)truth);
#else
    return bits_node(truth);
#endif
}

// Where a comparison holds: x, else y.
static inline fwide select_wide(iwide truth, fwide x, fwide y)
{
    return (fwide)(((iwide)x & truth) | ((iwide)y & ~truth));
}

#if OCC_WIDTH == 16
// Lane l of the result is lane index[l] of x.
static inline fwide permute_wide(fwide x, iwide index)
{
    return (fwide)_mm512_permutexvar_ps((__m512i)index, (__m512)x);
}
#endif

// The largest of the lanes that `lanes` names, or 0 if none is larger.
static inline float largest_of_wide(fwide x, uint32_t lanes)
{
#if OCC_WIDTH == 16
    return _mm512_reduce_max_ps(_mm512_maskz_mov_ps((__mmask16)lanes, (__m512)x));
#else
    float most = 0.0f;
    for (uint32_t l = 0; l < OCC_WIDTH; l++)
        if ((lanes >> l & 1u) && x[l] > most) most = x[l];
    return most;
#endif
}

#endif
