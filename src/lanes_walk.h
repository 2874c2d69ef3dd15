// SPDX-License-Identifier: Apache-2.0
// What the walk asks about nodes and occluders, one at a time or as siblings.
#ifndef OCC_LANES_WALK_H
#define OCC_LANES_WALK_H

#include "lanes_fusion.h"
#include "lanes_screen.h"

#define ASKED_AT_ONCE 4u // of those that hold a box's center
#define NODE_GROUPS   (OCC_NODE_LANES / OCC_NODE_WIDTH)

static inline contact meet_asked(const occ_question *question, const occ_wide_shadow *shadow)
{
    return question->upright ? meet_upright(question->box, shadow) : meet(question->box, shadow);
}

static inline bool is_own(const occ_question *question, const occ_shadow_set *set, uint32_t i)
{
    return set->shadows[i].owner - question->first < question->rows;
}

// What holds the center may hide the box alone. Leaves those that do not in `holders`, a word per
// block. Whether one does.
static inline bool ask_center(const occ_question *question, const occ_shadow_set *set,
                              uint32_t blocks, uint16_t *holders, bool *held)
{
    const float *t = question->box->t;
    uint32_t asked = 0;
    for (uint32_t b = 0; b < blocks; b++) {
        uint32_t first = b * OCC_SHADOW_LANES;
        uint32_t near = block_near_point(&set->rects[b], question->seen, 8);
        holders[b] = 0;
        for (near = present(near, set->count - first); near; near &= near - 1u) {
            uint32_t lane = (uint32_t)__builtin_ctz(near), i = first + lane;
            if (!holds_point(&set->wide[i], t[0], t[1], t[2], question->box->e)) continue;
            if (is_own(question, set, i)) continue;
            *held = true;
            if (asked++ >= ASKED_AT_ONCE) {
                holders[b] |= (uint16_t)(1u << lane);
                continue;
            }
            contact met = meet_asked(question, &set->wide[i]);
            if (!met.apart && !met.cutting) return true;
        }
    }
    return false;
}

// Whether any holds corner k. Keeps in `holders` what does.
static inline bool ask_corner(const occ_question *question, const occ_shadow_set *set,
                              uint32_t blocks, uint16_t *holders, uint32_t k)
{
    const occ_projection *seen = question->seen;
    bool any = false;
    for (uint32_t b = 0; b < blocks; b++) {
        if (any && !holders[b]) continue;
        uint32_t first = b * OCC_SHADOW_LANES, held = 0;
        uint32_t near = present(block_near_point(&set->rects[b], seen, k), set->count - first);
        if (any) near &= holders[b];
        for (; near; near &= near - 1u) {
            uint32_t lane = (uint32_t)__builtin_ctz(near), i = first + lane;
            if (!holds_point(&set->wide[i], seen->x[k], seen->y[k], seen->z[k], question->box->e))
                continue;
            if (is_own(question, set, i)) continue;
            held |= 1u << lane;
            if (!any) near &= holders[b] | 1u << lane;
            any = true;
        }
        holders[b] &= (uint16_t)held;
    }
    return any;
}

static inline bool ask_together(const occ_question *question, const occ_shadow_set *set,
                                uint32_t blocks, const occ_eye *eye)
{
    fusion_lanes fusion;
    start_fusion(&fusion);
    for (uint32_t b = 0; b < blocks; b++) {
        uint32_t first = b * OCC_SHADOW_LANES;
        uint32_t near = block_near_box(&set->rects[b], question->seen, INFINITY);
        for (near = present(near, set->count - first); near; near &= near - 1u) {
            uint32_t i = first + (uint32_t)__builtin_ctz(near);
            contact met = meet_asked(question, &set->wide[i]);
            if (met.apart || is_own(question, set, i)) continue;
            if (!met.cutting) return true;
            // What its face cuts it may hide in part, but not together with others.
            if (!(met.cutting >> OCC_FACE_LANE)) add_candidate(&fusion, &set->wide[i], &met);
        }
    }
    return fusion.candidates && see_outline(&fusion, question->box, eye, false) &&
           covers(&fusion, eye, question->frustum, false);
}

// Points first: what no occluder holds shows. (That a point is inside the box, or on its far side,
// does not matter: on the way from it to the eye no shadow begins.)
static bool hide(const occ_question *question, const occ_shadow_set *set, const occ_eye *eye,
                 const occ_screen *screen)
{
    occ_projection *seen = question->seen;
    uint16_t holders[OCC_MOST_SHADOW_BLOCKS];
    const occ_relative_box *box = question->box;
    uint32_t blocks = (set->count + OCC_SHADOW_LANES - 1u) / OCC_SHADOW_LANES;
    if (blocks > OCC_MOST_SHADOW_BLOCKS) blocks = OCC_MOST_SHADOW_BLOCKS;
    bool held = false;
    project_center(screen, box->t, seen);
    if (ask_center(question, set, blocks, holders, &held)) return true;
    if (!held && occ_point_in_frustum(box->t[0], box->t[1], box->t[2], eye, question->frustum))
        return false;
    project_corners(screen, box, seen);
    uint32_t shown = corners_in_frustum(seen, eye, question->frustum);
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t k = (i + *question->hint) & 7u;
        if (!(shown >> k & 1u) || ask_corner(question, set, blocks, holders, k)) continue;
        *question->hint = k;
        return false;
    }
    for (uint32_t b = 0; b < blocks; b++) {
        for (uint32_t left = holders[b]; left; left &= left - 1u) {
            uint32_t i = b * OCC_SHADOW_LANES + (uint32_t)__builtin_ctz(left);
            contact met = meet_asked(question, &set->wide[i]);
            if (!met.apart && !met.cutting) return true;
        }
    }
    return question->fuse && ask_together(question, set, blocks, eye);
}

static bool gather(const occ_question *question, const occ_shadow_set *set, uint32_t *list,
                   uint32_t *count)
{
    uint32_t listed = 0;
    for (uint32_t i = 0, b = 0; i < set->count; i += OCC_SHADOW_LANES, b++) {
        uint32_t near = block_near_box(&set->rects[b], question->seen, question->key);
        for (near = present(near, set->count - i); near; near &= near - 1u) {
            uint32_t s = i + (uint32_t)__builtin_ctz(near);
            contact met = meet_asked(question, &set->wide[s]);
            if (met.apart) continue;
            if (!met.cutting && !is_own(question, set, s)) return true;
            list[listed++] = s;
        }
    }
    *count = listed;
    return false;
}

// --- siblings ------------------------------------------------------------------------------------

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
        side.inside |= above_node(s - r, e) << g * OCC_NODE_WIDTH;
        side.outside |= above_node(-e, s + r) << g * OCC_NODE_WIDTH;
    }
    return side;
}

static void cut(occ_siblings *siblings, const occ_eye *eye)
{
    node_lanes lanes;
    load_nodes(&lanes, siblings, eye);
    siblings->outside = 0;
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

#endif
