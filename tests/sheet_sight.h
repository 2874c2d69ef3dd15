// SPDX-License-Identifier: Apache-2.0
// What a sheet's own triangles hide of a point: exact, by the signs of determinants of rationals,
// and without anything of the library's. Include <gmp.h> first.
#ifndef OCC_TEST_SHEET_SIGHT_H
#define OCC_TEST_SHEET_SIGHT_H

#include <math.h>
#include <occlude/scene.h>

// Where one looks from: an eye, or the direction to a viewer at infinity.
typedef struct sight_from {
    double at[3];
    bool direction;
} sight_from;

typedef struct sight_vector {
    long double about[3]; // each within 2^-63 of itself
    double plus[3];       // exactly plus - minus
    double minus[3];
} sight_vector;

static inline sight_vector sight_difference(const double plus[3], const double minus[3])
{
    sight_vector v;
    for (int j = 0; j < 3; j++) {
        v.plus[j] = plus[j];
        v.minus[j] = minus[j];
        v.about[j] = (long double)plus[j] - (long double)minus[j];
    }
    return v;
}

static inline void sight_set(mpq_t out, const sight_vector *v, int j)
{
    mpq_t minus;
    mpq_init(minus);
    mpq_set_d(out, v->plus[j]);
    mpq_set_d(minus, v->minus[j]);
    mpq_sub(out, out, minus);
    mpq_clear(minus);
}

static inline int sight_exact_sign(const sight_vector *a, const sight_vector *b,
                                   const sight_vector *c)
{
    mpq_t x, y, z, sum;
    mpq_inits(x, y, z, sum, NULL);
    for (int term = 0; term < 6; term++) {
        int i = term % 3, j = (i + (term < 3 ? 1 : 2)) % 3, k = 3 - i - j;
        sight_set(x, a, i);
        sight_set(y, b, j);
        sight_set(z, c, k);
        mpq_mul(x, x, y);
        mpq_mul(x, x, z);
        if (term < 3) {
            mpq_add(sum, sum, x);
        } else {
            mpq_sub(sum, sum, x);
        }
    }
    int sign = mpq_sgn(sum);
    mpq_clears(x, y, z, sum, NULL);
    return sign;
}

// The sign of the determinant of three vectors.
static inline int sight_sign(const sight_vector *a, const sight_vector *b, const sight_vector *c)
{
    long double sum = 0, size = 0;
    for (int term = 0; term < 6; term++) {
        int i = term % 3, j = (i + (term < 3 ? 1 : 2)) % 3, k = 3 - i - j;
        long double product = a->about[i] * b->about[j] * c->about[k];
        sum += term < 3 ? product : -product;
        size += fabsl(product);
    }
    if (sum > size * 1e-17L) return 1;
    if (sum < size * -1e-17L) return -1;
    return size > 0 ? sight_exact_sign(a, b, c) : 0;
}

// Whether a triangle, its rim included, is met by the segment from the point to the eye; not in its
// ends. *front: its corners go counterclockwise for the eye.
static inline bool sight_crosses(const sight_from *from, const double corner[3][3],
                                 const double point[3], bool *front)
{
    static const double nothing[3];
    sight_vector ray =
        from->direction ? sight_difference(from->at, nothing) : sight_difference(from->at, point);
    sight_vector to[3], edge[2];
    int sign[3];
    for (int i = 0; i < 3; i++)
        to[i] = sight_difference(corner[i], point);
    for (int i = 0; i < 3; i++)
        sign[i] = sight_sign(&ray, &to[i], &to[(i + 1) % 3]);
    bool left = sign[0] >= 0 && sign[1] >= 0 && sign[2] >= 0;
    bool right = sign[0] <= 0 && sign[1] <= 0 && sign[2] <= 0;
    if (left == right) return false; // beside it, or in its plane
    for (int i = 0; i < 2; i++)
        edge[i] = sight_difference(corner[i + 1], corner[0]);
    // The point and the eye are on different sides of its plane.
    int side = sight_sign(&to[0], &edge[0], &edge[1]);
    int eye_side = sight_sign(&ray, &edge[0], &edge[1]);
    if (!from->direction) {
        sight_vector back = sight_difference(corner[0], from->at);
        eye_side = -sight_sign(&back, &edge[0], &edge[1]);
    }
    *front = eye_side > 0;
    return side && eye_side == side;
}

// Whether the fan of the sheet from corner `first` hides a point: with another fan, another surface
// with the same outline does.
static inline bool sight_is_hidden(const sight_from *from, const occ_sheet *sheet, uint32_t first,
                                   const double point[3])
{
    uint32_t n = sheet->corner_count;
    for (uint32_t i = 1; i + 1 < n; i++) {
        const uint32_t which[3] = {first, (first + i) % n, (first + i + 1) % n};
        double corner[3][3];
        bool front;
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < 3; j++)
                corner[c][j] = (double)sheet->corner[which[c]][j];
        if (!sight_crosses(from, (const double(*)[3])corner, point, &front)) continue;
        if (front || sheet->sides == OCC_SIDES_BOTH) return true;
    }
    return false;
}

#endif
