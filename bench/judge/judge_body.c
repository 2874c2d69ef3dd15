// SPDX-License-Identifier: Apache-2.0
// A box is where |m.(x - center)| <= w for a few slabs (m, w), w being the support sum |m.axis_k|:
// a solid's three pairs of faces; the plane of a flat one, and the strips along its edges; the line
// of a segment, and its ends; the three coordinates of a point. A triangle is what the slab of its
// plane and its three edges bound. Written once for nums and once for integers.
#include "judge_data.h"

int judge_ask(judge *j, num value)
{
    j->effort.signs++;
    int sign = j->filter ? num_sign(value) : NUM_UNSURE;
    j->effort.exact += sign == NUM_UNSURE;
    return sign;
}

void judge_load(judge *j, const judge_body *body)
{
    for (int i = 0; i < 3; i++) {
        exact_set(j->c[i], (double)body->box.center[i], j->places);
        for (int k = 0; k < 3; k++) {
            exact_set(j->a[k][i], (double)body->box.axis[k][i], j->places);
            if (body->triangle && k < 2) mpz_sub(j->a[k][i], j->a[k][i], j->c[i]);
            if (!j->at_infinity) mpz_mul(j->a[k][i], j->a[k][i], j->from_w);
        }
        if (!j->at_infinity) mpz_mul(j->c[i], j->c[i], j->from_w);
        mpz_sub(j->c[i], j->c[i], j->exact_reference[i]);
    }
}

// --- shapes --------------------------------------------------------------------------------------

static bool surely_solid(judge *j, const judge_body *body)
{
    num normal[3];
    num_cross(normal, body->axis[1], body->axis[2]);
    int sign = judge_ask(j, num_dot(normal, body->axis[0], 3));
    return sign == 1 || sign == -1;
}

static judge_shape find_shape(judge *j, const judge_body *body)
{
    judge_shape shape = {.rank = 3};
    if (!body->triangle && surely_solid(j, body)) return shape;
    shape.rank = 0;
    judge_load(j, body);
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

// The inside of an edge's plane, whose normal is m, through a point.
static void num_edge(judge_body *body, const num *m, const num *through)
{
    num *side = body->side[body->sides++];
    for (int i = 0; i < 3; i++)
        side[i] = m[i];
    side[3] = num_neg(num_dot(m, through, 3));
}

// Normals of edges are across the plane's own, and point to the corner that is not on the edge.
static void num_triangle_sides(judge_body *body)
{
    num n[3], m[3], opposite[3], corner[3];
    body->sides = 0;
    num_cross(n, body->axis[0], body->axis[1]);
    num_slab(body, n, 0u);
    num_cross(m, n, body->axis[0]);
    num_edge(body, m, body->center);
    num_cross(m, body->axis[1], n);
    num_edge(body, m, body->center);
    for (int i = 0; i < 3; i++) {
        opposite[i] = num_sub(body->axis[1][i], body->axis[0][i]);
        corner[i] = num_add(body->center[i], body->axis[0][i]);
    }
    num_cross(m, n, opposite);
    num_edge(body, m, corner);
    for (int i = 0; i < body->sides; i++)
        num_tame(body->side[i], 4);
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

// The inside of the edge's plane whose normal is in j->m, through j->c.
static void exact_edge(judge *j, int side)
{
    for (int i = 0; i < 3; i++)
        mpz_set(j->half[side][i], j->m[i]);
    exact_dot(j->t[1], j->m, j->c);
    mpz_neg(j->half[side][3], j->t[1]);
}

// Side 2 and on; the plane's normal stays in j->s.
static void exact_triangle_sides(judge *j)
{
    int side = 0;
    exact_cross(j->s, j->a[0], j->a[1]);
    for (int i = 0; i < 3; i++)
        mpz_set(j->m[i], j->s[i]);
    exact_slab(j, &side);
    exact_cross(j->m, j->s, j->a[0]);
    exact_edge(j, 2);
    exact_cross(j->m, j->a[1], j->s);
    exact_edge(j, 3);
    for (int i = 0; i < 3; i++)
        mpz_sub(j->v[i], j->a[1][i], j->a[0][i]);
    exact_cross(j->m, j->s, j->v);
    exact_edge(j, 4);
    exact_dot(j->t[1], j->m, j->a[0]); // this one is through corner 1
    mpz_sub(j->half[4][3], j->half[4][3], j->t[1]);
}

void judge_exact_sides(judge *j, const judge_body *body)
{
    int side = 0, pick = body->shape.pick;
    judge_load(j, body);
    if (body->triangle) {
        exact_triangle_sides(j);
    } else if (body->shape.rank == 3) {
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
    body->triangle = false;
    body->box = *box;
    for (int i = 0; i < 3; i++) {
        body->center[i] = num_sub(num_of((double)box->center[i]), j->reference[i]);
        for (int k = 0; k < 3; k++)
            body->axis[k][i] = num_of((double)box->axis[k][i]);
    }
    body->shape = find_shape(j, body);
    num_sides(body);
    body->paired = body->sides;
    sign_sides(j, body);
}

void judge_make_triangle(judge *j, judge_body *body, const float *a, const float *b, const float *c)
{
    body->triangle = true;
    body->box = (occ_box){{a[0], a[1], a[2]}, {{b[0], b[1], b[2]}, {c[0], c[1], c[2]}, {0, 0, 0}}};
    judge_admit(j, &body->box);
    for (int i = 0; i < 3; i++) {
        num corner = num_of((double)a[i]);
        body->center[i] = num_sub(corner, j->reference[i]);
        body->axis[0][i] = num_sub(num_of((double)b[i]), corner);
        body->axis[1][i] = num_sub(num_of((double)c[i]), corner);
        body->axis[2][i] = num_of(0.0);
    }
    body->shape = find_shape(j, body);
    num_triangle_sides(body);
    body->paired = 2;
    sign_sides(j, body);
}

bool judge_holds_eye(const judge *j, const judge_body *body)
{
    if (j->at_infinity) return false;
    for (int i = 0; i < body->sides; i++)
        if (body->sign[i] < 0) return false;
    return true;
}

// The greatest of three signs, or the least. NUM_UNSURE is one of them, above the others.
static int extreme_of(const int sign[3], int which)
{
    bool unsure = false;
    int extreme = -which;
    for (int c = 0; c < 3; c++) {
        if (sign[c] == which) return which;
        unsure = unsure || sign[c] == NUM_UNSURE;
        if (sign[c] == 0) extreme = 0;
    }
    return unsure ? NUM_UNSURE : extreme;
}

static int triangle_sign(judge *j, const judge_body *body, const num *plane, mpz_t *exact,
                         int which)
{
    int sign[3];
    num at_corner = num_add(num_dot(plane, body->center, 3), plane[3]);
    for (int c = 0; c < 3; c++) {
        num value = c ? num_add(at_corner, num_dot(plane, body->axis[c - 1], 3)) : at_corner;
        sign[c] = exact ? judge_ask(j, value) : num_sign(value);
    }
    int extreme = extreme_of(sign, which);
    if (extreme != NUM_UNSURE || !exact) return extreme;
    judge_load(j, body);
    exact_dot(j->t[0], exact, j->c);
    mpz_add(j->t[0], j->t[0], exact[3]);
    for (int c = 0; c < 3; c++) {
        mpz_set_ui(j->t[1], 0);
        if (c) exact_dot(j->t[1], exact, j->a[c - 1]);
        mpz_add(j->t[1], j->t[1], j->t[0]);
        sign[c] = mpz_sgn(j->t[1]);
    }
    return extreme_of(sign, which);
}

int judge_extreme_sign(judge *j, const judge_body *body, const num *plane, mpz_t *exact, int which)
{
    if (body->triangle) return triangle_sign(j, body, plane, exact, which);
    num value = num_add(num_dot(plane, body->center, 3), plane[3]);
    for (int k = 0; k < 3; k++) {
        num reach = num_abs(num_dot(plane, body->axis[k], 3));
        value = which > 0 ? num_add(value, reach) : num_sub(value, reach);
    }
    if (!exact) return num_sign(value);
    int sign = judge_ask(j, value);
    if (sign != NUM_UNSURE) return sign;
    judge_load(j, body);
    exact_dot(j->t[0], exact, j->c);
    mpz_add(j->t[0], j->t[0], exact[3]);
    for (int k = 0; k < 3; k++) {
        exact_dot(j->t[1], exact, j->a[k]);
        mpz_abs(j->t[1], j->t[1]);
        (which > 0 ? mpz_add : mpz_sub)(j->t[0], j->t[0], j->t[1]);
    }
    return mpz_sgn(j->t[0]);
}
