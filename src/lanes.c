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

#define ASKED_AT_ONCE 4u  // of those that hold a box's center
#define LISTED_BLOCKS 16u // of candidates of a range

#include "lanes_fusion.h"

// --- the screen ----------------------------------------------------------------------------------

static const uint32_t corner_codes[8] = {0, 1, 2, 3, 4, 5, 6, 7};

static void project_center(const occ_screen *screen, const float p[3], occ_projection *seen)
{
    const float *n = screen->row[2];
    float w = OCC_PLANE_AT(n[0], n[1], n[2], screen->w, p[0], p[1], p[2]);
    bool clear = w > screen->least * OCC_NORM1(p[0], p[1], p[2]);
    for (uint32_t r = 0; r < 2; r++) {
        n = screen->row[r];
        float at = clear ? (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) / w : NAN;
        *(r ? &seen->v[8] : &seen->u[8]) = at;
    }
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
static inline uint32_t block_near_box(const occ_rect_block *block, const occ_projection *seen,
                                      float key)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        uint32_t near = not_above_wide(load_wide(block->min[0] + g), splat_wide(seen->max[0]));
        near &= not_above_wide(splat_wide(seen->min[0]), load_wide(block->max[0] + g));
        near &= not_above_wide(load_wide(block->min[1] + g), splat_wide(seen->max[1]));
        near &= not_above_wide(splat_wide(seen->min[1]), load_wide(block->max[1] + g));
        near &= not_above_wide(load_wide(block->key + g), splat_wide(key));
        bits |= near << g;
    }
    return bits;
}

// Those that may hold point i.
static inline uint32_t block_near_point(const occ_rect_block *block, const occ_projection *seen,
                                        uint32_t i)
{
    uint32_t bits = 0;
    for (uint32_t g = 0; g < OCC_SHADOW_LANES; g += OCC_WIDTH) {
        fwide u = splat_wide(seen->u[i]), v = splat_wide(seen->v[i]);
        uint32_t near = not_above_wide(load_wide(block->min[0] + g), u);
        near &= not_above_wide(u, load_wide(block->max[0] + g));
        near &= not_above_wide(load_wide(block->min[1] + g), v);
        near &= not_above_wide(v, load_wide(block->max[1] + g));
        bits |= near << g;
    }
    return bits;
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

// --- boxes of the walk ---------------------------------------------------------------------------

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

// Where a range's candidates are on the screen, sixteen by sixteen in the order of the list.
typedef struct screen_list {
    occ_rect_block block[LISTED_BLOCKS];
    uint32_t count; // the candidates beyond may be anywhere
} screen_list;

static void list_screen(screen_list *list, const occ_candidates *candidates)
{
    const uint32_t most = LISTED_BLOCKS * OCC_SHADOW_LANES;
    list->count = candidates->count < most ? candidates->count : most;
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t s = candidates->list[i], lane = s % OCC_SHADOW_LANES;
        const occ_rect_block *from = &candidates->set->rects[s / OCC_SHADOW_LANES];
        occ_rect_block *to = &list->block[i / OCC_SHADOW_LANES];
        for (uint32_t j = 0; j < 2; j++) {
            to->min[j][i % OCC_SHADOW_LANES] = from->min[j][lane];
            to->max[j][i % OCC_SHADOW_LANES] = from->max[j][lane];
        }
    }
}

// Whether candidate c holds corner k of the object in this row.
static inline bool candidate_holds(const occ_candidates *candidates, uint32_t c, uint32_t row,
                                   const occ_projection *seen, uint32_t k, float e)
{
    uint32_t s = candidates->list[c];
    return holds_point(&candidates->set->wide[s], seen->x[k], seen->y[k], seen->z[k], e) &&
           candidates->set->shadows[s].owner != row;
}

static inline bool corner_is_held(const screen_list *list, const occ_candidates *candidates,
                                  uint32_t row, const occ_projection *seen, uint32_t k, float e)
{
    for (uint32_t i = 0, b = 0; i < list->count; i += OCC_SHADOW_LANES, b++) {
        uint32_t near = block_near_point(&list->block[b], seen, k);
        for (near = present(near, list->count - i); near; near &= near - 1u) {
            uint32_t c = i + (uint32_t)__builtin_ctz(near);
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
    screen_list list;
    uint32_t hint; // the corner that showed last
    bool listed;
} range_fusion;

// As occ_box_fused(), where a candidate holds the center or the center is not in the picture.
static bool fuse(range_fusion *common, const occ_relative_box *box, uint32_t row)
{
    const occ_candidates *candidates = common->candidates;
    occ_projection seen;
    fusion_lanes fusion;
    project_corners(common->screen, box, &seen);
    uint32_t shown = corners_in_frustum(&seen, common->eye, common->range->frustum);
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t k = (i + common->hint) & 7u;
        if (!(shown >> k & 1u)) continue;
        if (corner_is_held(&common->list, candidates, row, &seen, k, box->e)) continue;
        common->hint = k;
        return false;
    }
    start_fusion(&fusion);
    for (uint32_t i = 0; i < candidates->count; i++) {
        uint32_t s = candidates->list[i];
        if (candidates->set->shadows[s].owner == row) continue;
        if (consider(&fusion, box, &candidates->set->wide[s])) return true;
    }
    return fusion.candidates && fuse_candidates(&fusion, box, common->eye, common->range->frustum);
}

// Objects of `open` that several candidates hide together.
static uint32_t fuse_objects(range_fusion *common, const occ_boxes *boxes, uint32_t row,
                             uint32_t open)
{
    uint32_t hidden = 0;
    if (open && !common->listed) list_screen(&common->list, common->candidates);
    common->listed |= open != 0;
    for (; open; open &= open - 1u) {
        uint32_t l = (uint32_t)__builtin_ctz(open);
        const occ_box box = occ_boxes_get(boxes, row + l);
        occ_relative_box relative = occ_box_relative(&box, common->eye);
        hidden |= (uint32_t)fuse(common, &relative, row + l) << l;
    }
    return hidden;
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
    common.listed = false;
    for (uint32_t i = 0; i < range->count; i += OCC_WIDTH) {
        object_lanes lanes;
        uint32_t row = range->first + i, left = range->count - i;
        load_objects(&lanes, boxes, row, eye);
        uint32_t all = left >= OCC_WIDTH ? ALL_WIDE : (1u << left) - 1u;
        uint32_t outside = outside_frustum(&lanes, eye, range->frustum) & all;
        uint32_t open = all & ~outside, held = 0;
        for (uint32_t c = 0; c < candidates->count && open; c++) {
            const occ_shadow *shadow = &candidates->set->shadows[candidates->list[c]];
            uint32_t centers = centers_inside(&lanes, shadow, open);
            uint32_t own = shadow->owner - row;
            if (own < OCC_WIDTH) centers &= ~(1u << own);
            if (!centers) continue;
            held |= centers;
            open &= ~inside_shadow(&lanes, shadow, centers);
        }
        if (range->fused && open && candidates->count) {
            uint32_t doubt = open & (held | ~centers_in_frustum(&lanes, eye, range->frustum));
            open &= ~fuse_objects(&common, boxes, row, doubt);
        }
        verdict.visible[i / 32] |= open << i % 32;
        verdict.outside[i / 32] |= outside << i % 32;
    }
    return verdict;
}

extern const occ_lanes OCC_LANES_TABLE;
const occ_lanes OCC_LANES_TABLE = {OCC_TEXT(OCC_LANES_NAME), project, hide, gather, cut, test};
