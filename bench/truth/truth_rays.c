// SPDX-License-Identifier: Apache-2.0
#include "truth_rays.h"

#include "truth_buffer.h"

#include <math.h>

enum { STRATA = 4 }; // squared: rays spread over a triangle

typedef struct shooter {
    const truth_view *view;
    const truth_tree *occluders;
    uint32_t object, hint, arrived;
    uint64_t state;
} shooter;

// A number from 0 to 1 (D. H. Lehmer's generator, constants of Knuth's MMIX).
static double next_random(shooter *s)
{
    s->state = s->state * 6364136223846793005u + 1442695040888963407u;
    return (double)(s->state >> 11) * 0x1p-53;
}

// The whole ray of a point: parameter 0 is where it starts, 1 is at the point.
static truth_query query_of(const shooter *s, const double point[3])
{
    const truth_view *view = s->view;
    double depth = truth_value(view->depth, point);
    bool is_perspective = view->row[2][3] == 0.0;
    truth_query query = {.owner = s->object, .high = 1.0 - TRUTH_SURFACE};
    for (int k = 0; k < 3; k++) {
        double along = view->direction[0][k] * depth; // of an orthographic camera
        query.direction[k] = is_perspective ? point[k] : along;
        query.origin[k] = is_perspective ? 0.0 : point[k] - along;
    }
    double rise = truth_dot(view->plane[TRUTH_NEAR], query.direction);
    double start = truth_value(view->plane[TRUTH_NEAR], query.origin);
    if (view->has_plane[TRUTH_NEAR] && start < 0.0) query.low = rise > 0.0 ? -start / rise : 1.0;
    return query;
}

static void shoot(shooter *s, const double point[3])
{
    truth_query query = query_of(s, point);
    if (s->hint != TRUTH_NONE) {
        const truth_solid *last = &s->occluders->solids[s->hint];
        if (last->owner != s->object &&
            truth_enter(last, query.origin, query.direction, query.low, query.high) < INFINITY)
            return;
    }
    uint32_t found = truth_tree_find(s->occluders, &query);
    if (found == TRUTH_NONE)
        s->arrived++;
    else
        s->hint = found;
}

static void shoot_triangle(shooter *s, const double *a, const double *b, const double *c)
{
    for (int i = 0; i < STRATA * STRATA; i++) {
        int column = i % STRATA, row = i / STRATA;
        double u = (column + next_random(s)) / STRATA, v = (row + next_random(s)) / STRATA;
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        double point[3];
        for (int k = 0; k < 3; k++)
            point[k] = a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]);
        shoot(s, point);
    }
}

static void shoot_polygon(shooter *s, const truth_polygon *polygon)
{
    for (int i = 0; i < polygon->count; i++) {
        const double *a = polygon->corner[i], *b = polygon->corner[(i + 1) % polygon->count];
        double middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = 0.5 * (a[k] + b[k]);
        shoot(s, a);
        shoot(s, middle);
    }
    for (int i = 2; i < polygon->count; i++)
        shoot_triangle(s, polygon->corner[0], polygon->corner[i - 1], polygon->corner[i]);
}

uint16_t truth_count_rays(const truth_view *view, const truth_tree *occluders, const occ_box *box,
                          uint32_t object, uint32_t *hint)
{
    shooter s = {.view = view, .occluders = occluders, .object = object, .hint = *hint};
    s.state = object;
    for (int face = 0; face < 6; face++) {
        if (!truth_face_is_seen(view, box, face)) continue;
        truth_polygon polygon;
        truth_face(view, box, face, &polygon);
        shoot_polygon(&s, &polygon);
    }
    *hint = s.hint;
    return (uint16_t)(s.arrived < UINT16_MAX ? s.arrived : UINT16_MAX);
}
