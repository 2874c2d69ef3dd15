// SPDX-License-Identifier: Apache-2.0
// Where boxes and occluders are on the screen: what is worth asking about what. Nothing here
// decides that a box is hidden.
#ifndef OCC_LANES_SCREEN_H
#define OCC_LANES_SCREEN_H

#include "lanes_piece.h"

#include "lanes.h"

static const uint32_t corner_codes[8] = {0, 1, 2, 3, 4, 5, 6, 7};

// Where (x, y, z) / w is.
static inline void project_vertex(const occ_screen *screen, const occ_vertex *p, float *u, float *v)
{
    const float(*row)[3] = screen->row;
    float w = OCC_PLANE_AT(row[2][0], row[2][1], row[2][2], screen->w * p->w, p->x, p->y, p->z);
    bool clear = w > screen->least * OCC_NORM1(p->x, p->y, p->z);
    *u = clear ? (row[0][0] * p->x + row[0][1] * p->y + row[0][2] * p->z) / w : NAN;
    *v = clear ? (row[1][0] * p->x + row[1][1] * p->y + row[1][2] * p->z) / w : NAN;
}

static inline void project_center(const occ_screen *screen, const float p[3], occ_projection *seen)
{
    occ_vertex center = {p[0], p[1], p[2], 1.0f};
    project_vertex(screen, &center, &seen->u[8], &seen->v[8]);
}

static void project_corners(const occ_screen *screen, const occ_relative_box *box,
                            occ_projection *seen)
{
    const float(*row)[3] = screen->row;
    uint32_t clear = 0;
    for (uint32_t l = 0; l < 8; l += OCC_NODE_WIDTH) {
        inode codes;
        fnode x, y, z;
        memcpy(&codes, corner_codes + l, sizeof codes);
        corners_of(box, codes, &x, &y, &z);
        fnode w = OCC_PLANE_AT(row[2][0], row[2][1], row[2][2], screen->w, x, y, z);
        fnode least = screen->least * OCC_NORM1(x, y, z);
        const fnode nan = splat_node(NAN);
        fnode u = (row[0][0] * x + row[0][1] * y + row[0][2] * z) / w;
        fnode v = (row[1][0] * x + row[1][1] * y + row[1][2] * z) / w;
        store_node(seen->x + l, x);
        store_node(seen->y + l, y);
        store_node(seen->z + l, z);
        store_node(seen->u + l, select_node(w > least, u, nan));
        store_node(seen->v + l, select_node(w > least, v, nan));
        clear |= above_node(w, least) << l;
    }
    bool whole = clear == 0xffu;
    seen->min[0] = whole ? least_of_eight(seen->u) : -INFINITY;
    seen->min[1] = whole ? least_of_eight(seen->v) : -INFINITY;
    seen->max[0] = whole ? largest_of_eight(seen->u) : INFINITY;
    seen->max[1] = whole ? largest_of_eight(seen->v) : INFINITY;
}

static void project(const occ_screen *screen, const occ_relative_box *box, occ_projection *seen)
{
    project_corners(screen, box, seen);
    project_center(screen, box->t, seen);
}

static inline uint32_t present(uint32_t bits, uint32_t count)
{
    return count >= OCC_SHADOW_LANES ? bits : bits & ((1u << count) - 1u);
}

// Where sixteen occluders are on the screen.
typedef struct rect_lanes {
    const float *left, *right, *low, *high;
} rect_lanes;

static inline rect_lanes rects_of_block(const occ_rect_block *block)
{
    return (rect_lanes){block->min[0], block->max[0], block->min[1], block->max[1]};
}

// Those that may touch the box.
static inline uint32_t near_box(const rect_lanes *rects, const occ_projection *seen)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        fwide least[4] = {load_wide(rects->left + g), splat_wide(seen->min[0]),
                          load_wide(rects->low + g), splat_wide(seen->min[1])};
        fwide most[4] = {splat_wide(seen->max[0]), load_wide(rects->right + g),
                         splat_wide(seen->max[1]), load_wide(rects->high + g)};
        bits |= none_above_wide(least, most) << g;
    }
    return bits;
}

// Those of a block that are no farther than `key`.
static inline uint32_t block_before(const occ_rect_block *block, float key)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH)
        bits |= not_above_wide(load_wide(block->key + g), splat_wide(key)) << g;
    return bits;
}

// Those that may hold a point there.
static inline uint32_t near_point(const rect_lanes *rects, float at_u, float at_v)
{
    uint32_t bits = 0;
    fwide u = splat_wide(at_u), v = splat_wide(at_v);
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        fwide least[4] = {load_wide(rects->left + g), u, load_wide(rects->low + g), v};
        fwide most[4] = {u, load_wide(rects->right + g), v, load_wide(rects->high + g)};
        bits |= none_above_wide(least, most) << g;
    }
    return bits;
}

// Occluders gathered from blocks, side by side.
#define LISTED_MOST 256u

typedef struct rect_list {
    float left[LISTED_MOST + OCC_SHADOW_LANES], right[LISTED_MOST + OCC_SHADOW_LANES];
    float low[LISTED_MOST + OCC_SHADOW_LANES], high[LISTED_MOST + OCC_SHADOW_LANES];
    uint32_t count;
} rect_list;

static inline rect_lanes rects_of_list(const rect_list *list, uint32_t i)
{
    return (rect_lanes){list->left + i, list->right + i, list->low + i, list->high + i};
}

// Points are looked up among as many rectangles as a word has bits, before any of what is found is
// asked: there is less to branch on.
#define NEAR_BITS 64u

// Those of the list from `first` on, up to NEAR_BITS, that may hold a point there.
static inline uint64_t near_in_list(const rect_list *list, uint32_t first, float u, float v)
{
    uint32_t left = list->count - first, most = left < NEAR_BITS ? left : NEAR_BITS;
    uint64_t near = 0;
    for (uint32_t i = 0; i < most; i += OCC_SHADOW_LANES) {
        rect_lanes rects = rects_of_list(list, first + i);
        near |= (uint64_t)present(near_point(&rects, u, v), left - i) << i;
    }
    return near;
}

// The same of occluders in blocks.
static inline uint64_t near_in_blocks(const occ_shadow_set *set, uint32_t first, float u, float v)
{
    uint32_t left = set->count - first, most = left < NEAR_BITS ? left : NEAR_BITS;
    uint64_t near = 0;
    for (uint32_t i = 0; i < most; i += OCC_SHADOW_LANES) {
        rect_lanes rects = rects_of_block(&set->rects[(first + i) / OCC_SHADOW_LANES]);
        near |= (uint64_t)present(near_point(&rects, u, v), left - i) << i;
    }
    return near;
}

// Appends the lanes of a block that `lanes` names; there is room for a block.
static inline void append_rects(rect_list *list, const occ_rect_block *block, uint32_t lanes)
{
    const float *from[4] = {block->min[0], block->max[0], block->min[1], block->max[1]};
    float *to[4] = {list->left, list->right, list->low, list->high};
    for (uint32_t j = 0; j < 4; j++)
        compress_sixteen(to[j] + list->count, from[j], lanes);
    list->count += (uint32_t)__builtin_popcount(lanes);
}

// As occ_point_in_frustum(), for the corners.
static inline uint32_t corners_in_frustum(const occ_projection *seen, const occ_eye *eye,
                                          uint32_t mask)
{
    uint32_t in = 0xffu;
    for (uint32_t p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        const float *n = eye->plane[p];
        uint32_t inner = 0;
        for (uint32_t l = 0; l < 8; l += OCC_NODE_WIDTH) {
            fnode at = OCC_PLANE_AT(n[0], n[1], n[2], n[3], load_node(seen->x + l),
                                    load_node(seen->y + l), load_node(seen->z + l));
            inner |= above_node(at, splat_node(0.0f)) << l;
        }
        in &= inner;
    }
    return in;
}

#endif
