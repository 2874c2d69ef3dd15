// SPDX-License-Identifier: Apache-2.0
// Numbers that know how wrong they may be: the filter before exact arithmetic. A num stands for any
// real number within e of v. With u = 2^-53, IEEE rounding to nearest gives for the result v of one
// operation |v - exact| <= u |v|, plus at most 2^-1075 where a product underflows; what the
// operands lack is carried through by the triangle inequality. The bound is itself computed with at
// most six roundings in a row, each of which loses no more than a factor of 1 - u, and times 1 +
// 2^-50 makes up for eight. DBL_MIN covers all that may underflow in between. Infinities and NaN
// make a sign unsure, since nothing compares above them.
#ifndef OCC_JUDGE_NUM_H
#define OCC_JUDGE_NUM_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

typedef struct num {
    double v, e;
} num;

enum { NUM_UNSURE = 2 };

#define NUM_ROUNDING 0x1p-53
#define NUM_SLACK    (1.0 + 0x1p-50)

static inline num num_of(double v)
{
    return (num){v, 0.0};
}

static inline num num_neg(num a)
{
    return (num){-a.v, a.e};
}

static inline num num_abs(num a)
{
    return (num){fabs(a.v), a.e};
}

static inline bool num_is_zero(num a)
{
    return a.v == 0.0 && a.e == 0.0;
}

static inline num num_add(num a, num b)
{
    if (num_is_zero(a)) return b;
    if (num_is_zero(b)) return a;
    double v = a.v + b.v;
    return (num){v, (a.e + b.e + NUM_ROUNDING * fabs(v) + DBL_MIN) * NUM_SLACK};
}

static inline num num_sub(num a, num b)
{
    return num_add(a, num_neg(b));
}

static inline num num_mul(num a, num b)
{
    if (num_is_zero(a) || num_is_zero(b)) return num_of(0.0);
    double v = a.v * b.v;
    double e = fabs(a.v) * b.e + fabs(b.v) * a.e + a.e * b.e + NUM_ROUNDING * fabs(v) + DBL_MIN;
    return (num){v, e * NUM_SLACK};
}

// -1, 0, 1, or NUM_UNSURE.
static inline int num_sign(num a)
{
    if (a.v > a.e) return 1;
    if (-a.v > a.e) return -1;
    return num_is_zero(a) ? 0 : NUM_UNSURE;
}

static inline num num_dot(const num *a, const num *b, int count)
{
    num sum = num_mul(a[0], b[0]);
    for (int i = 1; i < count; i++)
        sum = num_add(sum, num_mul(a[i], b[i]));
    return sum;
}

// `out` is neither `a` nor `b`.
static inline void num_cross(num *out, const num *a, const num *b)
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        out[j] = num_sub(num_mul(a[p], b[q]), num_mul(a[q], b[p]));
    }
}

// Times a power of two, so that products of many factors stay within range. Signs are the same.
static inline void num_tame(num *a, int count)
{
    double most = 0.0;
    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(a[i].v));
    if ((most > 0x1p-40 && most < 0x1p40) || !(most > 0.0) || most > DBL_MAX) return;
    int shift = -ilogb(most);
    for (int i = 0; i < count; i++) {
        if (num_is_zero(a[i])) continue;
        a[i].v = ldexp(a[i].v, shift);
        a[i].e = ldexp(a[i].e, shift) * NUM_SLACK + DBL_MIN;
    }
}

#endif
