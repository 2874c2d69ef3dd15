// SPDX-License-Identifier: Apache-2.0
// Vectors of integers without bound, in a unit of 2^-places: what the judge and the oracle
// compute with.
#ifndef OCC_JUDGE_EXACT_H
#define OCC_JUDGE_EXACT_H

#include <gmp.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef mpz_t exact3[3];

static inline void exact_init(mpz_t *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        mpz_init(numbers[i]);
}

static inline void exact_clear(mpz_t *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        mpz_clear(numbers[i]);
}

// How many binary places behind the point `value` has.
static inline long exact_places(double value)
{
    int exponent;
    if (value == 0.0) return 0;
    double mantissa = ldexp(frexp(value, &exponent), 53);
    long places = 53L - exponent;
    for (; fmod(mantissa, 2.0) == 0.0; mantissa /= 2.0)
        places--;
    return places > 0 ? places : 0;
}

// value * 2^places, where `value` has at most so many.
static inline void exact_set(mpz_t out, double value, long places)
{
    int exponent;
    double mantissa = ldexp(frexp(value, &exponent), 53);
    long shift = exponent - 53L + places;
    mpz_set_d(out, mantissa);
    if (shift >= 0) {
        mpz_mul_2exp(out, out, (mp_bitcnt_t)shift);
    } else {
        mpz_tdiv_q_2exp(out, out, (mp_bitcnt_t)-shift); // the bits that go are zero
    }
}

static inline void exact_dot(mpz_t out, mpz_t *a, mpz_t *b)
{
    mpz_mul(out, a[0], b[0]);
    mpz_addmul(out, a[1], b[1]);
    mpz_addmul(out, a[2], b[2]);
}

// `out` is neither `a` nor `b`.
static inline void exact_cross(mpz_t *out, mpz_t *a, mpz_t *b)
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        mpz_mul(out[j], a[p], b[q]);
        mpz_submul(out[j], a[q], b[p]);
    }
}

static inline bool exact_is_zero(mpz_t *a)
{
    return mpz_sgn(a[0]) == 0 && mpz_sgn(a[1]) == 0 && mpz_sgn(a[2]) == 0;
}

#endif
