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

// Lanes, from `l` on, whose shadow holds the box's center by more than the bound: a box inside has
// that too, in floats as well, since s - r rounds to no more than s. Most lanes end here, for a
// quarter of the work.
static inline uint32_t hold_center(const occ_shadow_block *block, uint32_t l,
                                   const occ_relative_box *box)
{
    const float *t = box->t;
    uint32_t held = ALL_WIDE;
    for (uint32_t p = 0; p < OCC_SHADOW_PLANES && held; p++) {
        const float(*plane)[OCC_SHADOW_LANES] = block->plane[p];
        fwide s = OCC_PLANE_AT(load_wide(plane[0] + l), load_wide(plane[1] + l),
                               load_wide(plane[2] + l), load_wide(plane[3] + l), t[0], t[1], t[2]);
        held &= bits_wide(s > box->e);
    }
    return held;
}

static inline uint32_t hold_box(const occ_shadow_block *block, uint32_t l,
                                const occ_relative_box *box, uint32_t held)
{
    const float *t = box->t, *a = box->a;
    for (uint32_t p = 0; p < OCC_SHADOW_PLANES && held; p++) {
        const float(*plane)[OCC_SHADOW_LANES] = block->plane[p];
        fwide x = load_wide(plane[0] + l), y = load_wide(plane[1] + l);
        fwide z = load_wide(plane[2] + l);
        fwide s = OCC_PLANE_AT(x, y, z, load_wide(plane[3] + l), t[0], t[1], t[2]);
        fwide r = OCC_REACH_OF_AXIS(x, y, z, a[0], a[1], a[2]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[3], a[4], a[5]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[6], a[7], a[8]);
        held &= bits_wide(OCC_IS_INSIDE(s, r, box->e));
    }
    return held;
}

static bool any_hides(const occ_shadow_block *blocks, uint32_t count, const occ_relative_box *box)
{
    for (uint32_t i = 0; i < count * OCC_SHADOW_LANES; i += OCC_WIDTH) {
        const occ_shadow_block *block = &blocks[i / OCC_SHADOW_LANES];
        uint32_t l = i % OCC_SHADOW_LANES, held = hold_center(block, l, box);
        if (held && hold_box(block, l, box, held)) return true;
    }
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

// Bits of the children that own the shadow's occluder: it must not hide them.
static uint32_t owners_among(const occ_siblings *siblings, uint32_t owner)
{
    uint32_t bits = 0;
    for (uint32_t c = 0; c < siblings->count; c++)
        bits |= (uint32_t)(owner - siblings->nodes[c].first < siblings->nodes[c].count) << c;
    return bits;
}

static void shade(occ_siblings *siblings, const occ_eye *eye, const occ_candidates *candidates,
                  uint8_t *touched)
{
    node_lanes lanes;
    load_nodes(&lanes, siblings, eye);
    uint32_t open = ((1u << siblings->count) - 1u) & ~siblings->outside;
    for (uint32_t i = 0; i < candidates->count; i++) {
        const occ_shadow *shadow = &candidates->shadows[candidates->list[i]];
        uint32_t touching = open, inside = open;
        for (uint32_t p = 0; p < shadow->planes && touching; p++) {
            sides side = sides_of_nodes(&lanes, shadow->plane[p]);
            touching &= ~side.outside;
            inside &= side.inside;
        }
        touched[i] = (uint8_t)touching;
        if (!(touching & inside)) continue;
        siblings->hidden |= touching & inside & ~owners_among(siblings, shadow->owner);
        open &= ~siblings->hidden;
        if (!open) return;
    }
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
    fusion.candidates = fusion.faces = 0;
    fusion.held = false;
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
const occ_lanes OCC_LANES_TABLE = {OCC_TEXT(OCC_LANES_NAME), any_hides, cut, shade, test};
