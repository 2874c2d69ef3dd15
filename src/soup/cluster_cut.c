// SPDX-License-Identifier: Apache-2.0
// A group is cut where the surface areas of the two halves' boxes, weighted with what they hold,
// add up to least (the surface area heuristic: MacDonald and Booth, The Visual Computer 6, 1990). A
// box's area is how likely it is to be seen, so the sum is the cost of drawing what is seen. That
// of flat boxes would be the same for strips as for squares; but what is nearly in sight counts as
// well, so boxes are taken to be a little larger than they are: then strips cost more. Small
// groups are sorted along each axis and every cut is tried; large ones are counted into slots
// first, and only cuts between slots are (Wald, Interactive Ray Tracing 2007).
#include "soup/cluster.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { SLOTS = 64, SLOT_GROUP = 4096 };

typedef struct extent {
    float min[3], max[3];
} extent;

// The best cut so far: `at` units, or slots, come before it.
typedef struct cut {
    double cost;
    uint32_t at;
    uint32_t least; // units in the smaller half
    int axis;
} cut;

typedef struct slot {
    extent bounds;
    uint32_t units, weight;
} slot;

static const extent NOTHING = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void hold(extent *e, const float min[3], const float max[3])
{
    for (int k = 0; k < 3; k++) {
        e->min[k] = min[k] < e->min[k] ? min[k] : e->min[k];
        e->max[k] = max[k] > e->max[k] ? max[k] : e->max[k];
    }
}

// From half of its surface, with the rim. Coordinates are at most OCC_MAX_COORDINATE, so nothing
// overflows.
static double cost_of(const occ_cluster_cutter *c, const extent *e, uint64_t weight)
{
    double side[3];
    for (int k = 0; k < 3; k++)
        side[k] = (double)e->max[k] - (double)e->min[k];
    double area = side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
    return (area + c->rim * (side[0] + side[1] + side[2])) * ((double)weight + c->overhead);
}

static float middle_of(const occ_cluster_unit *u, int axis)
{
    return 0.5f * u->min[axis] + 0.5f * u->max[axis];
}

static uint32_t margin_of(uint32_t count)
{
    return count > OCC_CLUSTER_MARGIN * OCC_CLUSTER_MARGIN ? count / OCC_CLUSTER_MARGIN : 1;
}

// Whether a cut is better than the best so far: of those that cost as much, but for rounding, the
// one with more even halves is. `least` is how many of `count` units the smaller half has.
static bool is_better(double cost, uint32_t least, const cut *best)
{
    if (!best->at || cost < best->cost * (1.0 - 0x1p-30)) return cost < best->cost;
    return cost <= best->cost * (1.0 + 0x1p-30) && least > best->least;
}

static uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

// --- every cut -----------------------------------------------------------------------------------

static int by_middle(const void *left, const void *right)
{
    const occ_cluster_key *a = left, *b = right;
    if (a->middle != b->middle) return a->middle < b->middle ? -1 : 1;
    return (a->unit > b->unit) - (a->unit < b->unit);
}

static void sort_along(const occ_cluster_cutter *c, occ_cluster_key *keys, uint32_t count, int axis)
{
    for (uint32_t i = 0; i < count; i++)
        keys[i].middle = middle_of(&c->units[keys[i].unit], axis);
    qsort(keys, count, sizeof *keys, by_middle);
}

static void try_sorted(const occ_cluster_cutter *c, const occ_cluster_key *keys, uint32_t count,
                       int axis, cut *best)
{
    extent e = NOTHING;
    uint64_t weight = 0;
    uint32_t margin = margin_of(count);
    for (uint32_t i = count; i-- > 1;) {
        const occ_cluster_unit *u = &c->units[keys[i].unit];
        hold(&e, u->min, u->max);
        weight += u->weight;
        c->cost_from[i] = cost_of(c, &e, weight);
    }
    e = NOTHING;
    weight = 0;
    for (uint32_t i = 1; i <= count - margin; i++) {
        const occ_cluster_unit *u = &c->units[keys[i - 1].unit];
        hold(&e, u->min, u->max);
        weight += u->weight;
        if (i < margin) continue;
        double cost = cost_of(c, &e, weight) + c->cost_from[i];
        uint32_t least = lesser(i, count - i);
        if (is_better(cost, least, best)) *best = (cut){cost, i, least, axis};
    }
}

// How many units come before the best cut of less cost than `limit`, or 0.
static uint32_t cut_sorted(const occ_cluster_cutter *c, occ_cluster_key *keys, uint32_t count,
                           double limit)
{
    cut best = {limit, 0, 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        sort_along(c, keys, count, axis);
        try_sorted(c, keys, count, axis, &best);
    }
    if (best.at && best.axis != 2) sort_along(c, keys, count, best.axis);
    return best.at;
}

// --- cuts between slots --------------------------------------------------------------------------

typedef struct slotting {
    double low, scale;
} slotting;

static uint32_t slot_of(const slotting *s, float middle)
{
    double at = ((double)middle - s->low) * s->scale;
    return at < SLOTS - 1 ? (uint32_t)at : SLOTS - 1;
}

// False if all middles are the same.
static bool slot_along(const extent *middles, int axis, slotting *s)
{
    double width = (double)middles->max[axis] - (double)middles->min[axis];
    *s = (slotting){(double)middles->min[axis], SLOTS / width};
    return width > 0 && isfinite(s->scale);
}

static void fill_slots(const occ_cluster_cutter *c, const occ_cluster_key *keys, uint32_t count,
                       int axis, const slotting *s, slot slots[SLOTS])
{
    for (uint32_t i = 0; i < SLOTS; i++)
        slots[i] = (slot){.bounds = NOTHING};
    for (uint32_t i = 0; i < count; i++) {
        const occ_cluster_unit *u = &c->units[keys[i].unit];
        slot *to = &slots[slot_of(s, middle_of(u, axis))];
        hold(&to->bounds, u->min, u->max);
        to->units++;
        to->weight += u->weight;
    }
}

static void try_slots(const occ_cluster_cutter *c, const slot slots[SLOTS], uint32_t count,
                      int axis, cut *best)
{
    double cost_from[SLOTS];
    extent e = NOTHING;
    uint64_t weight = 0;
    uint32_t units = 0, margin = margin_of(count);
    for (uint32_t i = SLOTS; i-- > 1;) {
        if (slots[i].units) hold(&e, slots[i].bounds.min, slots[i].bounds.max);
        weight += slots[i].weight;
        cost_from[i] = weight ? cost_of(c, &e, weight) : 0.0;
    }
    e = NOTHING;
    weight = 0;
    for (uint32_t i = 1; i < SLOTS; i++) {
        if (slots[i - 1].units) hold(&e, slots[i - 1].bounds.min, slots[i - 1].bounds.max);
        weight += slots[i - 1].weight;
        units += slots[i - 1].units;
        if (units < margin || count - units < margin) continue;
        double cost = cost_of(c, &e, weight) + cost_from[i];
        uint32_t least = lesser(units, count - units);
        if (is_better(cost, least, best)) *best = (cut){cost, i, least, axis};
    }
}

static uint32_t partition(const occ_cluster_cutter *c, occ_cluster_key *keys, uint32_t count,
                          const slotting *s, const cut *best)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        float middle = middle_of(&c->units[keys[i].unit], best->axis);
        if (slot_of(s, middle) >= best->at) continue;
        occ_cluster_key key = keys[i];
        keys[i] = keys[kept];
        keys[kept++] = key;
    }
    return kept;
}

// As cut_sorted(); 0 also if slots tell too little apart.
static uint32_t cut_slots(const occ_cluster_cutter *c, occ_cluster_key *keys, uint32_t count)
{
    extent middles = NOTHING;
    slotting s[3];
    slot slots[SLOTS];
    cut best = {INFINITY, 0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        float middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = middle_of(&c->units[keys[i].unit], k);
        hold(&middles, middle, middle);
    }
    for (int axis = 0; axis < 3; axis++) {
        if (!slot_along(&middles, axis, &s[axis])) continue;
        fill_slots(c, keys, count, axis, &s[axis], slots);
        try_slots(c, slots, count, axis, &best);
    }
    return best.at ? partition(c, keys, count, &s[best.axis], &best) : 0;
}

uint32_t occ_cluster_cut(const occ_cluster_cutter *cutter, uint32_t first, uint32_t end)
{
    occ_cluster_key *keys = cutter->keys + first;
    uint32_t count = end - first, at = 0;
    extent e = NOTHING;
    uint64_t weight = 0;
    if (count < 2) return first;
    for (uint32_t i = 0; i < count; i++) {
        const occ_cluster_unit *u = &cutter->units[keys[i].unit];
        hold(&e, u->min, u->max);
        weight += u->weight;
    }
    bool must = weight > cutter->most;
    if (must && count > SLOT_GROUP) at = cut_slots(cutter, keys, count);
    // A small group is cut only where that halves its cost, as when a lamp would share a box with
    // the floor.
    if (!at)
        at = cut_sorted(cutter, keys, count, must ? INFINITY : 0.5 * cost_of(cutter, &e, weight));
    return first + at;
}
