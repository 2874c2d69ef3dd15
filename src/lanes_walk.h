// SPDX-License-Identifier: Apache-2.0
// What the walk asks about nodes and occluders, one at a time or as siblings.
#ifndef OCC_LANES_WALK_H
#define OCC_LANES_WALK_H

#include "lanes_fusion.h"
#include "lanes_screen.h"

#define NODE_GROUPS (OCC_NODE_LANES / OCC_NODE_WIDTH)

static inline contact meet_asked(const occ_question *question, const occ_wide_shadow *shadow)
{
    return question->upright ? meet(question->box, shadow, true)
                             : meet(question->box, shadow, false);
}

static inline bool is_own(const occ_question *question, const occ_shadow_set *set, uint32_t i)
{
    return set->wide[i].owner - question->first < question->rows;
}

// What holds the center may hide the box alone. Whether one does.
static inline bool ask_center(const occ_question *question, const occ_shadow_set *set, bool *held)
{
    const float *t = question->box->t;
    uint32_t first = question->asked / OCC_SHADOW_LANES * OCC_SHADOW_LANES;
    for (; first < set->count; first += NEAR_BITS) {
        uint64_t near = near_in_blocks(set, first, question->seen->u[8], question->seen->v[8]);
        for (; near; near &= near - 1u) {
            uint32_t i = first + (uint32_t)__builtin_ctzll(near);
            if (!holds_point(&set->wide[i], t[0], t[1], t[2], question->box->e)) continue;
            if (is_own(question, set, i)) continue;
            *held = true;
            contact met = meet_asked(question, &set->wide[i]);
            if (!met.apart && !met.cutting) return true;
        }
    }
    return false;
}

// The occluders that may touch a box, gathered from all blocks. Those beyond the last are left out,
// which can only show more.
typedef struct near_list {
    rect_list rects;
    uint32_t index[LISTED_MOST + OCC_SHADOW_LANES];
} near_list;

static inline void list_near(near_list *list, const occ_question *question,
                             const occ_shadow_set *set)
{
    list->rects.count = 0;
    for (uint32_t first = 0, b = 0; first < set->count; first += OCC_SHADOW_LANES, b++) {
        rect_lanes rects = rects_of_block(&set->rects[b]);
        uint32_t near = present(near_box(&rects, question->seen), set->count - first);
        if (list->rects.count + OCC_SHADOW_LANES > LISTED_MOST) break;
        compress_indices(list->index + list->rects.count, first, near);
        append_rects(&list->rects, &set->rects[b], near);
    }
}

static inline bool holds_corner(const occ_question *question, const occ_shadow_set *set, uint32_t i,
                                uint32_t k)
{
    const occ_projection *seen = question->seen;
    return holds_point(&set->wide[i], seen->x[k], seen->y[k], seen->z[k], question->box->e) &&
           !is_own(question, set, i);
}

// Whether any of the list holds corner k.
static inline bool ask_corner(const occ_question *question, const occ_shadow_set *set,
                              const near_list *list, uint32_t k)
{
    const occ_projection *seen = question->seen;
    for (uint32_t first = 0; first < list->rects.count; first += NEAR_BITS) {
        uint64_t near = near_in_list(&list->rects, first, seen->u[k], seen->v[k]);
        for (; near; near &= near - 1u) {
            uint32_t i = list->index[first + (uint32_t)__builtin_ctzll(near)];
            if (holds_corner(question, set, i, k)) return true;
        }
    }
    return false;
}

// The same of all occluders.
static inline bool ask_first_corner(const occ_question *question, const occ_shadow_set *set,
                                    uint32_t k)
{
    const occ_projection *seen = question->seen;
    for (uint32_t first = 0; first < set->count; first += NEAR_BITS) {
        uint64_t near = near_in_blocks(set, first, seen->u[k], seen->v[k]);
        for (; near; near &= near - 1u) {
            uint32_t i = first + (uint32_t)__builtin_ctzll(near);
            if (holds_corner(question, set, i, k)) return true;
        }
    }
    return false;
}

// Whether a corner in the picture is in no shadow.
static inline bool corner_shows(const occ_question *question, const occ_shadow_set *set,
                                uint32_t shown, near_list *list)
{
    uint32_t k = *question->hint;
    if ((shown >> k & 1u) && !ask_first_corner(question, set, k)) return true;
    list_near(list, question, set);
    for (uint32_t i = 1; i < 8; i++) {
        k = (i + *question->hint) & 7u;
        if (!(shown >> k & 1u) || ask_corner(question, set, list, k)) continue;
        *question->hint = k;
        return true;
    }
    return false;
}

// The first entry that may be taken from a piece, or their number: as occ_fusion_find().
static inline uint32_t find_near(const near_list *list, const piece_lanes *piece,
                                 const occ_question *question, const occ_shadow_set *set,
                                 const occ_screen *screen)
{
    occ_vertex middle = middle_of(piece);
    float u, v;
    project_vertex(screen, &middle, &u, &v);
    for (uint32_t first = 0; first < list->rects.count; first += NEAR_BITS) {
        uint64_t near = near_in_list(&list->rects, first, u, v);
        for (; near; near &= near - 1u) {
            uint32_t n = first + (uint32_t)__builtin_ctzll(near), i = list->index[n];
            if (holds(&set->wide[i], &middle, piece->cuts, question->box->e) &&
                !is_own(question, set, i) && is_behind(question->box, &set->wide[i]))
                return n;
        }
    }
    return list->rects.count;
}

// As occ_fusion_covers().
static inline bool covers_near(const near_list *list, const occ_question *question,
                               const occ_shadow_set *set, const occ_eye *eye,
                               const occ_screen *screen)
{
    fusion_lanes fusion;
    if (!see_outline(&fusion, question->box, eye, false)) return false;
    clip(&fusion, eye, question->frustum, question->box->e);
    for (uint32_t split = 0; fusion.depth; split++) {
        const piece_lanes *top = &fusion.stack[fusion.depth - 1];
        uint32_t n = find_near(list, top, question, set, screen);
        if (n == list->rects.count || split == eye->splits ||
            !subtract(&fusion, &set->wide[list->index[n]], question->box->e)) {
            return false;
        }
    }
    return true;
}

// Points first: what no occluder holds shows. (That a point is inside the box, or on its far side,
// does not matter: on the way from it to the eye no shadow begins.)
static bool hide(const occ_question *question, const occ_shadow_set *set, const occ_eye *eye,
                 const occ_screen *screen)
{
    const occ_relative_box *box = question->box;
    near_list list;
    bool held = false;
    project_center(screen, box->t, question->seen);
    if (ask_center(question, set, &held)) return true;
    if (!question->fuse) return false;
    if (!held && occ_point_in_frustum(box->t[0], box->t[1], box->t[2], eye, question->frustum))
        return false;
    project_corners(screen, box, question->seen);
    uint32_t shown = corners_in_frustum(question->seen, eye, question->frustum);
    if (corner_shows(question, set, shown, &list)) return false;
    return covers_near(&list, question, set, eye, screen);
}

static bool gather(const occ_question *question, const occ_shadow_set *set, uint32_t *list,
                   uint32_t *count)
{
    uint32_t listed = 0;
    for (uint32_t i = 0, b = 0; i < set->count; i += OCC_SHADOW_LANES, b++) {
        rect_lanes rects = rects_of_block(&set->rects[b]);
        uint32_t near = near_box(&rects, question->seen);
        near &= block_before(&set->rects[b], question->key);
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
