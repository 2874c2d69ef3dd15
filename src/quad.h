// SPDX-License-Identifier: Apache-2.0
// Four doubles at once. Where the target's vectors are shorter the compiler makes two of each.
#ifndef OCC_QUAD_H
#define OCC_QUAD_H

#ifndef __GNUC__
#error "occlude needs the vector extension of gcc or clang"
#endif

#include <math.h>
#include <stdint.h>
#include <string.h>
#ifdef __AVX__
#include <immintrin.h>
#endif

typedef double quad __attribute__((vector_size(32)));
typedef int64_t quad_truth __attribute__((vector_size(32))); // all bits of a lane, or none
typedef uint64_t quad_bits __attribute__((vector_size(32)));
typedef double half_quad __attribute__((vector_size(16)));
typedef float quad_float __attribute__((vector_size(16)));
typedef int32_t quad_int __attribute__((vector_size(16)));

// Lanes a to d of two vectors one after the other. Numbers known when compiling.
#if defined(__clang__) || __GNUC__ >= 12
#define OCC_SHUFFLE(kind, x, y, a, b, c, d) __builtin_shufflevector(x, y, a, b, c, d)
#else
#define OCC_SHUFFLE(kind, x, y, a, b, c, d) __builtin_shuffle(x, y, (kind){a, b, c, d})
#endif

static inline quad make_quad(double a, double b, double c, double d)
{
#ifdef __AVX__
    return (quad){a, b, c, d};
#else
    // Not so: gcc 12 writes them to memory one by one and waits for them there.
    half_quad half[2] = {{a, b}, {c, d}};
    quad x;
    memcpy(&x, half, sizeof x);
    return x;
#endif
}

static inline quad splat_quad(double x)
{
    return make_quad(x, x, x, x);
}

static inline quad abs_quad(quad x)
{
    return (quad)((quad_truth)x & INT64_MAX);
}

// Where x > y, neither of them a NaN or infinite.
static inline quad_truth above_quad(quad x, quad y)
{
#ifdef __AVX__
    return x > y;
#else
    return (quad_truth)(0 - ((quad_bits)(y - x) >> 63)); // gcc 12 would compare lane by lane
#endif
}

// Where something holds: x, else 0.
static inline quad where_quad(quad_truth truth, quad x)
{
    return (quad)((quad_truth)x & truth);
}

static inline quad larger_quad(quad x, quad y)
{
    quad_truth above = above_quad(x, y);
    return (quad)(((quad_truth)x & above) | ((quad_truth)y & ~above));
}

// Bit l says whether something holds in lane l.
static inline uint32_t bits_quad(quad_truth truth)
{
#ifdef __AVX__
    return (uint32_t)_mm256_movemask_pd((__m256d)truth);
#else
    uint32_t bits = 0;
    for (uint32_t l = 0; l < 4; l++)
        bits |= (uint32_t)((uint64_t)truth[l] >> 63) << l;
    return bits;
#endif
}

static inline quad dot_quad(const quad a[3], const quad b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// |a_0 b_0| + |a_1 b_1| + |a_2 b_2|: what the rounding error of dot_quad() is proportional to.
static inline quad dot_magnitude_quad(const quad a[3], const quad b[3])
{
    return abs_quad(a[0] * b[0]) + abs_quad(a[1] * b[1]) + abs_quad(a[2] * b[2]);
}

static inline void cross_quad(const quad a[3], const quad b[3], quad out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline quad largest_quad(const quad a[3])
{
    return larger_quad(abs_quad(a[0]), larger_quad(abs_quad(a[1]), abs_quad(a[2])));
}

// 2^-e for the e that puts x into [1/2, 1), if x is in [2^-1000, 2^1000].
static inline quad unit_scale_quad(quad x)
{
    return (quad)((2045u - ((quad_bits)x >> 52)) << 52);
}

// The nearest floats. Never to be made doubles again: gcc 12 (rounding.h) would take them for x.
static inline quad_float round_quad(quad x)
{
    return __builtin_convertvector(x, quad_float);
}

#define LOST_BITS 0x1fffffffu // of a double, those that a float has no room for

// Floats that are not above x, and less by less than two units in their last place: the bits that a
// float lacks are cut off, after a carry into its last one if x < 0. Where floats have fewer bits,
// 2^-148 is more than the conversion rounds.
static inline quad_float round_down_quad(quad x)
{
    quad_truth negative = (quad_truth)(0 - ((quad_bits)x >> 63));
    quad_truth is_zero = ~(above_quad(x, splat_quad(0.0)) | negative);
    x -= where_quad(~is_zero, splat_quad(0x1p-148));
    negative = (quad_truth)(0 - ((quad_bits)x >> 63));
    quad_bits bits = (quad_bits)x + ((quad_bits)negative & LOST_BITS);
    return round_quad((quad)(bits & ~(uint64_t)LOST_BITS));
}

// Rows of a matrix of four from its columns.
static inline void turn_quad(const quad_float column[4], float row[4][4])
{
    quad_float low[2], high[2], out[4];
    for (int j = 0; j < 2; j++) {
        low[j] = OCC_SHUFFLE(quad_int, column[j], column[j + 2], 0, 4, 1, 5);
        high[j] = OCC_SHUFFLE(quad_int, column[j], column[j + 2], 2, 6, 3, 7);
    }
    out[0] = OCC_SHUFFLE(quad_int, low[0], low[1], 0, 4, 1, 5);
    out[1] = OCC_SHUFFLE(quad_int, low[0], low[1], 2, 6, 3, 7);
    out[2] = OCC_SHUFFLE(quad_int, high[0], high[1], 0, 4, 1, 5);
    out[3] = OCC_SHUFFLE(quad_int, high[0], high[1], 2, 6, 3, 7);
    memcpy(row, out, sizeof out);
}

#undef LOST_BITS

#endif
