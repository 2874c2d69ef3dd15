// SPDX-License-Identifier: Apache-2.0
// Three doubles. cglm works in float, and set-up needs more.
#ifndef OCC_VECTOR_H
#define OCC_VECTOR_H

#include <math.h>
#include <stdint.h>
#include <string.h>

static inline double occ_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// |a_0 b_0| + |a_1 b_1| + |a_2 b_2|: what the rounding error of occ_dot() is proportional to.
static inline double occ_dot_magnitude(const double a[3], const double b[3])
{
    return fabs(a[0] * b[0]) + fabs(a[1] * b[1]) + fabs(a[2] * b[2]);
}

static inline void occ_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// The larger of two numbers. (fmax() minds NaN, and is a call.)
static inline double occ_larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double occ_largest(const double a[3])
{
    return occ_larger(fabs(a[0]), occ_larger(fabs(a[1]), fabs(a[2])));
}

// occ_unit_scale() of numbers whose exponent is out of the ordinary.
static inline double exact_unit_scale(double value)
{
    int exponent;
    (void)frexp(value, &exponent);
    return ldexp(1.0, -exponent);
}

// 2^-e for the e that puts |value| into [1/2, 1); value must be neither 0 nor infinite.
static inline double occ_unit_scale(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint64_t exponent = bits >> 52;
    if (exponent - 1u >= 2043u) return exact_unit_scale(value);
    bits = (2045u - exponent) << 52;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
