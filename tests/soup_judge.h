// SPDX-License-Identifier: Apache-2.0
// Judges of inner boxes in GMP's rationals, which share no code and no idea with the library: a
// triangle is clipped by the faces of a box, and lines are counted through closed surfaces.
#ifndef OCC_TEST_SOUP_JUDGE_H
#define OCC_TEST_SOUP_JUDGE_H

#include "kit.h"

#include <gmp.h>

// How a triangle and a box have points in common.
typedef enum judge_contact { JUDGE_APART, JUDGE_TOUCHING, JUDGE_ENTERING } judge_contact;

// The points with normal . p <= offset.
typedef struct judge_side {
    mpq_t normal[3], offset;
} judge_side;

enum { JUDGE_MOST_CORNERS = 12 };

typedef struct judge_polygon {
    mpq_t at[JUDGE_MOST_CORNERS][3];
    int count;
} judge_polygon;

static inline void judge_polygon_init(judge_polygon *p)
{
    for (int i = 0; i < JUDGE_MOST_CORNERS; i++)
        for (int k = 0; k < 3; k++)
            mpq_init(p->at[i][k]);
    p->count = 0;
}

static inline void judge_polygon_clear(judge_polygon *p)
{
    for (int i = 0; i < JUDGE_MOST_CORNERS; i++)
        for (int k = 0; k < 3; k++)
            mpq_clear(p->at[i][k]);
}

// offset - normal . p
static inline void judge_depth(const judge_side *side, const mpq_t p[3], mpq_t out)
{
    mpq_t part;
    mpq_init(part);
    mpq_set(out, side->offset);
    for (int k = 0; k < 3; k++) {
        mpq_mul(part, side->normal[k], p[k]);
        mpq_sub(out, out, part);
    }
    mpq_clear(part);
}

static inline void judge_add(judge_polygon *to, const mpq_t p[3])
{
    KIT_CHECK(to->count < JUDGE_MOST_CORNERS, "a polygon with too many corners");
    for (int k = 0; k < 3; k++)
        mpq_set(to->at[to->count][k], p[k]);
    to->count++;
}

// Where the line from a to b, at depths of different signs, meets the plane.
static inline void judge_cross(const mpq_t a[3], const mpq_t b[3], const mpq_t at_a,
                               const mpq_t at_b, mpq_t out[3])
{
    mpq_t share, part;
    mpq_inits(share, part, NULL);
    mpq_sub(share, at_a, at_b);
    mpq_div(share, at_a, share);
    for (int k = 0; k < 3; k++) {
        mpq_sub(part, b[k], a[k]);
        mpq_mul(part, part, share);
        mpq_add(out[k], a[k], part);
    }
    mpq_clears(share, part, NULL);
}

static inline void judge_clip(judge_polygon *p, judge_polygon *spare, const judge_side *side)
{
    mpq_t here, there, point[3];
    mpq_inits(here, there, point[0], point[1], point[2], NULL);
    spare->count = 0;
    for (int i = 0; i < p->count; i++) {
        int next = (i + 1) % p->count;
        judge_depth(side, (const mpq_t *)p->at[i], here);
        judge_depth(side, (const mpq_t *)p->at[next], there);
        if (mpq_sgn(here) >= 0) judge_add(spare, (const mpq_t *)p->at[i]);
        if (mpq_sgn(here) * mpq_sgn(there) >= 0) continue;
        judge_cross((const mpq_t *)p->at[i], (const mpq_t *)p->at[next], here, there, point);
        judge_add(spare, (const mpq_t *)point);
    }
    p->count = spare->count;
    for (int i = 0; i < p->count; i++)
        for (int k = 0; k < 3; k++)
            mpq_set(p->at[i][k], spare->at[i][k]);
    mpq_clears(here, there, point[0], point[1], point[2], NULL);
}

// Sides of an occ_box: |(axis_i x axis_j) . (p - center)| <= |det|. False if it has no volume.
static inline bool judge_box_sides(const occ_box *box, judge_side side[6])
{
    mpq_t a[3][3], c[3], part, det;
    mpq_inits(part, det, NULL);
    for (int k = 0; k < 3; k++) {
        mpq_init(c[k]);
        mpq_set_d(c[k], (double)box->center[k]);
        for (int j = 0; j < 3; j++) {
            mpq_init(a[k][j]);
            mpq_set_d(a[k][j], (double)box->axis[k][j]);
        }
    }
    bool volume = false;
    for (int f = 0; f < 6; f++) {
        int i = (f / 2 + 1) % 3, j = (f / 2 + 2) % 3;
        mpq_set_ui(det, 0, 1);
        for (int k = 0; k < 3; k++) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            mpq_mul(side[f].normal[k], a[i][u], a[j][v]);
            mpq_mul(part, a[i][v], a[j][u]);
            mpq_sub(side[f].normal[k], side[f].normal[k], part);
            if (f % 2) mpq_neg(side[f].normal[k], side[f].normal[k]);
            mpq_mul(part, side[f].normal[k], a[f / 2][k]);
            mpq_add(det, det, part);
        }
        volume = mpq_sgn(det) != 0;
        mpq_abs(side[f].offset, det);
        for (int k = 0; k < 3; k++) {
            mpq_mul(part, side[f].normal[k], c[k]);
            mpq_add(side[f].offset, side[f].offset, part);
        }
    }
    for (int k = 0; k < 3; k++) {
        mpq_clear(c[k]);
        for (int j = 0; j < 3; j++)
            mpq_clear(a[k][j]);
    }
    mpq_clears(part, det, NULL);
    return volume;
}

static inline void judge_sides_init(judge_side side[6])
{
    for (int f = 0; f < 6; f++)
        mpq_inits(side[f].normal[0], side[f].normal[1], side[f].normal[2], side[f].offset, NULL);
}

static inline void judge_sides_clear(judge_side side[6])
{
    for (int f = 0; f < 6; f++)
        mpq_clears(side[f].normal[0], side[f].normal[1], side[f].normal[2], side[f].offset, NULL);
}

// What of the triangle is within all six sides is a convex polygon. It has points in their common
// interior exactly if the mean of its corners is one.
static inline judge_contact judge_meets(const judge_side side[6], const float *const corner[3])
{
    judge_polygon p, spare;
    mpq_t mean[3], depth;
    judge_contact contact = JUDGE_APART;
    judge_polygon_init(&p);
    judge_polygon_init(&spare);
    mpq_inits(mean[0], mean[1], mean[2], depth, NULL);
    p.count = 3;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            mpq_set_d(p.at[i][k], (double)corner[i][k]);
    for (int f = 0; f < 6 && p.count; f++)
        judge_clip(&p, &spare, &side[f]);
    if (p.count) {
        contact = JUDGE_ENTERING;
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < p.count; i++)
                mpq_add(mean[k], mean[k], p.at[i][k]);
            mpq_set_si(depth, p.count, 1);
            mpq_div(mean[k], mean[k], depth);
        }
        for (int f = 0; f < 6; f++) {
            judge_depth(&side[f], (const mpq_t *)mean, depth);
            if (mpq_sgn(depth) <= 0) contact = JUDGE_TOUCHING;
        }
    }
    mpq_clears(mean[0], mean[1], mean[2], depth, NULL);
    judge_polygon_clear(&p);
    judge_polygon_clear(&spare);
    return contact;
}

// The sign of det(d, a - p, b - p).
static inline int judge_turn(const mpq_t d[3], const float p[3], const float a[3], const float b[3])
{
    mpq_t u[3], v[3], sum, part;
    mpq_inits(sum, part, NULL);
    for (int k = 0; k < 3; k++) {
        mpq_inits(u[k], v[k], NULL);
        mpq_set_d(part, (double)p[k]);
        mpq_set_d(u[k], (double)a[k]);
        mpq_sub(u[k], u[k], part);
        mpq_set_d(v[k], (double)b[k]);
        mpq_sub(v[k], v[k], part);
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpq_mul(part, u[i], v[j]);
        mpq_mul(part, part, d[k]);
        mpq_add(sum, sum, part);
        mpq_mul(part, u[j], v[i]);
        mpq_mul(part, part, d[k]);
        mpq_sub(sum, sum, part);
    }
    int sign = mpq_sgn(sum);
    mpq_clears(sum, part, NULL);
    for (int k = 0; k < 3; k++)
        mpq_clears(u[k], v[k], NULL);
    return sign;
}

// Whether a ray from a point crosses a triangle: 1 or 0, or -1 if that cannot be told with the ray
// if that cannot be told with this ray.
static inline int judge_ray(const float p[3], long turn, const float *const corner[3])
{
    mpq_t d[3], m[3];
    int sign[3], result = 0;
    mpq_inits(d[0], d[1], d[2], m[0], m[1], m[2], NULL);
    mpq_set_si(d[0], 971, 1009);
    mpq_set_si(d[1], 311 * turn - 700, 1013);
    mpq_set_si(d[2], 500 - 173 * turn, 1019);
    for (int i = 0; i < 3; i++)
        sign[i] = judge_turn((const mpq_t *)d, p, corner[i], corner[(i + 1) % 3]);
    bool plus = sign[0] > 0 || sign[1] > 0 || sign[2] > 0;
    bool minus = sign[0] < 0 || sign[1] < 0 || sign[2] < 0;
    if (!(plus && minus)) {
        result = -1;
        if (sign[0] && sign[1] && sign[2]) {
            // The triangle is ahead if its corners, seen from p, turn like its normal and d do: the
            // determinant of the corners has the sign of the turns.
            for (int k = 0; k < 3; k++) {
                mpq_t part;
                mpq_init(part);
                mpq_set_d(m[k], (double)corner[0][k]);
                mpq_set_d(part, (double)p[k]);
                mpq_sub(m[k], m[k], part);
                mpq_clear(part);
            }
            int side = judge_turn((const mpq_t *)m, p, corner[1], corner[2]);
            result = side == 0 ? -1 : side == sign[0];
        }
    }
    mpq_clears(d[0], d[1], d[2], m[0], m[1], m[2], NULL);
    return result;
}

#endif
