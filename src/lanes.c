// SPDX-License-Identifier: Apache-2.0
// Compiled several times, each time with OCC_LANES_NAME set to the name of an instruction set. The
// vectors are GCC's and clang's vector extension, which either compiler maps to what the target
// has.
#include "wide.h"

#include "lanes.h"

#include "box.h"

#ifndef OCC_LANES_NAME
#define OCC_LANES_NAME plain
#endif
#define OCC_PASTE2(a, b) a##b
#define OCC_PASTE(a, b)  OCC_PASTE2(a, b)
#define OCC_TEXT2(a)     #a
#define OCC_TEXT(a)      OCC_TEXT2(a)
#define OCC_LANES_TABLE  OCC_PASTE(occ_lanes_, OCC_LANES_NAME)

#define ALL_WIDE    ((1u << OCC_WIDTH) - 1u)
#define NODE_GROUPS (OCC_NODE_LANES / OCC_NODE_WIDTH)

#include "lanes_fusion.h"

// Point i is at t + s0 a0 + s1 a1 + s2 a2 with these signs.
static const float point_signs[3][OCC_SHADOW_LANES] = {{-1, 1, -1, 1, -1, 1, -1, 1, 0},
                                                       {-1, -1, 1, 1, -1, -1, 1, 1, 0},
                                                       {-1, -1, -1, -1, 1, 1, 1, 1, 0}};

static void project(const float screen[3][3], float w, const occ_relative_box *box,
                    occ_projection *seen)
{
    const float *t = box->t, *a = box->a;
    uint32_t in_front = 0, shown = 0;
    for (uint32_t g = 0; g < OCC_POINTS; g += OCC_WIDTH) {
        fwide s0 = load_wide(point_signs[0] + g), s1 = load_wide(point_signs[1] + g);
        fwide s2 = load_wide(point_signs[2] + g);
        fwide x = OCC_CORNER(t[0], s0 * a[0], s1 * a[3], s2 * a[6]);
        fwide y = OCC_CORNER(t[1], s0 * a[1], s1 * a[4], s2 * a[7]);
        fwide z = OCC_CORNER(t[2], s0 * a[2], s1 * a[5], s2 * a[8]);
        fwide depth = OCC_PLANE_AT(screen[2][0], screen[2][1], screen[2][2], w, x, y, z);
        fwide u = (screen[0][0] * x + screen[0][1] * y + screen[0][2] * z) / depth;
        fwide v = (screen[1][0] * x + screen[1][1] * y + screen[1][2] * z) / depth;
        iwide front = depth > 0.0f;
        store_wide(seen->x + g, x);
        store_wide(seen->y + g, y);
        store_wide(seen->z + g, z);
        store_wide(seen->u + g, u);
        store_wide(seen->v + g, v);
        in_front |= bits_wide(front) << g;
        shown |= bits_wide(front & (abs_wide(u) <= 1.0f) & (abs_wide(v) <= 1.0f)) << g;
    }
    const uint32_t all = (1u << OCC_POINTS) - 1u;
    bool whole = (in_front & all) == all;
    seen->shown = shown & all;
    seen->min[0] = whole ? least_of(seen->u, OCC_POINTS) : -INFINITY;
    seen->min[1] = whole ? least_of(seen->v, OCC_POINTS) : -INFINITY;
    seen->max[0] = whole ? most_of(seen->u, OCC_POINTS) : INFINITY;
    seen->max[1] = whole ? most_of(seen->v, OCC_POINTS) : INFINITY;
}

// Occluders of a block that may touch the box on the screen.
static inline uint32_t overlap_block(const occ_rect_block *block, uint32_t count,
                                     const occ_projection *seen, float key)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        iwide touching = (load_wide(block->min[0] + g) <= seen->max[0]) &
                         (load_wide(block->max[0] + g) >= seen->min[0]) &
                         (load_wide(block->min[1] + g) <= seen->max[1]) &
                         (load_wide(block->max[1] + g) >= seen->min[1]) &
                         (load_wide(block->key + g) <= key);
        bits |= bits_wide(touching) << g;
    }
    return count >= OCC_SHADOW_LANES ? bits : bits & ((1u << count) - 1u);
}

// The points of the box that are within an occluder's bounds on the screen.
static inline uint32_t points_near(const occ_projection *seen, const occ_rect_block *block,
                                   uint32_t lane)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_POINTS; g += OCC_WIDTH) {
        fwide u = load_wide(seen->u + g), v = load_wide(seen->v + g);
        bits |= bits_wide((u >= block->min[0][lane]) & (u <= block->max[0][lane]) &
                          (v >= block->min[1][lane]) & (v <= block->max[1][lane]))
                << g;
    }
    return bits & ((1u << OCC_POINTS) - 1u);
}

// Those of `points` that a shadow holds by more than the bound.
static inline uint32_t points_held(const occ_projection *seen, const occ_wide_shadow *shadow,
                                   float e, uint32_t points)
{
    for (uint32_t p = 0; p < OCC_FACE_LANE + 3 && points; p++) {
        uint32_t held = 0;
        for (uint32_t g = 0; g < OCC_POINTS; g += OCC_WIDTH) {
            fwide s = OCC_PLANE_AT(shadow->plane[0][p], shadow->plane[1][p], shadow->plane[2][p],
                                   shadow->plane[3][p], load_wide(seen->x + g),
                                   load_wide(seen->y + g), load_wide(seen->z + g));
            held |= bits_wide(s > e) << g;
        }
        points &= held;
    }
    return points;
}

// Asks one shadow. Whether it hides the box. A shadow whose face cuts the box may hide something of
// what is in it, but not the box together with others.
static inline bool ask(fusion_lanes *fusion, const occ_question *question,
                       const occ_shadow_set *set, uint32_t i)
{
    contact met = meet(question->box, &set->wide[i]);
    if (met.apart) return false;
    if (set->shadows[i].owner - question->first < question->rows) return false;
    if (!met.cutting) return true;
    if (!(met.cutting >> OCC_FACE_LANE)) add_candidate(fusion, &set->wide[i], &met);
    return false;
}

// Points first: what no occluder holds shows. (That a point is inside the box, or on its far side,
// does not matter: on the way from it to the eye no shadow begins.) And only an occluder that holds
// the center can hide the box alone.
static bool hide(const occ_question *question, const occ_shadow_set *set, const occ_eye *eye)
{
    const uint32_t center = 1u << (OCC_POINTS - 1u);
    const occ_projection *seen = question->seen;
    fusion_lanes fusion;
    uint32_t near[OCC_MOST_SHADOW_BLOCKS], shown = seen->shown;
    for (uint32_t i = 0, b = 0; i < set->count; i += OCC_SHADOW_LANES, b++) {
        uint32_t met = overlap_block(&set->rects[b], set->count - i, seen, question->key);
        if (b < OCC_MOST_SHADOW_BLOCKS) near[b] = met;
        for (; met; met &= met - 1u) {
            uint32_t lane = (uint32_t)__builtin_ctz(met);
            uint32_t points = points_near(seen, &set->rects[b], lane) & (shown | center);
            if (!points) continue;
            points = points_held(seen, &set->wide[i + lane], question->box->e, points);
            if (!points) continue;
            if (set->shadows[i + lane].owner - question->first < question->rows) continue;
            shown &= ~points;
            if (!(points & center)) continue;
            contact touch = meet(question->box, &set->wide[i + lane]);
            if (!touch.apart && !touch.cutting) return true;
        }
    }
    if (shown || !question->fuse) return false;
    start_fusion(&fusion);
    for (uint32_t i = 0, b = 0; i < set->count && b < OCC_MOST_SHADOW_BLOCKS;
         i += OCC_SHADOW_LANES, b++) {
        for (; near[b]; near[b] &= near[b] - 1u)
            if (ask(&fusion, question, set, i + (uint32_t)__builtin_ctz(near[b]))) return true;
    }
    return fusion.candidates && see_outline(&fusion, question->box, eye, false) &&
           covers(&fusion, eye, question->frustum, false);
}

static bool gather(const occ_question *question, const occ_shadow_set *set, uint32_t *list,
                   uint32_t *count)
{
    uint32_t listed = 0;
    for (uint32_t i = 0, b = 0; i < set->count; i += OCC_SHADOW_LANES, b++) {
        uint32_t met = overlap_block(&set->rects[b], set->count - i, question->seen, question->key);
        for (; met; met &= met - 1u) {
            uint32_t s = i + (uint32_t)__builtin_ctz(met);
            contact contact_of = meet(question->box, &set->wide[s]);
            if (contact_of.apart) continue;
            bool own = set->shadows[s].owner - question->first < question->rows;
            if (!contact_of.cutting && !own) return true;
            list[listed++] = s;
        }
    }
    *count = listed;
    return false;
}

typedef struct node_lanes {
    struct {
        fnode t[3]; // centers relative to the eye
        fnode h[3]; // half sizes
        fnode e;
    } group[NODE_GROUPS];
} node_lanes;

// Lanes beyond the last sibling repeat it.
static inline void load_nodes(node_lanes *lanes, const occ_siblings *siblings, const occ_eye *eye)
{
    float min[3][OCC_NODE_LANES], max[3][OCC_NODE_LANES];
    for (uint32_t l = 0; l < OCC_NODE_LANES; l++) {
        const occ_node *node = &siblings->nodes[l < siblings->count ? l : siblings->count - 1];
        for (uint32_t j = 0; j < 3; j++) {
            min[j][l] = node->min[j];
            max[j][l] = node->max[j];
        }
    }
    for (uint32_t g = 0; g < NODE_GROUPS; g++) {
        fnode *t = lanes->group[g].t, *h = lanes->group[g].h;
        for (uint32_t j = 0; j < 3; j++) {
            fnode low, high;
            memcpy(&low, min[j] + g * OCC_NODE_WIDTH, sizeof low);
            memcpy(&high, max[j] + g * OCC_NODE_WIDTH, sizeof high);
            low = OCC_RELATIVE(low, eye->high[j], eye->low[j]);
            high = OCC_RELATIVE(high, eye->high[j], eye->low[j]);
            t[j] = OCC_MIDDLE(low, high);
            h[j] = OCC_HALF(low, high);
        }
        fnode size = OCC_NORM1(t[0], t[1], t[2]);
        size += OCC_NORM1(h[0], h[1], h[2]);
        lanes->group[g].e = OCC_BOUND(size, eye->slack_floor);
    }
}

typedef struct sides {
    uint32_t inside, outside;
} sides;

// Which nodes are inside a plane, and which outside, for certain.
static inline sides sides_of_nodes(const node_lanes *lanes, const float plane[4])
{
    sides side = {0, 0};
    for (uint32_t g = 0; g < NODE_GROUPS; g++) {
        const fnode *t = lanes->group[g].t, *h = lanes->group[g].h;
        fnode e = lanes->group[g].e;
        fnode s = OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], t[0], t[1], t[2]);
        fnode r = OCC_REACH_OF_AABB(plane[0], plane[1], plane[2], h[0], h[1], h[2]);
        side.inside |= bits_node(OCC_IS_INSIDE(s, r, e)) << g * OCC_NODE_WIDTH;
        side.outside |= bits_node(OCC_IS_OUTSIDE(s, r, e)) << g * OCC_NODE_WIDTH;
    }
    return side;
}

static void cut(occ_siblings *siblings, const occ_eye *eye)
{
    node_lanes lanes;
    load_nodes(&lanes, siblings, eye);
    siblings->outside = 0;
    siblings->hidden = 0;
    for (uint32_t c = 0; c < OCC_NODE_LANES; c++)
        siblings->frustum_of[c] = siblings->frustum;
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (!(siblings->frustum >> p & 1u)) continue;
        sides side = sides_of_nodes(&lanes, eye->plane[p]);
        siblings->outside |= side.outside;
        for (uint32_t c = 0; c < siblings->count; c++)
            siblings->frustum_of[c] &= ~((side.inside >> c & 1u) << p);
    }
    siblings->outside &= (1u << siblings->count) - 1u;
}

typedef struct object_lanes {
    fwide t[3];
    fwide a[9];
    fwide e;
} object_lanes;

static inline void load_objects(object_lanes *o, const occ_boxes *boxes, uint32_t row,
                                const occ_eye *eye)
{
    for (uint32_t j = 0; j < 3; j++) {
        fwide center = load_wide(occ_boxes_column(boxes, j) + row);
        o->t[j] = OCC_RELATIVE(center, eye->high[j], eye->low[j]);
    }
    for (uint32_t k = 0; k < 9; k++)
        o->a[k] = load_wide(occ_boxes_column(boxes, 3 + k) + row);
    fwide size = OCC_NORM1(o->t[0], o->t[1], o->t[2]);
    size += OCC_NORM1(o->a[0], o->a[1], o->a[2]);
    size += OCC_NORM1(o->a[3], o->a[4], o->a[5]);
    size += OCC_NORM1(o->a[6], o->a[7], o->a[8]);
    o->e = OCC_BOUND(size, eye->slack_floor);
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
        outside |= bits_wide(OCC_IS_OUTSIDE(s, r, o->e));
    }
    return outside;
}

// The objects whose center a shadow holds by more than the bound (as in hold_center()), among those
// that are open.
static inline uint32_t centers_inside(const object_lanes *o, const occ_shadow *shadow,
                                      uint32_t open)
{
    for (uint32_t p = 0; p < shadow->planes && open; p++)
        open &= bits_wide(center_of_objects(o, shadow->plane[p]) > o->e);
    return open;
}

static inline uint32_t inside_shadow(const object_lanes *o, const occ_shadow *shadow, uint32_t open)
{
    for (uint32_t p = 0; p < shadow->planes && open; p++) {
        fwide s = center_of_objects(o, shadow->plane[p]), r = reach_of_objects(o, shadow->plane[p]);
        open &= bits_wide(OCC_IS_INSIDE(s, r, o->e));
    }
    return open;
}

// As occ_center_in_frustum().
static inline uint32_t centers_in_frustum(const object_lanes *o, const occ_eye *eye, uint32_t mask)
{
    uint32_t in = ALL_WIDE;
    for (uint32_t p = 0; p < OCC_SIDE_PLANES; p++)
        if (mask >> p & 1u) in &= bits_wide(center_of_objects(o, eye->plane[p]) > 0.0f);
    return in;
}

// As occ_box_fused().
static bool fuse(const occ_relative_box *box, const occ_range *range, const occ_eye *eye,
                 const occ_candidates *candidates, uint32_t row)
{
    fusion_lanes fusion;
    start_fusion(&fusion);
    for (uint32_t i = 0; i < candidates->count; i++) {
        uint32_t c = candidates->list[i];
        if (candidates->shadows[c].owner == row) continue;
        if (consider(&fusion, box, &candidates->wide[c])) return true;
    }
    return fuse_candidates(&fusion, box, eye, range->frustum);
}

// Objects of `open` that several candidates hide together.
static uint32_t fuse_objects(const occ_boxes *boxes, const occ_range *range, const occ_eye *eye,
                             const occ_candidates *candidates, uint32_t row, uint32_t open)
{
    uint32_t hidden = 0;
    for (; open; open &= open - 1u) {
        uint32_t l = (uint32_t)__builtin_ctz(open);
        const occ_box box = occ_boxes_get(boxes, row + l);
        occ_relative_box relative = occ_box_relative(&box, eye);
        hidden |= (uint32_t)fuse(&relative, range, eye, candidates, row + l) << l;
    }
    return hidden;
}

static occ_verdict test(const occ_boxes *boxes, const occ_range *range, const occ_eye *eye,
                        const occ_candidates *candidates)
{
    occ_verdict verdict = {{0, 0}, {0, 0}};
    for (uint32_t i = 0; i < range->count; i += OCC_WIDTH) {
        object_lanes lanes;
        uint32_t row = range->first + i, left = range->count - i;
        load_objects(&lanes, boxes, row, eye);
        uint32_t all = left >= OCC_WIDTH ? ALL_WIDE : (1u << left) - 1u;
        uint32_t outside = outside_frustum(&lanes, eye, range->frustum) & all;
        uint32_t open = all & ~outside, held = 0;
        for (uint32_t c = 0; c < candidates->count && open; c++) {
            const occ_shadow *shadow = &candidates->shadows[candidates->list[c]];
            uint32_t centers = centers_inside(&lanes, shadow, open);
            uint32_t own = shadow->owner - row;
            if (own < OCC_WIDTH) centers &= ~(1u << own);
            if (!centers) continue;
            held |= centers;
            open &= ~inside_shadow(&lanes, shadow, centers);
        }
        if (range->fused && open) {
            uint32_t doubt = open & (held | ~centers_in_frustum(&lanes, eye, range->frustum));
            open &= ~fuse_objects(boxes, range, eye, candidates, row, doubt);
        }
        verdict.visible[i / 32] |= open << i % 32;
        verdict.outside[i / 32] |= outside << i % 32;
    }
    return verdict;
}

extern const occ_lanes OCC_LANES_TABLE;
const occ_lanes OCC_LANES_TABLE = {OCC_TEXT(OCC_LANES_NAME), project, hide, gather, cut, test};
