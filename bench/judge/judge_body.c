// SPDX-License-Identifier: Apache-2.0
// A box is where |m.(x - center)| <= w for a few slabs (m, w), w being the support sum |m.axis_k|:
// a solid's three pairs of faces; the plane of a flat one, and the strips along its edges; the line
// of a segment, and its ends; the three coordinates of a point. Written once for nums and once for
// integers.
#include "judge_data.h"

int judge_ask(judge *j, num value)
{
    j->effort.signs++;
    int sign = j->filter ? num_sign(value) : NUM_UNSURE;
    j->effort.exact += sign == NUM_UNSURE;
    return sign;
}

void judge_load(judge *j, const occ_box *box)
{
    for (int i = 0; i < 3; i++) {
        exact_set(j->c[i], (double)box->center[i], j->places);
        if (!j->at_infinity) mpz_mul(j->c[i], j->c[i], j->from_w);
        mpz_sub(j->c[i], j->c[i], j->exact_reference[i]);
        for (int k = 0; k < 3; k++) {
            exact_set(j->a[k][i], (double)box->axis[k][i], j->places);
            if (!j->at_infinity) mpz_mul(j->a[k][i], j->a[k][i], j->from_w);
        }
    }
}

// --- shapes --------------------------------------------------------------------------------------

static bool surely_solid(judge *j, const occ_box *box)
{
    num axis[3][3], normal[3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            axis[k][i] = num_of((double)box->axis[k][i]);
    num_cross(normal, axis[1], axis[2]);
    int sign = judge_ask(j, num_dot(normal, axis[0], 3));
    return sign == 1 || sign == -1;
}

judge_shape judge_find_shape(judge *j, const occ_box *box)
{
    judge_shape shape = {.rank = 3};
    if (surely_solid(j, box)) return shape;
    shape.rank = 0;
    judge_load(j, box);
    for (int k = 0; k < 3; k++) {
        if (shape.rank < 2 && !exact_is_zero(j->a[k])) shape = (judge_shape){.rank = 1, .pick = k};
        exact_cross(j->m, j->a[(k + 1) % 3], j->a[(k + 2) % 3]);
        if (exact_is_zero(j->m)) continue;
        exact_dot(j->t[0], j->m, j->a[k]);
        shape = (judge_shape){.rank = mpz_sgn(j->t[0]) ? 3 : 2, .pick = k};
        if (shape.rank == 3) return (judge_shape){.rank = 3};
    }
    return shape;
}

// --- as nums -------------------------------------------------------------------------------------

// `wide`: which axes count for the support; the others are known to add nothing.
static void num_slab(judge_body *body, const num *m, unsigned wide)
{
    num width = num_of(0.0), middle = num_dot(m, body->center, 3);
    for (int k = 0; k < 3; k++)
        if (wide >> k & 1u) width = num_add(width, num_abs(num_dot(m, body->axis[k], 3)));
    num *plus = body->side[body->sides++], *minus = body->side[body->sides++];
    for (int i = 0; i < 3; i++) {
        plus[i] = m[i];
        minus[i] = num_neg(m[i]);
    }
    plus[3] = num_sub(width, middle);
    minus[3] = num_add(width, middle);
}

static void num_line_sides(judge_body *body, int pick)
{
    for (int i = 0; i < 3; i++) {
        num unit[3] = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}, m[3];
        unit[i] = num_of(1.0);
        if (body->shape.rank > 0) num_cross(m, body->axis[pick], unit);
        num_slab(body, body->shape.rank > 0 ? m : unit, 0u);
    }
    if (body->shape.rank > 0) num_slab(body, body->axis[pick], 7u);
}

static void num_sides(judge_body *body)
{
    num m[3], strip[3];
    int pick = body->shape.pick;
    body->sides = 0;
    if (body->shape.rank == 3) {
        for (int k = 0; k < 3; k++) {
            num_cross(m, body->axis[(k + 1) % 3], body->axis[(k + 2) % 3]);
            num_slab(body, m, 1u << k);
        }
    } else if (body->shape.rank == 2) {
        num_cross(m, body->axis[(pick + 1) % 3], body->axis[(pick + 2) % 3]);
        num_slab(body, m, 0u);
        for (int k = 0; k < 3; k++) {
            num *axis = body->axis[k];
            if (num_is_zero(axis[0]) && num_is_zero(axis[1]) && num_is_zero(axis[2])) continue;
            num_cross(strip, axis, m);
            num_slab(body, strip, 7u & ~(1u << k));
        }
    } else {
        num_line_sides(body, pick);
    }
    for (int i = 0; i < body->sides; i++)
        num_tame(body->side[i], 4);
}

// --- as integers ---------------------------------------------------------------------------------

// The slab whose normal is in j->m; `side` counts on.
static void exact_slab(judge *j, int *side)
{
    mpz_set_ui(j->t[0], 0);
    for (int k = 0; k < 3; k++) {
        exact_dot(j->t[1], j->m, j->a[k]);
        mpz_abs(j->t[1], j->t[1]);
        mpz_add(j->t[0], j->t[0], j->t[1]);
    }
    exact_dot(j->t[1], j->m, j->c);
    mpz_t *plus = j->half[(*side)++], *minus = j->half[(*side)++];
    for (int i = 0; i < 3; i++) {
        mpz_set(plus[i], j->m[i]);
        mpz_neg(minus[i], j->m[i]);
    }
    mpz_sub(plus[3], j->t[0], j->t[1]);
    mpz_add(minus[3], j->t[0], j->t[1]);
}

static void exact_line_sides(judge *j, judge_shape shape, int *side)
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            mpz_set_ui(j->s[k], i == k);
        exact_cross(j->m, j->a[shape.pick], j->s);
        if (shape.rank == 0)
            for (int k = 0; k < 3; k++)
                mpz_set(j->m[k], j->s[k]);
        exact_slab(j, side);
    }
    if (shape.rank == 0) return;
    for (int k = 0; k < 3; k++)
        mpz_set(j->m[k], j->a[shape.pick][k]);
    exact_slab(j, side);
}

void judge_exact_sides(judge *j, const judge_body *body)
{
    int side = 0, pick = body->shape.pick;
    judge_load(j, &body->box);
    if (body->shape.rank == 3) {
        for (int k = 0; k < 3; k++) {
            exact_cross(j->m, j->a[(k + 1) % 3], j->a[(k + 2) % 3]);
            exact_slab(j, &side);
        }
    } else if (body->shape.rank == 2) {
        exact_cross(j->s, j->a[(pick + 1) % 3], j->a[(pick + 2) % 3]);
        for (int i = 0; i < 3; i++)
            mpz_set(j->m[i], j->s[i]);
        exact_slab(j, &side);
        for (int k = 0; k < 3; k++) {
            if (exact_is_zero(j->a[k])) continue;
            exact_cross(j->m, j->a[k], j->s);
            exact_slab(j, &side);
        }
    } else {
        exact_line_sides(j, body->shape, &side);
    }
}

// --- bodies --------------------------------------------------------------------------------------

static void sign_sides(judge *j, judge_body *body)
{
    bool loaded = false;
    for (int i = 0; i < body->sides; i++) {
        num *side = body->side[i];
        num value = j->at_infinity ? num_dot(side, j->toward, 3) : side[3];
        body->sign[i] = judge_ask(j, value);
        if (body->sign[i] != NUM_UNSURE) continue;
        if (!loaded) judge_exact_sides(j, body);
        loaded = true;
        if (j->at_infinity) exact_dot(j->t[0], j->half[i], j->from);
        body->sign[i] = mpz_sgn(j->at_infinity ? j->t[0] : j->half[i][3]);
    }
}

void judge_make_body(judge *j, judge_body *body, const occ_box *box)
{
    judge_admit(j, box);
    body->box = *box;
    body->shape = judge_find_shape(j, box);
    for (int i = 0; i < 3; i++) {
        body->center[i] = num_sub(num_of((double)box->center[i]), j->reference[i]);
        for (int k = 0; k < 3; k++)
            body->axis[k][i] = num_of((double)box->axis[k][i]);
    }
    num_sides(body);
    sign_sides(j, body);
}

bool judge_holds_eye(const judge *j, const judge_body *body)
{
    if (j->at_infinity) return false;
    for (int i = 0; i < body->sides; i++)
        if (body->sign[i] < 0) return false;
    return true;
}

int judge_extreme_sign(judge *j, const judge_body *body, const num *plane, mpz_t *exact, int which)
{
    num value = num_add(num_dot(plane, body->center, 3), plane[3]);
    for (int k = 0; k < 3; k++) {
        num reach = num_abs(num_dot(plane, body->axis[k], 3));
        value = which > 0 ? num_add(value, reach) : num_sub(value, reach);
    }
    if (!exact) return num_sign(value);
    int sign = judge_ask(j, value);
    if (sign != NUM_UNSURE) return sign;
    judge_load(j, &body->box);
    exact_dot(j->t[0], exact, j->c);
    mpz_add(j->t[0], j->t[0], exact[3]);
    for (int k = 0; k < 3; k++) {
        exact_dot(j->t[1], exact, j->a[k]);
        mpz_abs(j->t[1], j->t[1]);
        (which > 0 ? mpz_add : mpz_sub)(j->t[0], j->t[0], j->t[1]);
    }
    return mpz_sgn(j->t[0]);
}
