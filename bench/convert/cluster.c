// SPDX-License-Identifier: Apache-2.0
// Top down: a group is cut where the surface areas of the two halves' boxes, weighted with what
// they hold, add up to least (the surface area heuristic: MacDonald and Booth 1990). A box's area
// is how likely it is to be seen, so the sum is the cost of drawing what is seen.
#include "cluster.h"

#include "progress.h"

#include <math.h>
#include <stdlib.h>

// What is never cut: a triangle, or the two of a sheet.
typedef struct unit {
    float min[3], max[3];
    float key; // its middle along the axis being sorted by
    uint32_t triangles[2];
    uint32_t weight; // 1 or 2
} unit;

typedef struct bounds {
    float min[3], max[3];
} bounds;

typedef struct splitter {
    const model *m;
    unit *units;
    double *right_cost; // of everything from a unit on
    uint32_t unit_count;
    double overhead; // What an object costs beside its triangles, in triangles.
    uint32_t most;
    cluster_list *out;
} splitter;

// A cut before the unit `at` of the group sorted along `axis`.
typedef struct cut {
    double cost;
    uint32_t at;
    int axis;
} cut;

typedef struct range {
    uint32_t first, end;
} range;

// What drawing an object costs beside its triangles, as a share of the triangles allowed in one.
#ifndef OVERHEAD
#define OVERHEAD 0.25
#endif

static const bounds NOTHING = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void grow(bounds *b, const unit *u)
{
    for (int k = 0; k < 3; k++) {
        b->min[k] = fminf(b->min[k], u->min[k]);
        b->max[k] = fmaxf(b->max[k], u->max[k]);
    }
}

static double half_area(const bounds *b)
{
    double x = (double)b->max[0] - (double)b->min[0], y = (double)b->max[1] - (double)b->min[1],
           z = (double)b->max[2] - (double)b->min[2];
    return x * y + y * z + z * x;
}

static int compare_keys(const void *left, const void *right)
{
    const unit *a = left, *b = right;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return (a->triangles[0] > b->triangles[0]) - (a->triangles[0] < b->triangles[0]);
}

static void sort_along(unit *units, uint32_t count, int axis)
{
    for (uint32_t i = 0; i < count; i++)
        units[i].key = 0.5f * units[i].min[axis] + 0.5f * units[i].max[axis];
    qsort(units, count, sizeof *units, compare_keys);
}

static double group_cost(const splitter *s, const bounds *b, uint32_t weight)
{
    return half_area(b) * ((double)weight + s->overhead);
}

static void best_cut_along(const splitter *s, const unit *units, uint32_t count, int axis,
                           cut *best)
{
    bounds b = NOTHING;
    uint32_t weight = 0;
    for (uint32_t i = count; i-- > 1;) {
        grow(&b, &units[i]);
        weight += units[i].weight;
        s->right_cost[i] = group_cost(s, &b, weight);
    }
    b = NOTHING;
    weight = 0;
    // Large groups are not cut near their ends: that would cost a sort for a few triangles.
    uint32_t margin = count > 1024 ? count / 32 : 1;
    for (uint32_t i = 1; i <= count - margin; i++) {
        grow(&b, &units[i - 1]);
        weight += units[i - 1].weight;
        if (i < margin) continue;
        double cost = group_cost(s, &b, weight) + s->right_cost[i];
        if (cost < best->cost) *best = (cut){cost, i, axis};
    }
}

static void emit(splitter *s, range group)
{
    cluster_list *out = s->out;
    uint32_t place = out->first[out->count];
    for (uint32_t i = group.first; i < group.end; i++)
        for (uint32_t k = 0; k < s->units[i].weight; k++) {
            out->triangles[place++] = s->units[i].triangles[k];
            out->object_of[s->units[i].triangles[k]] = out->count;
        }
    out->first[++out->count] = place;
}

// Whether to cut, and where. Sorts the group along the axis chosen.
static bool find_cut(splitter *s, range group, uint32_t *at)
{
    unit *units = s->units + group.first;
    uint32_t count = group.end - group.first, weight = 0;
    bounds b = NOTHING;
    for (uint32_t i = 0; i < count; i++) {
        grow(&b, &units[i]);
        weight += units[i].weight;
    }
    if (count < 2) return false;
    cut best = {weight > s->most ? INFINITY : 0.5 * group_cost(s, &b, weight), 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        sort_along(units, count, axis);
        best_cut_along(s, units, count, axis, &best);
    }
    if (best.at == 0) {
        if (weight <= s->most) return false;
        best.at = count / 2; // Areas overflowed, or the like.
    }
    if (best.axis != 2) sort_along(units, count, best.axis);
    *at = group.first + best.at;
    return true;
}

static bool split(splitter *s)
{
    range *stack = malloc(((size_t)s->unit_count + 1) * sizeof *stack);
    if (!stack) return false;
    size_t depth = 0;
    stack[depth++] = (range){0, s->unit_count};
    while (depth) {
        range group = stack[--depth];
        uint32_t at;
        progress_step(group.first);
        if (group.first == group.end) continue;
        if (!find_cut(s, group, &at)) {
            emit(s, group);
            continue;
        }
        stack[depth++] = (range){at, group.end};
        stack[depth++] = (range){group.first, at};
    }
    free(stack);
    return true;
}

static void add_triangle(const model *m, unit *u, uint32_t triangle)
{
    if (u->weight == 0)
        for (int k = 0; k < 3; k++) {
            u->min[k] = INFINITY;
            u->max[k] = -INFINITY;
        }
    for (int c = 0; c < 3; c++) {
        const float *p = m->positions[m->corners[triangle][c]];
        for (int k = 0; k < 3; k++) {
            u->min[k] = fminf(u->min[k], p[k]);
            u->max[k] = fmaxf(u->max[k], p[k]);
        }
    }
    u->triangles[u->weight++] = triangle;
}

// Sheets first, then the triangles that are in none.
static void list_units(splitter *s, const sheet_list *sheets)
{
    uint32_t *object_of = s->out->object_of;
    for (uint32_t t = 0; t < s->m->triangle_count; t++)
        object_of[t] = UINT32_MAX;
    for (uint32_t i = 0; i < sheets->count; i++) {
        unit *u = &s->units[s->unit_count++];
        *u = (unit){0};
        for (int k = 0; k < 2; k++) {
            add_triangle(s->m, u, sheets->at[i].triangles[k]);
            object_of[sheets->at[i].triangles[k]] = 0;
        }
    }
    for (uint32_t t = 0; t < s->m->triangle_count; t++) {
        if (object_of[t] != UINT32_MAX) continue;
        unit *u = &s->units[s->unit_count++];
        *u = (unit){0};
        add_triangle(s->m, u, t);
    }
}

static bool allocate(splitter *s)
{
    size_t count = (size_t)s->m->triangle_count + 1;
    s->units = malloc(count * sizeof *s->units);
    s->right_cost = malloc(count * sizeof *s->right_cost);
    s->out->first = malloc(count * sizeof *s->out->first);
    s->out->triangles = malloc(count * sizeof *s->out->triangles);
    s->out->object_of = malloc(count * sizeof *s->out->object_of);
    return s->units && s->right_cost && s->out->first && s->out->triangles && s->out->object_of;
}

bool clusters_build(const model *m, const sheet_list *sheets, uint32_t most, cluster_list *out)
{
    *out = (cluster_list){0};
    splitter s = {.m = m, .most = most, .overhead = most * OVERHEAD, .out = out};
    bool done = allocate(&s);
    if (done) {
        out->first[0] = 0;
        list_units(&s, sheets);
        progress_begin("splitting into objects, by triangle", s.unit_count);
        done = split(&s);
        progress_end();
    }
    free(s.units);
    free(s.right_cost);
    if (!done) clusters_free(out);
    return done;
}

void clusters_free(cluster_list *list)
{
    free(list->first);
    free(list->triangles);
    free(list->object_of);
    *list = (cluster_list){0};
}
