// SPDX-License-Identifier: Apache-2.0
// Sums and products of floats without any rounding, for the questions whose answers must not
// depend on it: are these points in one plane, on which side, inside or not.
//
// A number is an integer in units of 2^-149 to the power of the factors multiplied into it (every
// float is a multiple of 2^-149); it has room for three factors below 2^58 each. Only numbers of
// as many factors may be added.
#ifndef OCC_UNROUNDED_H
#define OCC_UNROUNDED_H

#include <stdint.h>

#define OCC_UNROUNDED_LIMBS 20

// Sign and magnitude, least limb first; `used` limbs, the last of which is not zero. Those below
// `low` are zero.
typedef struct occ_unrounded {
    int sign; // -1, 0 or 1
    uint32_t low, used;
    uint32_t limb[OCC_UNROUNDED_LIMBS];
} occ_unrounded;

// A finite float, as it is.
occ_unrounded occ_unrounded_from(float value);

occ_unrounded occ_unrounded_add(const occ_unrounded *a, const occ_unrounded *b);
occ_unrounded occ_unrounded_subtract(const occ_unrounded *a, const occ_unrounded *b);
occ_unrounded occ_unrounded_multiply(const occ_unrounded *a, const occ_unrounded *b);

// -1, 0 or 1, as |a| is less than, equal to or greater than |b|.
int occ_unrounded_compare_magnitude(const occ_unrounded *a, const occ_unrounded *b);

// A point or vector.
typedef struct occ_unrounded_vector {
    occ_unrounded at[3];
} occ_unrounded_vector;

occ_unrounded_vector occ_unrounded_vector_from(const float v[3]);
occ_unrounded_vector occ_unrounded_vector_add(const occ_unrounded_vector *a,
                                              const occ_unrounded_vector *b);
occ_unrounded_vector occ_unrounded_vector_subtract(const occ_unrounded_vector *a,
                                                   const occ_unrounded_vector *b);

// a[i] * b[j] - a[j] * b[i]: two factors.
occ_unrounded occ_unrounded_minor(const occ_unrounded_vector *a, const occ_unrounded_vector *b,
                                  int i, int j);

// a x b and a . b: the sum of their factors.
occ_unrounded_vector occ_unrounded_cross(const occ_unrounded_vector *a,
                                         const occ_unrounded_vector *b);
occ_unrounded occ_unrounded_dot(const occ_unrounded_vector *a, const occ_unrounded_vector *b);

// a . (b x c): three factors. Zero exactly when the three are in one plane.
occ_unrounded occ_unrounded_determinant(const occ_unrounded_vector *a,
                                        const occ_unrounded_vector *b,
                                        const occ_unrounded_vector *c);

#endif
