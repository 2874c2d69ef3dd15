// SPDX-License-Identifier: Apache-2.0
#include "sight.h"

#include "world.h"

#include <math.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        out[j] = a[p] * b[q] - a[q] * b[p];
    }
}

// The square of the distance of x to the cone of a and b, or to that of a alone where b is NULL.
static double squared_distance(const double x[3], const double *a, const double *b)
{
    double aa = dot(a, a), ax = dot(a, x), f = ax / aa, g = 0.0;
    if (b) {
        double ab = dot(a, b), bb = dot(b, b), bx = dot(b, x), whole = aa * bb - ab * ab;
        f = (ax * bb - bx * ab) / whole;
        g = (bx * aa - ax * ab) / whole;
    }
    if (!(f >= 0.0 && g >= 0.0)) return INFINITY;
    double sum = 0.0;
    for (int j = 0; j < 3; j++) {
        double left = x[j] - f * a[j] - (b ? g * b[j] : 0.0);
        sum += left * left;
    }
    return sum;
}

static bool in_cone(const double x[3], const double a[3], const double b[3], const double c[3])
{
    double ab[3], bc[3], ca[3];
    cross(a, b, ab);
    cross(b, c, bc);
    cross(c, a, ca);
    double turn = dot(ab, c) < 0.0 ? -1.0 : 1.0;
    if (fabs(dot(ab, c)) < 1e-12 * sqrt(dot(a, a) * dot(b, b) * dot(c, c))) return false;
    return turn * dot(ab, x) >= 0.0 && turn * dot(bc, x) >= 0.0 && turn * dot(ca, x) >= 0.0;
}

double sight_sine(const double eye[3], const occ_box *box, const double x[3])
{
    double corner[8][3], least = INFINITY;
    for (unsigned c = 0; c < 8; c++) {
        world_corner(box, c, corner[c]);
        for (int j = 0; j < 3; j++)
            corner[c][j] -= eye[j];
    }
    for (int a = 0; a < 8; a++) {
        least = fmin(least, squared_distance(x, corner[a], NULL));
        for (int b = 0; b < a; b++) {
            least = fmin(least, squared_distance(x, corner[a], corner[b]));
            for (int c = 0; c < b; c++)
                if (in_cone(x, corner[a], corner[b], corner[c])) return 0.0;
        }
    }
    return sqrt(least);
}

bool sight_is_behind(const double eye[3], const occ_box *box, const double point[3])
{
    for (int k = 0; k < 3; k++) {
        double a[3], b[3], n[3], center[3], reach = 0.0;
        for (int j = 0; j < 3; j++) {
            a[j] = (double)box->axis[(k + 1) % 3][j];
            b[j] = (double)box->axis[(k + 2) % 3][j];
            center[j] = (double)box->center[j] - eye[j];
        }
        cross(a, b, n);
        for (int j = 0; j < 3; j++)
            reach += n[j] * (double)box->axis[k][j];
        double side = dot(n, center), size = sqrt(dot(n, n) * dot(center, center));
        if (fabs(side) - fabs(reach) <= 1e-9 * size) continue;
        double face = side - (side > 0.0 ? fabs(reach) : -fabs(reach));
        if ((side > 0.0 ? 1.0 : -1.0) * (dot(n, point) - face) < -1e-6 * size) return false;
    }
    return true;
}
