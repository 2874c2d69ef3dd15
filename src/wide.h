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

// Bits of the lanes in which x > y.
static inline uint32_t above_node(fnode x, fnode y)
{
#if OCC_WIDTH == 16
    return _mm256_cmp_ps_mask((__m256)x, (__m256)y, _CMP_GT_OQ);
#else
    return bits_node(x > y);
#endif
}

static inline uint32_t above_wide(fwide x, fwide y)
{
#if OCC_WIDTH == 16
    return _mm512_cmp_ps_mask((__m512)x, (__m512)y, _CMP_GT_OQ);
#else
    return above_node(x, y);
#endif
}

// Bits of the lanes in which x is not above y, NaN included.
static inline uint32_t not_above_wide(fwide x, fwide y)
{
#if OCC_WIDTH == 16
    return _mm512_cmp_ps_mask((__m512)x, (__m512)y, _CMP_NGT_UQ);
#else
    return above_wide(x, y) ^ ((1u << OCC_WIDTH) - 1u);
#endif
}

// Bits of the lanes in which none of four is above its partner.
static inline uint32_t none_above_wide(const fwide x[4], const fwide y[4])
{
#if OCC_WIDTH == 16
    __mmask16 bits = _mm512_cmp_ps_mask((__m512)x[0], (__m512)y[0], _CMP_NGT_UQ);
    bits = _mm512_mask_cmp_ps_mask(bits, (__m512)x[1], (__m512)y[1], _CMP_NGT_UQ);
    bits = _mm512_mask_cmp_ps_mask(bits, (__m512)x[2], (__m512)y[2], _CMP_NGT_UQ);
    return _mm512_mask_cmp_ps_mask(bits, (__m512)x[3], (__m512)y[3], _CMP_NGT_UQ);
#else
    return not_above_wide(x[0], y[0]) & not_above_wide(x[1], y[1]) & not_above_wide(x[2], y[2]) &
           not_above_wide(x[3], y[3]);
#endif
}

static inline fnode splat_node(float x)
{
    return x - (fnode){0.0f};
}

static inline fwide splat_wide(float x)
{
    return x - (fwide){0.0f};
}

static inline fnode load_node(const float *from)
{
    fnode x;
    memcpy(&x, from, sizeof x);
    return x;
}

static inline void store_node(float *to, fnode x)
{
    memcpy(to, &x, sizeof x);
}

// Where a comparison holds: x, else y.
static inline fnode select_node(inode truth, fnode x, fnode y)
{
    return (fnode)(((inode)x & truth) | ((inode)y & ~truth));
}

// The largest of the lanes that `lanes` names (at least one).
static inline float largest_of_wide(fwide x, uint32_t lanes)
{
#if OCC_WIDTH == 16
    return _mm512_mask_reduce_max_ps((__mmask16)lanes, (__m512)x);
#else
    float most = -INFINITY;
    for (uint32_t l = 0; l < OCC_WIDTH; l++)
        if ((lanes >> l & 1u) && x[l] > most) most = x[l];
    return most;
#endif
}

#if OCC_NODE_WIDTH == 8
// Lanes of x in the order of an index.
static inline fnode permute_node(fnode x, inode index)
{
    return (fnode)_mm256_permutevar8x32_ps((__m256)x, (__m256i)index);
}

// Lanes of x, and from index 8 on of y.
static inline fnode permute_two(fnode x, fnode y, inode index)
{
#if OCC_WIDTH == 16
    return (fnode)_mm256_permutex2var_ps((__m256)x, (__m256i)index, (__m256)y);
#else
    return (fnode)_mm256_blendv_ps((__m256)permute_node(x, index), (__m256)permute_node(y, index),
                                   (__m256)(index << 28));
#endif
}
#endif

// The least and the largest of eight floats.
static inline float least_of_eight(const float *x)
{
    float a[4];
    for (uint32_t i = 0; i < 4; i++)
        a[i] = x[i] < x[i + 4] ? x[i] : x[i + 4];
    float b = a[0] < a[1] ? a[0] : a[1], c = a[2] < a[3] ? a[2] : a[3];
    return b < c ? b : c;
}

static inline float largest_of_eight(const float *x)
{
    float a[4];
    for (uint32_t i = 0; i < 4; i++)
        a[i] = x[i] > x[i + 4] ? x[i] : x[i + 4];
    float b = a[0] > a[1] ? a[0] : a[1], c = a[2] > a[3] ? a[2] : a[3];
    return b > c ? b : c;
}

// Packs those of sixteen floats that `lanes` names. May write up to sixteen.
static inline void compress_sixteen(float *to, const float *from, uint32_t lanes)
{
#if OCC_WIDTH == 16
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps((__mmask16)lanes, _mm512_loadu_ps(from)));
#else
    for (; lanes; lanes &= lanes - 1u)
        *to++ = from[__builtin_ctz(lanes)];
#endif
}

// Appends first + l for every lane l of sixteen that `lanes` names. May write up to sixteen.
static inline void compress_indices(uint32_t *to, uint32_t first, uint32_t lanes)
{
#if OCC_WIDTH == 16
    const __m512i iota = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    __m512i index = _mm512_add_epi32(iota, _mm512_set1_epi32((int)first));
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)lanes, index));
#else
    for (; lanes; lanes &= lanes - 1u)
        *to++ = first + (uint32_t)__builtin_ctz(lanes);
#endif
}

#endif
