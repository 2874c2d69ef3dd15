// SPDX-License-Identifier: Apache-2.0
#include "sheet_judge.h"

static void point_init(judge_point *p)
{
    for (int k = 0; k < 3; k++)
        mpq_init(p->at[k]);
}

static void point_clear(judge_point *p)
{
    for (int k = 0; k < 3; k++)
        mpq_clear(p->at[k]);
}

static void each_point(sight_judge *j, void (*act)(judge_point *))
{
    act(&j->eye);
    act(&j->aim);
    act(&j->normal);
    for (int i = 0; i < OCC_SHEET_CORNERS; i++)
        act(&j->corner[i]);
    for (int i = 0; i < 3; i++) {
        act(&j->triangle[i]);
        act(&j->edge[i]);
    }
}

void sight_judge_init(sight_judge *j)
{
    each_point(j, point_init);
    mpq_inits(j->sum, j->part, j->side[0], j->side[1], NULL);
    mpq_inits(j->height[0], j->height[1], j->height[2], NULL);
}

void sight_judge_clear(sight_judge *j)
{
    each_point(j, point_clear);
    mpq_clears(j->sum, j->part, j->side[0], j->side[1], NULL);
    mpq_clears(j->height[0], j->height[1], j->height[2], NULL);
}

static void point_set(judge_point *p, const float at[3])
{
    for (int k = 0; k < 3; k++)
        mpq_set_d(p->at[k], (double)at[k]);
}

static void subtract(judge_point *out, const judge_point *a, const judge_point *b)
{
    for (int k = 0; k < 3; k++)
        mpq_sub(out->at[k], a->at[k], b->at[k]);
}

static void dot(sight_judge *j, const judge_point *a, const judge_point *b, mpq_t out)
{
    mpq_set_ui(out, 0, 1);
    for (int k = 0; k < 3; k++) {
        mpq_mul(j->part, a->at[k], b->at[k]);
        mpq_add(out, out, j->part);
    }
}

static void cross(sight_judge *j, const judge_point *a, const judge_point *b, judge_point *out)
{
    for (int k = 0; k < 3; k++) {
        mpq_mul(out->at[k], a->at[(k + 1) % 3], b->at[(k + 2) % 3]);
        mpq_mul(j->part, a->at[(k + 2) % 3], b->at[(k + 1) % 3]);
        mpq_sub(out->at[k], out->at[k], j->part);
    }
}

// The sign of (b - a) x (c - a) . (d - a).
static int side_of(sight_judge *j, const judge_point *a, const judge_point *b, const judge_point *c,
                   const judge_point *d)
{
    subtract(&j->edge[0], b, a);
    subtract(&j->edge[1], c, a);
    cross(j, &j->edge[0], &j->edge[1], &j->edge[2]);
    subtract(&j->edge[0], d, a);
    dot(j, &j->edge[2], &j->edge[0], j->sum);
    return mpq_sgn(j->sum);
}

// --- a line of sight -----------------------------------------------------------------------------

// A point within a triangle of the sheet's fan, often next to its edge or a corner.
static void choose_target(sight_judge *j, uint32_t corners, kit_random *random, judge_point *out)
{
    uint32_t third = 2 + kit_below(random, corners - 2);
    const judge_point *of[3] = {&j->corner[0], &j->corner[third - 1], &j->corner[third]};
    unsigned long weight[3], all = 0;
    for (int i = 0; i < 3; i++) {
        static const unsigned long most[4] = {1, 10, 1000, 1000000000};
        weight[i] = 1 + kit_below(random, (uint32_t)most[kit_below(random, 4)]);
        all += weight[i];
    }
    for (int k = 0; k < 3; k++) {
        mpq_set_ui(out->at[k], 0, 1);
        for (int i = 0; i < 3; i++) {
            mpq_set_ui(j->part, weight[i], all);
            mpq_canonicalize(j->part);
            mpq_mul(j->part, j->part, of[i]->at[k]);
            mpq_add(out->at[k], out->at[k], j->part);
        }
    }
}

// Across the sheet, about: the sum of its fan's normals.
static void choose_normal(sight_judge *j, uint32_t corners)
{
    judge_point *n = &j->normal;
    for (int k = 0; k < 3; k++)
        mpq_set_ui(n->at[k], 0, 1);
    for (uint32_t i = 2; i < corners; i++) {
        subtract(&j->edge[0], &j->corner[i - 1], &j->corner[0]);
        subtract(&j->edge[1], &j->corner[i], &j->corner[0]);
        cross(j, &j->edge[0], &j->edge[1], &j->edge[2]);
        for (int k = 0; k < 3; k++)
            mpq_add(n->at[k], n->at[k], j->edge[2].at[k]);
    }
}

// Whether the eye is before all corners and what it aims at beyond, or the reverse: 1 or -1; or 0.
static int order_across(sight_judge *j, uint32_t corners)
{
    bool before = true, behind = true;
    dot(j, &j->normal, &j->eye, j->height[0]);
    dot(j, &j->normal, &j->aim, j->height[1]);
    for (uint32_t i = 0; i < corners; i++) {
        dot(j, &j->normal, &j->corner[i], j->height[2]);
        int eye = mpq_cmp(j->height[0], j->height[2]), aim = mpq_cmp(j->height[1], j->height[2]);
        before = before && eye > 0 && aim < 0;
        behind = behind && eye < 0 && aim > 0;
    }
    return before ? 1 : behind ? -1 : 0;
}

bool sight_draw(sight_judge *j, const occ_sheet *sheet, kit_random *random)
{
    judge_point *target = &j->triangle[0];
    uint32_t n = sheet->corner_count;
    double reach = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        point_set(&j->corner[i], sheet->corner[i]);
        for (int k = 0; k < 3; k++)
            reach = fmax(reach, fabs((double)sheet->corner[i][k] - (double)sheet->corner[0][k]));
    }
    choose_target(j, n, random, target);
    choose_normal(j, n);
    double away = ldexp(reach, -(int)kit_below(random, 12));
    for (int k = 0; k < 3; k++) { // the eye anywhere about, what it aims at on the way through
        mpq_set_d(j->part, away * (double)kit_between(random, -1, 1));
        mpq_add(j->eye.at[k], target->at[k], j->part);
    }
    mpq_set_ui(j->height[0], 1 + kit_below(random, 4), 2);
    mpq_canonicalize(j->height[0]);
    for (int k = 0; k < 3; k++) {
        mpq_sub(j->part, target->at[k], j->eye.at[k]);
        mpq_mul(j->part, j->part, j->height[0]);
        mpq_add(j->aim.at[k], target->at[k], j->part);
    }
    int order = order_across(j, n);
    if (!order || (order < 0 && sheet->sides == OCC_SIDES_FRONT)) return false;
    int turn = 0;
    for (uint32_t i = 0; i < n; i++) {
        int side = side_of(j, &j->eye, &j->corner[i], &j->corner[(i + 1) % n], &j->aim);
        if (!side || (turn && side != turn)) return false;
        turn = side;
    }
    return true;
}

// --- what blocks it ------------------------------------------------------------------------------

// A quick look with room for rounding.
static bool is_far(const sight_judge *j, const float *const corner[3])
{
    for (int k = 0; k < 3; k++) {
        double a = mpq_get_d(j->eye.at[k]), b = mpq_get_d(j->aim.at[k]);
        double low = fmin(a, b), high = fmax(a, b), slack = 1e-9 * (fabs(low) + fabs(high));
        bool below = true, above = true;
        for (int c = 0; c < 3; c++) {
            below = below && (double)corner[c][k] < low - slack;
            above = above && (double)corner[c][k] > high + slack;
        }
        if (below || above) return true;
    }
    return false;
}

static bool is_blocked_by(sight_judge *j, const float *const corner[3], bool one_sided)
{
    judge_point *p = j->triangle;
    for (int c = 0; c < 3; c++)
        point_set(&p[c], corner[c]);
    int eye = side_of(j, &p[0], &p[1], &p[2], &j->eye),
        aim = side_of(j, &p[0], &p[1], &p[2], &j->aim);
    if (eye == aim || (one_sided && eye <= 0)) return false;
    bool left = true, right = true;
    for (int c = 0; c < 3; c++) {
        int side = side_of(j, &j->eye, &p[c], &p[(c + 1) % 3], &j->aim);
        left = left && side >= 0;
        right = right && side <= 0;
    }
    return left != right; // both: no area as the eye sees it
}

bool sight_is_blocked(sight_judge *j, const shapes *soup, const bool *see_through, bool one_sided)
{
    for (uint32_t t = 0; t < soup->triangles; t++) {
        const float *corner[3];
        shapes_corner(soup, t, corner);
        if (see_through[t] || is_far(j, corner)) continue;
        if (is_blocked_by(j, corner, one_sided)) return true;
    }
    return false;
}
