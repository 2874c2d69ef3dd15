// SPDX-License-Identifier: Apache-2.0
// What one occluder does, from an eye and from a box of eyes; and where an object is.
#include "judge_data.h"

// --- one occluder --------------------------------------------------------------------------------

static int sign_at_corner(judge *j, const judge_body *body, judge_shadow *shadow, int plane,
                          unsigned corner)
{
    num at[3];
    for (int i = 0; i < 3; i++) {
        at[i] = body->center[i];
        for (int k = 0; k < 3; k++)
            at[i] = corner >> k & 1u ? num_add(at[i], body->axis[k][i])
                                     : num_sub(at[i], body->axis[k][i]);
    }
    num *n = shadow->plane[plane];
    int sign = judge_ask(j, num_add(num_dot(n, at, 3), n[3]));
    if (sign != NUM_UNSURE) return sign;
    judge_exact_shadow(j, shadow);
    judge_load(j, body);
    for (int i = 0; i < 3; i++) {
        mpz_set(j->m[i], j->c[i]);
        for (int k = 0; k < 3; k++)
            (corner >> k & 1u ? mpz_add : mpz_sub)(j->m[i], j->m[i], j->a[k][i]);
    }
    exact_dot(j->t[0], shadow->exact[plane], j->m);
    mpz_add(j->t[0], j->t[0], shadow->exact[plane][3]);
    return mpz_sgn(j->t[0]);
}

// Whoever is strictly inside of all planes has a segment that passes through inner points. A
// segment or a point, which has none, has planes with both of their sides among these.
judge_sight judge_single(judge *j, const occ_box *object, const occ_box *occluder)
{
    judge_admit(j, occluder);
    judge_make_body(j, &j->body, object);
    judge_make_body(j, &j->single.body, occluder);
    judge_make_shadow(j, &j->single, false);
    if (j->single.empty) return JUDGE_SEEN;
    judge_sight least = JUDGE_HIDDEN;
    for (int p = 0; p < j->single.count; p++) {
        for (unsigned corner = 0; corner < 8; corner++) {
            int sign = sign_at_corner(j, &j->body, &j->single, p, corner);
            if (sign < 0) return JUDGE_SEEN;
            if (sign == 0) least = JUDGE_GRAZED;
        }
    }
    return least;
}

// --- a box of eyes -------------------------------------------------------------------------------

typedef struct pair_of_boxes {
    mpz_t axis[6][3], between[3], n[3], cross[3], t[2];
} pair_of_boxes;

// Whether the boxes' shadows on the line along n are apart.
static bool apart_along(pair_of_boxes *pair, mpz_t *n)
{
    exact_dot(pair->t[0], n, pair->between);
    mpz_abs(pair->t[0], pair->t[0]);
    for (int k = 0; k < 6; k++) {
        exact_dot(pair->t[1], n, pair->axis[k]);
        mpz_abs(pair->t[1], pair->t[1]);
        mpz_sub(pair->t[0], pair->t[0], pair->t[1]);
    }
    return mpz_sgn(pair->t[0]) > 0;
}

static bool apart_across(pair_of_boxes *pair, int i, int k)
{
    exact_cross(pair->cross, pair->axis[i], pair->axis[k]);
    if (apart_along(pair, pair->cross)) return true;
    for (int m = 0; m < 6; m++) {
        exact_cross(pair->n, pair->axis[m], pair->cross);
        if (apart_along(pair, pair->n)) return true;
    }
    return false;
}

static void unit_vector(mpz_t *out, int axis)
{
    for (int i = 0; i < 3; i++)
        mpz_set_ui(out[i], i == axis);
}

// Two boxes meet where the difference of their centers is in the sum of their six axes' segments,
// a zonotope. Its faces are across pairs of axes; if it is flat, its edges are across those normals
// and its axes; if it is a segment or a point, an axis or its normals tell.
static bool apart(pair_of_boxes *pair)
{
    for (int i = 0; i < 6; i++) {
        if (apart_along(pair, pair->axis[i])) return true;
        for (int k = 0; k < i; k++)
            if (apart_across(pair, i, k)) return true;
        for (int k = 0; k < 3; k++) {
            unit_vector(pair->cross, k);
            exact_cross(pair->n, pair->axis[i], pair->cross);
            if (apart_along(pair, pair->n)) return true;
        }
    }
    for (int k = 0; k < 3; k++) {
        unit_vector(pair->n, k);
        if (apart_along(pair, pair->n)) return true;
    }
    return false;
}

// `j` gives the unit.
static bool boxes_meet(judge *j, const occ_box *a, const occ_box *b)
{
    pair_of_boxes pair;
    mpz_t *vectors[] = {pair.between, pair.n, pair.cross};
    judge_admit(j, a);
    judge_admit(j, b);
    for (int i = 0; i < 3; i++)
        exact_init(vectors[i], 3);
    exact_init(pair.t, 2);
    for (int k = 0; k < 6; k++) {
        exact_init(pair.axis[k], 3);
        for (int i = 0; i < 3; i++)
            exact_set(pair.axis[k][i], (double)(k < 3 ? a : b)->axis[k % 3][i], j->places);
    }
    for (int i = 0; i < 3; i++) {
        exact_set(pair.between[i], (double)a->center[i], j->places);
        exact_set(pair.t[0], (double)b->center[i], j->places);
        mpz_sub(pair.between[i], pair.between[i], pair.t[0]);
    }
    bool meet = !apart(&pair);
    for (int i = 0; i < 3; i++)
        exact_clear(vectors[i], 3);
    exact_clear(pair.t, 2);
    for (int k = 0; k < 6; k++)
        exact_clear(pair.axis[k], 3);
    return meet;
}

// The points that an occluder hides from an eye are those from which it hides an eye, and both sets
// are convex: what holds for corners holds for all between them.
judge_sight judge_single_from(const occ_box *eyes, const occ_box *object, const occ_box *occluder,
                              bool filter)
{
    judge_sight least = JUDGE_HIDDEN;
    for (unsigned corner = 0; corner < 8 && least != JUDGE_SEEN; corner++) {
        judge *j = judge_of_corner(eyes, corner);
        judge_filter(j, filter);
        judge_sight sight = corner == 0 && boxes_meet(j, eyes, occluder)
                                ? JUDGE_SEEN
                                : judge_single(j, object, occluder);
        least = sight < least ? sight : least;
        judge_free(j);
    }
    return least;
}

// --- clip planes ---------------------------------------------------------------------------------

judge_place judge_frustum(judge *j, const occ_box *object)
{
    judge_make_body(j, &j->body, object);
    if (!j->has_clips) return JUDGE_INSIDE;
    bool inside = true;
    for (int p = 0; p < JUDGE_CLIPS; p++) {
        if (judge_extreme_sign(j, &j->body, j->clip[p], j->exact_clip[p], 1) < 0)
            return JUDGE_OUTSIDE;
        inside = inside && judge_extreme_sign(j, &j->body, j->clip[p], j->exact_clip[p], -1) >= 0;
    }
    if (inside) return JUDGE_INSIDE;
    return judge_has_inside(j) ? JUDGE_CROSSING : JUDGE_OUTSIDE;
}
