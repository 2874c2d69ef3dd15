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
    occ_vertex center = {p[0], p[1], p[2], 1.0f, 0.0f};
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

// Occluders of a block that may touch the box, by where they are on the screen.
static inline uint32_t block_near_box(const occ_rect_block *block, const occ_projection *seen)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        uint32_t near = not_above_wide(load_wide(block->min[0] + g), splat_wide(seen->max[0]));
        near &= not_above_wide(splat_wide(seen->min[0]), load_wide(block->max[0] + g));
        near &= not_above_wide(load_wide(block->min[1] + g), splat_wide(seen->max[1]));
        near &= not_above_wide(splat_wide(seen->min[1]), load_wide(block->max[1] + g));
        bits |= near << g;
    }
    return bits;
}

// Those that are no farther than `key`.
static inline uint32_t block_before(const occ_rect_block *block, float key)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH)
        bits |= not_above_wide(load_wide(block->key + g), splat_wide(key)) << g;
    return bits;
}

// Those that may hold a point there.
static inline uint32_t block_near(const occ_rect_block *block, float at_u, float at_v)
{
    uint32_t bits = 0;
    fwide u = splat_wide(at_u), v = splat_wide(at_v);
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        uint32_t near = not_above_wide(load_wide(block->min[0] + g), u);
        near &= not_above_wide(u, load_wide(block->max[0] + g));
        near &= not_above_wide(load_wide(block->min[1] + g), v);
        near &= not_above_wide(v, load_wide(block->max[1] + g));
        bits |= near << g;
    }
    return bits;
}

static inline uint32_t block_near_point(const occ_rect_block *block, const occ_projection *seen,
                                        uint32_t i)
{
    return block_near(block, seen->u[i], seen->v[i]);
}

static inline void copy_rect(occ_rect_block *to, uint32_t lane, const occ_rect_block *from,
                             uint32_t from_lane)
{
    for (uint32_t j = 0; j < 2; j++) {
        to->min[j][lane] = from->min[j][from_lane];
        to->max[j][lane] = from->max[j][from_lane];
    }
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
