// SPDX-License-Identifier: Apache-2.0
// Doubles decide where their error, bounded as by Shewchuk (1997), leaves no doubt.
#include "soup/sides.h"

#include "soup/unrounded.h"

#include <math.h>

// Of a determinant of differences: 7 roundings and some slack, relative to the sum of magnitudes.
#define DETERMINANT_ERROR (8.0 * 0x1p-53)
#define MINOR_ERROR       (4.0 * 0x1p-53)

static int sign_of(double x)
{
    return x > 0.0 ? 1 : x < 0.0 ? -1 : 0;
}

static int exact_side(const float a[3], const float b[3], const float c[3], const float d[3])
{
    occ_unrounded_vector p = occ_unrounded_vector_from(a), u = occ_unrounded_vector_from(b),
                         v = occ_unrounded_vector_from(c), w = occ_unrounded_vector_from(d);
    u = occ_unrounded_vector_subtract(&u, &p);
    v = occ_unrounded_vector_subtract(&v, &p);
    w = occ_unrounded_vector_subtract(&w, &p);
    return occ_unrounded_determinant(&w, &u, &v).sign;
}

int occ_side_of_plane(const float a[3], const float b[3], const float c[3], const float d[3])
{
    double u[3], v[3], w[3], sum = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
        w[k] = (double)d[k] - (double)a[k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        sum += w[k] * (u[i] * v[j] - u[j] * v[i]);
        size += fabs(w[k]) * (fabs(u[i] * v[j]) + fabs(u[j] * v[i]));
    }
    if (fabs(sum) > DETERMINANT_ERROR * 1.5 * size) return sign_of(sum);
    return size == 0.0 ? 0 : exact_side(a, b, c, d);
}

static int exact_turn(const float a[2], const float b[2], const float c[2])
{
    occ_unrounded_vector p = occ_unrounded_vector_from((float[3]){a[0], a[1], 0.0f}),
                         u = occ_unrounded_vector_from((float[3]){b[0], b[1], 0.0f}),
                         v = occ_unrounded_vector_from((float[3]){c[0], c[1], 0.0f});
    u = occ_unrounded_vector_subtract(&u, &p);
    v = occ_unrounded_vector_subtract(&v, &p);
    return occ_unrounded_minor(&u, &v, 0, 1).sign;
}

int occ_turn(const float a[2], const float b[2], const float c[2])
{
    double u[2] = {(double)b[0] - (double)a[0], (double)b[1] - (double)a[1]};
    double v[2] = {(double)c[0] - (double)a[0], (double)c[1] - (double)a[1]};
    double minor = u[0] * v[1] - u[1] * v[0];
    double size = fabs(u[0] * v[1]) + fabs(u[1] * v[0]);
    if (fabs(minor) > MINOR_ERROR * size) return sign_of(minor);
    return size == 0.0 ? 0 : exact_turn(a, b, c);
}

static bool exactly_in_line(const float a[3], const float b[3], const float m[3])
{
    occ_unrounded_vector p = occ_unrounded_vector_from(a), u = occ_unrounded_vector_from(b),
                         v = occ_unrounded_vector_from(m);
    u = occ_unrounded_vector_subtract(&u, &p);
    v = occ_unrounded_vector_subtract(&v, &p);
    for (int k = 0; k < 3; k++)
        if (occ_unrounded_minor(&u, &v, k, (k + 1) % 3).sign) return false;
    return true;
}

bool occ_between(const float a[3], const float b[3], const float m[3])
{
    bool apart = false;
    for (int k = 0; k < 3; k++) {
        if (m[k] < fminf(a[k], b[k]) || m[k] > fmaxf(a[k], b[k])) return false;
        if (a[k] == b[k]) continue;
        if (m[k] == a[k] || m[k] == b[k]) return false;
        apart = true;
    }
    if (!apart) return false;
    for (int k = 0; k < 3; k++) {
        int j = (k + 1) % 3;
        double u[2] = {(double)b[k] - (double)a[k], (double)b[j] - (double)a[j]};
        double v[2] = {(double)m[k] - (double)a[k], (double)m[j] - (double)a[j]};
        double minor = u[0] * v[1] - u[1] * v[0];
        double size = fabs(u[0] * v[1]) + fabs(u[1] * v[0]);
        if (fabs(minor) > MINOR_ERROR * size) return false;
    }
    return exactly_in_line(a, b, m);
}
