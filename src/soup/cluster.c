// SPDX-License-Identifier: Apache-2.0
#include "soup/cluster.h"

#include "log.h"
#include "soup/triangles.h"

#include <occlude/clusters.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_TRIANGLES 32u

// A cluster costs as much as so many of the triangles allowed in one, beside its own.
#define OVERHEAD 0.25

// A box is taken to be larger by this share of the soup's extent.
#define RIM 0x1p-10

// Groups on the stack at any time: one for each cut that led to the group at hand. From 2^32 units
// down to 2^10 each cut leaves at most 31 parts of 32 (480 cuts), then at least one unit less.
#define MOST_CUTS 1536u

typedef struct range {
    uint32_t first, end;
} range;

typedef struct split_call {
    occ_hooks *hooks;
    const occ_soup *soup;
    const occ_clusters_desc *desc;
    uint32_t *listed; // the triangles, those of a group together
    occ_cluster_unit *units;
    uint32_t unit_count;
    occ_cluster_cutter cutter;
    uint32_t *order, *first, count; // the result
    uint32_t told;                  // how far the caller knows
} split_call;

// --- units ---------------------------------------------------------------------------------------

static uint32_t group_of(const split_call *s, uint32_t triangle)
{
    return s->desc->groups ? s->desc->groups[triangle] : OCC_NO_GROUP;
}

static uint32_t label_of(const split_call *s, uint32_t triangle)
{
    return s->desc->labels ? s->desc->labels[triangle] : 0;
}

// A triangle under a number to sort by.
typedef struct numbered {
    uint32_t number, triangle;
} numbered;

static int by_number(const void *left, const void *right)
{
    const numbered *a = left, *b = right;
    if (a->number != b->number) return a->number < b->number ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

// Lists the triangles by group; OCC_NO_GROUP is the largest number and comes last.
static bool list_triangles(split_call *s)
{
    size_t count = s->soup->triangle_count;
    numbered *all = s->desc->groups ? occ_alloc(s->hooks, count * sizeof *all) : NULL;
    if (s->desc->groups && !all) return false;
    for (uint32_t t = 0; t < count; t++) {
        if (all) all[t] = (numbered){s->desc->groups[t], t};
        s->listed[t] = t;
    }
    if (!all) return true;
    qsort(all, count, sizeof *all, by_number);
    for (uint32_t t = 0; t < count; t++)
        s->listed[t] = all[t].triangle;
    occ_free(s->hooks, all, count * sizeof *all);
    return true;
}

static void add_triangle(const split_call *s, occ_cluster_unit *u, uint32_t triangle)
{
    const float *corner[3];
    occ_soup_corners(s->soup, triangle, corner);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            float at = corner[c][k];
            u->min[k] = at < u->min[k] ? at : u->min[k];
            u->max[k] = at > u->max[k] ? at : u->max[k];
        }
    u->weight++;
}

static occ_result make_units(split_call *s)
{
    for (uint32_t i = 0; i < s->soup->triangle_count; i++) {
        uint32_t t = s->listed[i], group = group_of(s, t);
        occ_cluster_unit *u = &s->units[s->unit_count];
        bool joins = i > 0 && group != OCC_NO_GROUP && group == group_of(s, s->listed[i - 1]);
        if (joins) {
            u--;
        } else {
            *u = (occ_cluster_unit){.min = {INFINITY, INFINITY, INFINITY},
                                    .max = {-INFINITY, -INFINITY, -INFINITY},
                                    .first = i,
                                    .label = label_of(s, t)};
            s->unit_count++;
        }
        if (u->label != label_of(s, t)) {
            return occ_fail(s->hooks, OCC_ERROR_INVALID_ARGUMENT,
                            "group %u has triangles of labels %u and %u", (unsigned)group,
                            (unsigned)u->label, (unsigned)label_of(s, t));
        }
        add_triangle(s, u, t);
    }
    return OCC_SUCCESS;
}

static double rim_of(const split_call *s)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < s->unit_count; i++) {
            low = s->units[i].min[k] < low ? s->units[i].min[k] : low;
            high = s->units[i].max[k] > high ? s->units[i].max[k] : high;
        }
        sum += (double)high - (double)low;
    }
    return RIM * sum;
}

// --- clusters ------------------------------------------------------------------------------------

static int ascending(const void *left, const void *right)
{
    const uint32_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static void add_cluster(split_call *s, range group)
{
    uint32_t start = s->first[s->count], end = start;
    for (uint32_t i = group.first; i < group.end; i++) {
        const occ_cluster_unit *u = &s->units[s->cutter.keys[i].unit];
        memcpy(s->order + end, s->listed + u->first, u->weight * sizeof *s->order);
        end += u->weight;
    }
    qsort(s->order + start, end - start, sizeof *s->order, ascending);
    s->first[++s->count] = end;
}

// Tells the caller of every 8192 triangles that are done, and before any cut as large.
static occ_result tell(split_call *s, range group)
{
    const uint32_t step = 8192;
    uint32_t done = s->first[s->count];
    if (done - s->told < step && group.end - group.first < step) return OCC_SUCCESS;
    s->told = done;
    return occ_soup_progress(&s->desc->work, s->hooks,
                             (double)done / (double)s->soup->triangle_count);
}

// Splits what has one label.
static occ_result split(split_call *s, range whole)
{
    range stack[MOST_CUTS];
    uint32_t depth = 0;
    occ_result result = OCC_SUCCESS;
    for (stack[depth++] = whole; depth && !result;) {
        range group = stack[--depth];
        result = tell(s, group);
        if (result) return result;
        uint32_t at = occ_cluster_cut(&s->cutter, group.first, group.end);
        if (at == group.first) {
            add_cluster(s, group);
            continue;
        }
        stack[depth++] = (range){at, group.end};
        stack[depth++] = (range){group.first, at};
    }
    return result;
}

// Puts the keys of each label together, and splits one label after the other.
static occ_result split_labels(split_call *s, numbered *by_label)
{
    for (uint32_t i = 0; i < s->unit_count; i++)
        by_label[i] = (numbered){s->units[i].label, i};
    if (s->desc->labels) qsort(by_label, s->unit_count, sizeof *by_label, by_number);
    for (uint32_t i = 0; i < s->unit_count; i++)
        s->cutter.keys[i].unit = by_label[i].triangle;
    occ_result result = OCC_SUCCESS;
    for (uint32_t first = 0, end; first < s->unit_count && !result; first = end) {
        end = first + 1;
        while (end < s->unit_count && by_label[end].number == by_label[first].number)
            end++;
        result = split(s, (range){first, end});
    }
    return result;
}

static occ_result split_soup(split_call *s)
{
    size_t count = s->soup->triangle_count;
    s->listed = occ_alloc(s->hooks, count * sizeof *s->listed);
    s->units = occ_alloc(s->hooks, count * sizeof *s->units);
    s->cutter.keys = occ_alloc(s->hooks, count * sizeof *s->cutter.keys);
    s->cutter.cost_from = occ_alloc(s->hooks, count * sizeof *s->cutter.cost_from);
    numbered *by_label = occ_alloc(s->hooks, count * sizeof *by_label);
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    s->cutter.units = s->units;
    if (s->listed && s->units && s->cutter.keys && s->cutter.cost_from && by_label &&
        list_triangles(s)) {
        result = make_units(s);
        s->cutter.rim = rim_of(s);
        if (!result) result = split_labels(s, by_label);
    } else {
        (void)occ_fail(s->hooks, result, "no memory to split %zu triangles in", count);
    }
    occ_free(s->hooks, by_label, count * sizeof *by_label);
    occ_free(s->hooks, s->cutter.cost_from, count * sizeof *s->cutter.cost_from);
    occ_free(s->hooks, s->cutter.keys, count * sizeof *s->cutter.keys);
    occ_free(s->hooks, s->units, count * sizeof *s->units);
    occ_free(s->hooks, s->listed, count * sizeof *s->listed);
    return result;
}

occ_result occ_clusters_find(const occ_soup *soup, const occ_clusters_desc *desc, uint32_t *order,
                             uint32_t *first, uint32_t *count)
{
    static const occ_clusters_desc plain = {0};
    occ_hooks hooks;
    if (!desc) desc = &plain;
    if (count) *count = 0;
    occ_result result = occ_soup_hooks(&desc->work, &hooks);
    if (result) return result;
    if (!order || !first || !count)
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "order, first or count is NULL");
    result = occ_soup_validate(soup, &hooks);
    if (!result) result = occ_soup_progress(&desc->work, &hooks, 0.0);
    if (result) return result;
    uint32_t most = desc->max_triangles ? desc->max_triangles : DEFAULT_TRIANGLES;
    split_call call = {.hooks = &hooks,
                       .soup = soup,
                       .desc = desc,
                       .cutter = {.overhead = OVERHEAD * (double)most, .most = most},
                       .first = first};
    call.order = order;
    first[0] = 0;
    result = split_soup(&call);
    if (!result) result = occ_soup_progress(&desc->work, &hooks, 1.0);
    if (!result) *count = call.count;
    return result;
}

// --- bounds --------------------------------------------------------------------------------------

static occ_result check_clusters(const occ_soup *soup, const uint32_t *order, const uint32_t *first,
                                 uint32_t count, const occ_hooks *hooks)
{
    for (uint32_t i = 0; i < count; i++)
        if (first[i] >= first[i + 1]) {
            return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "cluster %u has no triangles",
                            (unsigned)i);
        }
    for (uint32_t i = first[0]; i < first[count]; i++)
        if (order[i] >= soup->triangle_count) {
            return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "order names triangle %u of %u",
                            (unsigned)order[i], (unsigned)soup->triangle_count);
        }
    return OCC_SUCCESS;
}

static occ_result bound_clusters(occ_hooks *hooks, const occ_soup *soup, const uint32_t *order,
                                 const uint32_t *first, uint32_t count, const occ_soup_work *work,
                                 uint32_t *index, occ_box *boxes)
{
    occ_soup_work quiet = {.allocator = hooks->allocator, .logger = hooks->logger};
    occ_soup part = *soup;
    part.indices = index;
    for (uint32_t i = 0; i < count; i++) {
        part.triangle_count = first[i + 1] - first[i];
        for (uint32_t t = 0; t < part.triangle_count; t++)
            for (int c = 0; c < 3; c++)
                index[3 * (size_t)t + (size_t)c] = occ_soup_index(soup, order[first[i] + t], c);
        occ_result result = occ_bounds_of_soup(&part, &quiet, &boxes[i]);
        if (!result && i % 256 == 255)
            result = occ_soup_progress(work, hooks, (double)i / (double)count);
        if (result) return result;
    }
    return OCC_SUCCESS;
}

occ_result occ_clusters_bounds(const occ_soup *soup, const uint32_t *order, const uint32_t *first,
                               uint32_t count, const occ_soup_work *work, occ_box *boxes)
{
    occ_hooks hooks;
    uint32_t most = 0;
    occ_result result = occ_soup_hooks(work, &hooks);
    if (result) return result;
    if (!order || !first || !count || !boxes)
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "there are no clusters or no boxes");
    result = occ_soup_validate(soup, &hooks);
    if (!result) result = check_clusters(soup, order, first, count, &hooks);
    if (result) return result;
    for (uint32_t i = 0; i < count; i++)
        most = first[i + 1] - first[i] > most ? first[i + 1] - first[i] : most;
    size_t bytes = 3 * (size_t)most * sizeof(uint32_t);
    uint32_t *index = occ_alloc(&hooks, bytes);
    if (!index)
        return occ_fail(&hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for a cluster's indices");
    result = bound_clusters(&hooks, soup, order, first, count, work, index, boxes);
    occ_free(&hooks, index, bytes);
    return result ? result : occ_soup_progress(work, &hooks, 1.0);
}
