// SPDX-License-Identifier: Apache-2.0
#include "exact_side.h"

#include <gmp.h>

static void set_difference(mpq_t out, double value, double less)
{
    mpq_t other;
    mpq_init(other);
    mpq_set_d(out, value);
    mpq_set_d(other, less);
    mpq_sub(out, out, other);
    mpq_clear(other);
}

int exact_volume(double a[3][3], double b[3][3])
{
    mpq_t m[3][3], sum, term;
    mpq_inits(sum, term, NULL);
    for (int i = 0; i < 9; i++) {
        mpq_init(m[i / 3][i % 3]);
        set_difference(m[i / 3][i % 3], a[i / 3][i % 3], b[i / 3][i % 3]);
    }
    for (int i = 0; i < 3; i++)
        for (int odd = 0; odd < 2; odd++) {
            mpq_mul(term, m[0][i], m[1][(i + 1 + odd) % 3]);
            mpq_mul(term, term, m[2][(i + 2 - odd) % 3]);
            if (odd) mpq_neg(term, term);
            mpq_add(sum, sum, term);
        }
    int sign = mpq_sgn(sum);
    for (int i = 0; i < 9; i++)
        mpq_clear(m[i / 3][i % 3]);
    mpq_clears(sum, term, NULL);
    return sign;
}

int exact_side(const occ_box *box, int face, int end, const double point[3])
{
    double a[3][3], b[3][3] = {{0}}, inward[3][3], zero[3][3] = {{0}};
    for (int j = 0; j < 3; j++) {
        a[0][j] = point[j];
        b[0][j] = (double)box->center[j] + end * (double)box->axis[face][j];
        a[1][j] = inward[1][j] = (double)box->axis[(face + 1) % 3][j];
        a[2][j] = inward[2][j] = (double)box->axis[(face + 2) % 3][j];
        inward[0][j] = -end * (double)box->axis[face][j];
    }
    int own = exact_volume(inward, zero);
    return exact_volume(a, b) * (own ? -own : 1);
}
