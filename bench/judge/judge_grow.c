// SPDX-License-Identifier: Apache-2.0
// Shadows that are wider than their occluders: what a tolerance may hide, and no more. A silhouette
// plane n.x = 0 through the eye becomes n.x + |n| by m.x = 0, where m is the direction of its
// edge's middle; the numbers are rounded to a grid on which doubles and integers agree, and are
// exact from then on. Planes of faces stay.
#include "judge_data.h"

#include <math.h>

#define GRID 60 // binary places; the largest number is in [1/2, 1)

// The middle of the edge that side `one` of a solid has in common with side `two`, or of a flat
// body's edge along strip `two`.
static void edge_middle(const judge_body *body, int one, int two, double middle[3])
{
    for (int i = 0; body->triangle && i < 3; i++) {
        double first = two == 3 ? 0.0 : 0.5, second = two == 2 ? 0.0 : 0.5;
        middle[i] = body->center[i].v + first * body->axis[0][i].v + second * body->axis[1][i].v;
    }
    if (body->triangle) return;
    int skip = body->shape.rank == 3 ? 3 ^ (one / 2) ^ (two / 2) : -1; // the axis along the edge
    for (int i = 0; i < 3; i++)
        middle[i] = body->center[i].v;
    for (int k = 0; k < 3; k++) {
        const num *side = body->side[body->shape.rank == 3 && k == one / 2 ? one : two];
        double along = 0.0, size = 0.0;
        for (int i = 0; i < 3; i++) {
            along += side[i].v * body->axis[k][i].v;
            size += fabs(side[i].v * body->axis[k][i].v);
        }
        if (k == skip || (body->shape.rank == 2 && fabs(along) <= 1e-9 * size)) continue;
        for (int i = 0; i < 3; i++)
            middle[i] -= along > 0.0 ? body->axis[k][i].v : -body->axis[k][i].v;
    }
}

static void turn_plane(num *plane, const double middle[3], double by)
{
    double n[3], most = 0.0;
    double length =
        sqrt(plane[0].v * plane[0].v + plane[1].v * plane[1].v + plane[2].v * plane[2].v);
    double far = sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]);
    for (int i = 0; i < 3; i++) {
        n[i] = plane[i].v / length + by * middle[i] / far;
        most = fmax(most, fabs(n[i]));
    }
    int exponent;
    (void)frexp(most, &exponent);
    for (int i = 0; i < 3; i++)
        plane[i] = num_of(ldexp(rint(ldexp(n[i], GRID - exponent)), -GRID));
    plane[3] = num_of(0.0);
}

// Of a sheet only its plane and its edges bound the shadow; what else elimination yields touches it
// from outside.
static bool is_needed(const judge_shadow *shadow, int p)
{
    int one = shadow->one[p], two = shadow->two[p];
    if (shadow->body.shape.rank == 3) return true;
    return two < 0 ? one < 2 : (one < 2) != (two < 2);
}

static bool grow(judge_shadow *shadow, double by)
{
    const judge_body *body = &shadow->body;
    for (int i = 0; i < body->sides; i++) {
        const num *side = body->side[i];
        double size = fabs(side[3].v);
        for (int k = 0; k < 3; k++)
            size += fabs(side[k].v * body->center[k].v);
        bool is_edge = body->triangle && i >= 2; // of these the sign alone counts
        if (is_edge ? body->sign[i] == 0 : fabs(side[3].v) <= 1e-9 * size) return false;
    }
    int kept = 0;
    for (int p = 0; p < shadow->count; p++) {
        if (!is_needed(shadow, p)) continue;
        int one = shadow->one[p], two = shadow->two[p];
        shadow->one[kept] = one;
        shadow->two[kept] = two;
        for (int i = 0; i < 4; i++)
            shadow->plane[kept][i] = shadow->plane[p][i];
        if (two >= 0) {
            double middle[3];
            edge_middle(body, body->shape.rank == 2 && one > two ? two : one,
                        body->shape.rank == 2 && one > two ? one : two, middle);
            turn_plane(shadow->plane[kept], middle, by);
        }
        kept++;
    }
    shadow->count = kept;
    shadow->grown = true;
    return true;
}

bool judge_grow(judge *j, double by)
{
    bool good = !j->at_infinity;
    for (size_t i = 0; i < j->shadow_count && good; i++) {
        judge_shadow *shadow = &j->shadows[i];
        if (shadow->empty || shadow->body.shape.rank < 2) continue;
        good = shadow->halves == shadow->body.sides && grow(shadow, by);
    }
    return good;
}

void judge_grown_plane(const judge_shadow *shadow, int p, mpz_t *out)
{
    for (int i = 0; i < 4; i++)
        exact_set(out[i], shadow->plane[p][i].v, GRID);
}
