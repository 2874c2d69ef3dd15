// SPDX-License-Identifier: Apache-2.0
// Candidates are made in double, with as few bits as the plane needs to hold them exactly; what is
// handed out has passed a test without rounding.
#include "parallelogram.h"

#include "soup/unrounded.h"

#include <math.h>
#include <string.h>

// The quad as exact points, and the two coordinates it is seen along: a projection that keeps area.
typedef struct quad {
    const float *const *corner;
    occ_unrounded_vector point[4];
    int i, j;  // The coordinates kept.
    int sense; // Which way round the corners go, seen so.
} quad;

// A direction as a multiple of the shortest vector along it whose floats are as coarse as its own.
typedef struct ray {
    double step[3];
    double steps; // Number of them that lead to the end.
    int bits;     // Significant bits in a step: a float multiple may have about 24 less these.
} ray;

static int side(const quad *q, const occ_unrounded_vector *a, const occ_unrounded_vector *b,
                const occ_unrounded_vector *c)
{
    occ_unrounded_vector ab = occ_unrounded_vector_subtract(b, a),
                         ac = occ_unrounded_vector_subtract(c, a);
    return occ_unrounded_minor(&ab, &ac, q->i, q->j).sign;
}

static double area_of(const double u[3], const double v[3])
{
    double n[3];
    for (int k = 0; k < 3; k++)
        n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

static void difference(double out[3], const float *a, const float *b)
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)a[k] - (double)b[k];
}

static quad make_quad(const float *const corner[4])
{
    quad q = {.corner = corner};
    double e[3], f[3], most = -1;
    difference(e, corner[2], corner[0]);
    difference(f, corner[3], corner[1]);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double projected = fabs(e[i] * f[j] - e[j] * f[i]);
        if (projected > most) {
            most = projected;
            q.i = i;
            q.j = j;
        }
    }
    for (int k = 0; k < 4; k++)
        q.point[k] = occ_unrounded_vector_from(corner[k]);
    q.sense = side(&q, &q.point[0], &q.point[1], &q.point[2]);
    return q;
}

static bool in_plane(const quad *q, const occ_unrounded_vector *p)
{
    occ_unrounded_vector a = occ_unrounded_vector_subtract(&q->point[1], &q->point[0]);
    occ_unrounded_vector b = occ_unrounded_vector_subtract(&q->point[2], &q->point[0]);
    occ_unrounded_vector c = occ_unrounded_vector_subtract(p, &q->point[0]);
    return occ_unrounded_determinant(&a, &b, &c).sign == 0;
}

static bool in_quad(const quad *q, const occ_unrounded_vector *p)
{
    for (int k = 0; k < 4; k++)
        if (side(q, &q->point[k], &q->point[(k + 1) % 4], p) == -q->sense) return false;
    return in_plane(q, p);
}

// All numbers of the box are finite floats, so the four sums are exact.
static bool box_in_quad(const quad *q, const occ_box *box)
{
    occ_unrounded_vector center = occ_unrounded_vector_from(box->center);
    occ_unrounded_vector u = occ_unrounded_vector_from(box->axis[0]),
                         v = occ_unrounded_vector_from(box->axis[1]);
    for (int k = 0; k < 4; k++) {
        occ_unrounded_vector p = k & 1 ? occ_unrounded_vector_add(&center, &u)
                                       : occ_unrounded_vector_subtract(&center, &u);
        p = k & 2 ? occ_unrounded_vector_add(&p, &v) : occ_unrounded_vector_subtract(&p, &v);
        if (!in_quad(q, &p)) return false;
    }
    return true;
}

// The exponent of the lowest bit set in a value that is not zero, and the number of bits above.
static int lowest_bit(double value, int *bits)
{
    int exponent;
    uint64_t mantissa = (uint64_t)ldexp(frexp(fabs(value), &exponent), 53);
    exponent -= 53;
    while (!(mantissa & 1)) {
        mantissa >>= 1;
        exponent++;
    }
    *bits = 0;
    for (; mantissa; mantissa >>= 1)
        ++*bits;
    return exponent;
}

static double common_divisor(double a, double b)
{
    while (b != 0.0) {
        double rest = fmod(a, b);
        a = b;
        b = rest;
    }
    return a;
}

static ray make_ray(const float *from, const float *to)
{
    ray r = {.bits = 1};
    double e[3], divisor = 0;
    difference(e, to, from);
    for (int k = 0; k < 3; k++)
        divisor = common_divisor(fabs(e[k]), divisor); // exact: fmod does not round
    if (divisor == 0.0) return r;
    r.steps = divisor;
    for (int k = 0; k < 3; k++) {
        int bits = 0;
        r.step[k] = e[k] / divisor;
        if (e[k] != 0.0) lowest_bit(r.step[k], &bits);
        if (bits > r.bits) r.bits = bits;
    }
    return r;
}

// `value` with at most `bits` significant bits, and less by at least `slack`.
static double round_down(double value, double slack, int bits)
{
    int exponent;
    if (!(value > slack)) return 0.0;
    double fraction = frexp(value - slack, &exponent);
    double scale = ldexp(1.0, bits < 1 ? 1 : bits);
    return ldexp(floor(fraction * scale) / scale, exponent);
}

// How far to go along the two rays from a corner, as shares of them: the largest product of shares
// such that the parallelogram's far corner is within the quad, whose own far corner is at (a, b).
static void largest_shares(double a, double b, double *s, double *t)
{
    double k = a < 1 ? (1 - a) / b : 0; // the edge from (1, 0) to (a, b) is s = 1 - k t
    double l = b < 1 ? (1 - b) / a : 0; // the edge from (0, 1) to (a, b) is t = 1 - l s
    const double try_t[3] = {k > 0 ? fmin(1, 1 / (2 * k)) : 1, b < 1 ? b : 1, 0};
    *s = *t = 0;
    for (int i = 0; i < 3; i++) {
        double x, y = try_t[i];
        x = 1 - k * y;
        if (i == 2) {
            x = l > 0 ? fmin(1, 1 / (2 * l)) : 1;
            y = 1 - l * x;
        }
        if (x < 0 || y < 0 || x > 1 - k * y + 1e-12 || y > 1 - l * x + 1e-12) continue;
        if (x * y > *s * *t) {
            *s = x;
            *t = y;
        }
    }
}

// Where the opposite corner is in terms of the two edges at `corner`.
static void far_corner(const quad *q, int corner, double *a, double *b)
{
    double e[3], f[3], d[3];
    const float *x = q->corner[corner];
    difference(e, q->corner[(corner + 1) % 4], x);
    difference(f, q->corner[(corner + 3) % 4], x);
    difference(d, q->corner[(corner + 2) % 4], x);
    double det = e[q->i] * f[q->j] - e[q->j] * f[q->i];
    *a = (d[q->i] * f[q->j] - d[q->j] * f[q->i]) / det;
    *b = (e[q->i] * d[q->j] - e[q->j] * d[q->i]) / det;
}

static double magnitude(const quad *q)
{
    double most = 0;
    for (int k = 0; k < 12; k++)
        most = fmax(most, fabs((double)q->corner[k / 3][k % 3]));
    return most;
}

// One candidate at a corner: half extents less by `slack` world units, with `spare` bits fewer than
// would fit.
static occ_box candidate(const float *x, const ray along[2], const double half[2], double slack,
                         int spare)
{
    occ_box box;
    double center[3] = {(double)x[0], (double)x[1], (double)x[2]};
    memset(&box, 0, sizeof box);
    for (int n = 0; n < 2; n++) {
        const ray *r = &along[n];
        double length = fmax(fabs(r->step[0]), fmax(fabs(r->step[1]), fabs(r->step[2])));
        double h = round_down(half[n], slack / length, 25 - r->bits - spare);
        for (int k = 0; k < 3; k++) {
            box.axis[n][k] = (float)(h * r->step[k]);
            center[k] += (slack > 0 ? half[n] : h) * r->step[k];
        }
    }
    for (int k = 0; k < 3; k++)
        box.center[k] = (float)center[k];
    return box;
}

static double box_area(const occ_box *box)
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)box->axis[0][k];
        v[k] = (double)box->axis[1][k];
    }
    return 4 * area_of(u, v);
}

// The first candidate at a corner that fits exactly, if it beats `least`.
static double fit_at_corner(const quad *q, int corner, double least, occ_box *out)
{
    static const struct {
        double ulps;
        int spare;
    } attempt[] = {{0, 0}, {0, 1}, {1, 1}, {2, 1}, {4, 1}, {0, 4}, {0, 8}, {0, 12}, {0, 16}};
    const float *x = q->corner[corner];
    ray along[2] = {make_ray(x, q->corner[(corner + 1) % 4]),
                    make_ray(x, q->corner[(corner + 3) % 4])};
    double a, b, share[2];
    far_corner(q, corner, &a, &b);
    largest_shares(a, b, &share[0], &share[1]);
    const double half[2] = {along[0].steps * share[0] / 2, along[1].steps * share[1] / 2};
    for (size_t i = 0; i < sizeof attempt / sizeof *attempt; i++) {
        occ_box box =
            candidate(x, along, half, attempt[i].ulps * magnitude(q) * 0x1p-24, attempt[i].spare);
        double area = box_area(&box);
        if (area <= least) continue;
        if (!box_in_quad(q, &box)) continue;
        *out = box;
        return area;
    }
    return 0;
}

bool quad_is_flat_and_convex(const float *const corner[4])
{
    quad q = make_quad(corner);
    if (q.sense == 0 || !in_plane(&q, &q.point[3])) return false;
    return side(&q, &q.point[0], &q.point[2], &q.point[3]) == q.sense &&
           side(&q, &q.point[3], &q.point[0], &q.point[1]) != -q.sense &&
           side(&q, &q.point[1], &q.point[2], &q.point[3]) != -q.sense;
}

double quad_fit_parallelogram(const float *const corner[4], occ_box *box)
{
    quad q = make_quad(corner);
    double best = 0;
    for (int k = 0; k < 4; k++) {
        double area = fit_at_corner(&q, k, best * (1 + 1e-9), box);
        if (area > best) best = area;
    }
    return best;
}
