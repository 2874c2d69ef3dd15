// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sums and products of floats without any rounding, for the questions whose answers must not
/// depend on it: are these points in one plane, on which side, inside or not.
///
/// A number is an integer in units of 2^-149 to the power of the factors multiplied into it (every
/// float is a multiple of 2^-149); it has room for three factors below 2^58 each. Only numbers of
/// as many factors may be added.
#ifndef OCC_BENCH_UNROUNDED_H
#define OCC_BENCH_UNROUNDED_H

#include <stdint.h>

#define UNROUNDED_LIMBS 20

/// Sign and magnitude, least limb first; `used` limbs, the last of which is not zero.
typedef struct unrounded {
    int sign; ///< -1, 0 or 1.
    uint32_t used;
    uint32_t limb[UNROUNDED_LIMBS];
} unrounded;

/// A finite float, as it is.
unrounded unrounded_from(float value);

unrounded unrounded_add(const unrounded *a, const unrounded *b);
unrounded unrounded_subtract(const unrounded *a, const unrounded *b);
unrounded unrounded_multiply(const unrounded *a, const unrounded *b);

/// -1, 0 or 1, as |a| is less than, equal to or greater than |b|.
int unrounded_compare_magnitude(const unrounded *a, const unrounded *b);

/// A point or vector of one factor.
typedef struct unrounded_vector {
    unrounded at[3];
} unrounded_vector;

unrounded_vector unrounded_vector_from(const float v[3]);
unrounded_vector unrounded_vector_add(const unrounded_vector *a, const unrounded_vector *b);
unrounded_vector unrounded_vector_subtract(const unrounded_vector *a, const unrounded_vector *b);

/// a[i] * b[j] - a[j] * b[i]: two factors.
unrounded unrounded_minor(const unrounded_vector *a, const unrounded_vector *b, int i, int j);

/// a . (b x c): three factors. Zero exactly when the three are in one plane.
unrounded unrounded_determinant(const unrounded_vector *a, const unrounded_vector *b,
                                const unrounded_vector *c);

#endif
