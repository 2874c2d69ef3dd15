// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sums and products of floats without any rounding, for the questions whose answers must not
/// depend on it: are these points in one plane, on which side, inside or not.
///
/// A number is an integer in units of 2^-149 to the power of the factors multiplied into it (every
/// float is a multiple of 2^-149); it has room for three factors below 2^58 each. Only numbers of
/// as many factors may be added.
#ifndef OCC_BENCH_EXACT_H
#define OCC_BENCH_EXACT_H

#include <stdint.h>

#define EXACT_LIMBS 20

/// Sign and magnitude, least limb first; `used` limbs, the last of which is not zero.
typedef struct exact {
    int sign; ///< -1, 0 or 1.
    uint32_t used;
    uint32_t limb[EXACT_LIMBS];
} exact;

/// A finite float, as it is.
exact exact_from(float value);

exact exact_add(const exact *a, const exact *b);
exact exact_subtract(const exact *a, const exact *b);
exact exact_multiply(const exact *a, const exact *b);

/// -1, 0 or 1, as |a| is less than, equal to or greater than |b|.
int exact_compare_magnitude(const exact *a, const exact *b);

/// A point or vector of one factor.
typedef struct exact_vector {
    exact at[3];
} exact_vector;

exact_vector exact_vector_from(const float v[3]);
exact_vector exact_vector_add(const exact_vector *a, const exact_vector *b);
exact_vector exact_vector_subtract(const exact_vector *a, const exact_vector *b);

/// a[i] * b[j] - a[j] * b[i]: two factors.
exact exact_minor(const exact_vector *a, const exact_vector *b, int i, int j);

/// a . (b x c): three factors. Zero exactly when the three are in one plane.
exact exact_determinant(const exact_vector *a, const exact_vector *b, const exact_vector *c);

#endif
