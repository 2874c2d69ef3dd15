// SPDX-License-Identifier: Apache-2.0
// The test of objects, as many at once as there are lanes.
#ifndef OCC_LANES_OBJECTS_H
#define OCC_LANES_OBJECTS_H

#include "lanes_fusion.h"
#include "lanes_screen.h"

#include "box.h"

#define ALL_WIDE ((1u << OCC_WIDTH) - 1u)

typedef struct object_lanes {
    fwide t[3];
    fwide a[9];
    fwide e;
} object_lanes;

// Their error bounds.
static inline void set_bounds(object_lanes *o, const occ_eye *eye)
{
    fwide size = OCC_NORM1(o->t[0], o->t[1], o->t[2]);
    size += OCC_NORM1(o->a[0], o->a[1], o->a[2]);
    size += OCC_NORM1(o->a[3], o->a[4], o->a[5]);
    size += OCC_NORM1(o->a[6], o->a[7], o->a[8]);
    o->e = OCC_BOUND(size, eye->slack_floor);
}

static inline void load_objects(object_lanes *o, const occ_boxes *boxes, uint32_t row,
                                const occ_eye *eye)
{
    for (uint32_t j = 0; j < 3; j++) {
        fwide center = load_wide(occ_boxes_column(boxes, j) + row);
        o->t[j] = OCC_RELATIVE(center, eye->high[j], eye->low[j]);
    }
    for (uint32_t k = 0; k < 9; k++)
        o->a[k] = load_wide(occ_boxes_column(boxes, 3 + k) + row);
    set_bounds(o, eye);
}

static inline fwide reach_of_objects(const object_lanes *o, const float n[4])
{
    fwide r = OCC_REACH_OF_AXIS(n[0], n[1], n[2], o->a[0], o->a[1], o->a[2]);
    r += OCC_REACH_OF_AXIS(n[0], n[1], n[2], o->a[3], o->a[4], o->a[5]);
    r += OCC_REACH_OF_AXIS(n[0], n[1], n[2], o->a[6], o->a[7], o->a[8]);
    return r;
}

static inline fwide center_of_objects(const object_lanes *o, const float n[4])
{
    return OCC_PLANE_AT(n[0], n[1], n[2], n[3], o->t[0], o->t[1], o->t[2]);
}

static inline uint32_t outside_frustum(const object_lanes *o, const occ_eye *eye, uint32_t planes)
{
    uint32_t outside = 0;
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (!(planes >> p & 1u)) continue;
        fwide s = center_of_objects(o, eye->plane[p]), r = reach_of_objects(o, eye->plane[p]);
        outside |= above_wide(-o->e, s + r);
    }
    return outside;
}

// The objects whose center a shadow holds by more than the bound (as in hold_center()), among those
// that are open.
static inline uint32_t centers_inside(const object_lanes *o, const occ_shadow *shadow,
                                      uint32_t open)
{
    for (uint32_t p = 0; p < shadow->planes && open; p++)
        open &= above_wide(center_of_objects(o, shadow->plane[p]), o->e);
    return open;
}

static inline uint32_t inside_shadow(const object_lanes *o, const occ_shadow *shadow, uint32_t open)
{
    for (uint32_t p = 0; p < shadow->planes && open; p++) {
        fwide s = center_of_objects(o, shadow->plane[p]), r = reach_of_objects(o, shadow->plane[p]);
        open &= above_wide(s - r, o->e);
    }
    return open;
}

// As occ_center_in_frustum().
static inline uint32_t centers_in_frustum(const object_lanes *o, const occ_eye *eye, uint32_t mask)
{
    uint32_t in = ALL_WIDE;
    for (uint32_t p = 0; p < OCC_SIDE_PLANES; p++)
        if (mask >> p & 1u) in &= above_wide(center_of_objects(o, eye->plane[p]), splat_wide(0.0f));
    return in;
}

// Where a range's candidates are on the screen, in their order. Those beyond may be anywhere.
static void list_candidates(rect_list *list, const occ_candidates *candidates)
{
    list->count = candidates->count < LISTED_MOST ? candidates->count : LISTED_MOST;
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t s = candidates->list[i], lane = s % OCC_SHADOW_LANES;
        const occ_rect_block *block = &candidates->set->rects[s / OCC_SHADOW_LANES];
        list->left[i] = block->min[0][lane];
        list->right[i] = block->max[0][lane];
        list->low[i] = block->min[1][lane];
        list->high[i] = block->max[1][lane];
    }
}

// Whether candidate c holds corner k of the object in this row.
static inline bool candidate_holds(const occ_candidates *candidates, uint32_t c, uint32_t row,
                                   const occ_projection *seen, uint32_t k, float e)
{
    uint32_t s = candidates->list[c];
    return holds_point(&candidates->set->wide[s], seen->x[k], seen->y[k], seen->z[k], e) &&
           candidates->set->wide[s].owner != row;
}

static inline bool corner_is_held(const rect_list *list, const occ_candidates *candidates,
                                  uint32_t row, const occ_projection *seen, uint32_t k, float e)
{
    for (uint32_t i = 0; i < list->count; i += NEAR_BITS) {
        for (uint64_t near = near_in_list(list, i, seen->u[k], seen->v[k]); near;
             near &= near - 1u) {
            uint32_t c = i + (uint32_t)__builtin_ctzll(near);
            if (candidate_holds(candidates, c, row, seen, k, e)) return true;
        }
    }
    for (uint32_t c = list->count; c < candidates->count; c++)
        if (candidate_holds(candidates, c, row, seen, k, e)) return true;
    return false;
}

// What the objects of a range have in common.
typedef struct range_fusion {
    const occ_range *range;
    const occ_eye *eye;
    const occ_screen *screen;
    const occ_candidates *candidates;
    rect_list list;
    uint32_t hint; // the corner that showed last
} range_fusion;

// An object in question, and what is left of it.
typedef struct object_fusion {
    const range_fusion *common;
    const occ_relative_box *box;
    uint32_t row;
    bool by_faces;
    fusion_lanes left;
} object_fusion;

// Whether candidate c may be taken from a piece, as in occ_fusion_find().
static inline bool serves(object_fusion *object, uint32_t c, const occ_vertex *middle,
                          uint32_t cuts)
{
    const occ_candidates *candidates = object->common->candidates;
    const occ_wide_shadow *shadow = &candidates->set->wide[candidates->list[c]];
    if (shadow->owner == object->row || !holds(shadow, middle, cuts, object->box->e)) return false;
    if (object->by_faces || is_behind(object->box, shadow)) return true;
    object->left.faces = true;
    return false;
}

// As occ_fusion_find().
static inline uint32_t find(object_fusion *object)
{
    const range_fusion *common = object->common;
    const rect_list *list = &common->list;
    fusion_lanes *left = &object->left;
    const piece_lanes *top = &left->stack[left->depth - 1];
    occ_vertex middle = middle_of(top);
    float u, v;
    project_vertex(common->screen, &middle, &u, &v);
    for (uint32_t i = 0; i < list->count; i += NEAR_BITS) {
        for (uint64_t near = near_in_list(list, i, u, v); near; near &= near - 1u) {
            uint32_t c = i + (uint32_t)__builtin_ctzll(near);
            if (serves(object, c, &middle, top->cuts)) return c;
        }
    }
    uint32_t c = list->count;
    while (c < common->candidates->count && !serves(object, c, &middle, top->cuts))
        c++;
    return c;
}

// As occ_fusion_covers().
static bool covers(object_fusion *object, bool by_faces)
{
    const range_fusion *common = object->common;
    const occ_candidates *candidates = common->candidates;
    fusion_lanes *left = &object->left;
    object->by_faces = by_faces;
    left->faces = false;
    if (!see_outline(left, object->box, common->eye, by_faces)) return false;
    clip(left, common->eye, common->range->frustum, object->box->e);
    for (uint32_t split = 0; left->depth; split++) {
        uint32_t c = find(object);
        if (c == candidates->count || split == common->eye->splits ||
            !subtract(left, &candidates->set->wide[candidates->list[c]], object->box->e)) {
            return false;
        }
    }
    return true;
}

// As occ_box_fused(), where a candidate holds the center or the center is not in the picture, and
// none hides the object alone.
static bool fuse(range_fusion *common, const occ_relative_box *box, uint32_t row)
{
    occ_projection seen;
    object_fusion object;
    project_corners(common->screen, box, &seen);
    uint32_t shown = corners_in_frustum(&seen, common->eye, common->range->frustum);
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t k = (i + common->hint) & 7u;
        if (!(shown >> k & 1u)) continue;
        if (corner_is_held(&common->list, common->candidates, row, &seen, k, box->e)) continue;
        common->hint = k;
        return false;
    }
    object.common = common;
    object.box = box;
    object.row = row;
    return covers(&object, false) || (object.left.faces && covers(&object, true));
}

// Objects of `open` that several candidates hide together.
static uint32_t fuse_objects(range_fusion *common, const occ_boxes *boxes, uint32_t row,
                             uint32_t open)
{
    uint32_t hidden = 0;
    for (; open; open &= open - 1u) {
        uint32_t l = (uint32_t)__builtin_ctz(open);
        const occ_box box = occ_boxes_get(boxes, row + l);
        occ_relative_box relative = occ_box_relative(&box, common->eye);
        hidden |= (uint32_t)fuse(common, &relative, row + l) << l;
    }
    return hidden;
}

// Where the centers of objects are on the screen: NaN where one is not clearly in front of the eye.
typedef struct center_lanes {
    fwide at[2];
    occ_projection bounds; // infinite if any is NaN
} center_lanes;

static inline void centers_on_screen(center_lanes *centers, const object_lanes *o,
                                     const occ_screen *screen, uint32_t objects)
{
    const float(*row)[3] = screen->row;
    const fwide *t = o->t, least = screen->least * OCC_NORM1(t[0], t[1], t[2]);
    fwide w = OCC_PLANE_AT(row[2][0], row[2][1], row[2][2], screen->w, t[0], t[1], t[2]);
    const iwide is_clear = w > least;
    bool clear = (above_wide(w, least) & objects) == objects;
    for (uint32_t r = 0; r < 2; r++) {
        fwide at = (row[r][0] * t[0] + row[r][1] * t[1] + row[r][2] * t[2]) / w;
        centers->at[r] = (fwide)((iwide)at | ~is_clear); // all bits set is a NaN
        centers->bounds.min[r] = clear ? -largest_of_wide(-at, objects) : -INFINITY;
        centers->bounds.max[r] = clear ? largest_of_wide(at, objects) : INFINITY;
    }
}

// The objects whose center may be in the shadow of occluder i of those.
static inline uint32_t centers_near(const center_lanes *centers, const rect_lanes *rects,
                                    uint32_t i)
{
    const fwide least[4] = {splat_wide(rects->left[i]), centers->at[0], splat_wide(rects->low[i]),
                            centers->at[1]};
    const fwide most[4] = {centers->at[0], splat_wide(rects->right[i]), centers->at[1],
                           splat_wide(rects->high[i])};
    return none_above_wide(least, most);
}

// What is known of as many objects as there are lanes.
typedef struct known_lanes {
    uint32_t open; // in the frustum, and no candidate holds the object alone
    uint32_t held; // one holds its center
} known_lanes;

// Tests candidate c on those objects of `near` that are open.
static inline void test_candidate(known_lanes *known, const object_lanes *lanes, uint32_t row,
                                  const occ_candidates *candidates, uint32_t c, uint32_t near)
{
    const occ_shadow *shadow = &candidates->set->shadows[candidates->list[c]];
    uint32_t own = shadow->owner - row;
    if (own < OCC_WIDTH) near &= ~(1u << own);
    uint32_t centers = centers_inside(lanes, shadow, near & known->open);
    if (!centers) return;
    known->held |= centers;
    known->open &= ~inside_shadow(lanes, shadow, centers);
}

static inline void test_candidates(known_lanes *known, const object_lanes *lanes, uint32_t row,
                                   const range_fusion *common)
{
    const occ_candidates *candidates = common->candidates;
    center_lanes centers;
    centers_on_screen(&centers, lanes, common->screen, known->open);
    for (uint32_t i = 0; i < common->list.count && known->open; i += OCC_SHADOW_LANES) {
        rect_lanes rects = rects_of_list(&common->list, i);
        uint32_t near = near_box(&rects, &centers.bounds);
        for (near = present(near, common->list.count - i); near; near &= near - 1u) {
            uint32_t c = (uint32_t)__builtin_ctz(near);
            uint32_t at = centers_near(&centers, &rects, c) & known->open;
            if (at) test_candidate(known, lanes, row, candidates, i + c, at);
        }
    }
    for (uint32_t c = common->list.count; c < candidates->count && known->open; c++)
        test_candidate(known, lanes, row, candidates, c, ALL_WIDE);
}

static occ_verdict test(const occ_boxes *boxes, const occ_range *range, const occ_eye *eye,
                        const occ_screen *screen, const occ_candidates *candidates)
{
    occ_verdict verdict = {{0, 0}, {0, 0}};
    range_fusion common;
    common.range = range;
    common.eye = eye;
    common.screen = screen;
    common.candidates = candidates;
    common.hint = 0;
    list_candidates(&common.list, candidates);
    for (uint32_t i = 0; i < range->count; i += OCC_WIDTH) {
        object_lanes lanes;
        uint32_t row = range->first + i, left = range->count - i;
        load_objects(&lanes, boxes, row, eye);
        uint32_t all = left >= OCC_WIDTH ? ALL_WIDE : (1u << left) - 1u;
        uint32_t outside = outside_frustum(&lanes, eye, range->frustum) & all;
        known_lanes known = {.open = all & ~outside};
        if (known.open && candidates->count) {
            test_candidates(&known, &lanes, row, &common);
            uint32_t in = centers_in_frustum(&lanes, eye, range->frustum);
            if (range->fused) {
                known.open &= ~fuse_objects(&common, boxes, row, known.open & (known.held | ~in));
            }
        }
        verdict.visible[i / 32] |= known.open << i % 32;
        verdict.outside[i / 32] |= outside << i % 32;
    }
    return verdict;
}

#endif
