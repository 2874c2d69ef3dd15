// SPDX-License-Identifier: Apache-2.0
// Fusion in vectors: kernels/fusion.h with the planes of a shadow, or the vertices of a piece, side
// by side. Every decision is the same.
#ifndef OCC_LANES_FUSION_H
#define OCC_LANES_FUSION_H

#include "lanes_piece.h"

#include "fusion.h"
#include "lanes.h"

typedef struct fusion_lanes {
    piece_lanes stack[OCC_FUSION_STACK + 1]; // cut_piece() needs room for one more
    uint32_t depth;
    const occ_wide_shadow *candidate[OCC_FUSION_CANDIDATES];
    uint32_t planes[OCC_FUSION_CANDIDATES];
    uint32_t candidates;
    uint32_t faces;
    bool held;
} fusion_lanes;

static inline occ_cutter last_of(const occ_wide_shadow *shadow)
{
    return (occ_cutter){shadow->last[0], shadow->last[1], shadow->last[2], shadow->last[3]};
}

static inline occ_cutter cutter_of(const occ_wide_shadow *shadow, uint32_t p)
{
    if (p == OCC_PLANE_LANES) return last_of(shadow);
    return (occ_cutter){shadow->plane[0][p], shadow->plane[1][p], shadow->plane[2][p],
                        shadow->plane[3][p]};
}

// How a box and a shadow lie.
typedef struct contact {
    bool apart;       // it holds nothing of the box
    uint32_t cutting; // planes that cut the box
    bool held;        // it holds the box's center
} contact;

// Adds what lanes from `l` on say.
static inline void meet_planes(contact *met, uint32_t l, uint32_t outside, uint32_t inside,
                               uint32_t held)
{
    const uint32_t all = (1u << OCC_NODE_WIDTH) - 1u;
    met->apart |= outside != 0;
    met->cutting |= (inside ^ all) << l;
    met->held &= held == all;
}

// The third face, if there is one.
static inline void meet_last_plane(contact *met, const occ_wide_shadow *shadow,
                                   const occ_relative_box *box)
{
    occ_cutter n = last_of(shadow);
    if (n.d == OCC_NO_PLANE_AT) return;
    float s = OCC_PLANE_AT(n.x, n.y, n.z, n.d, box->t[0], box->t[1], box->t[2]);
    float r = occ_box_reach(box, n.x, n.y, n.z);
    met->apart = OCC_IS_OUTSIDE(s, r, box->e);
    met->cutting |= (uint32_t)!OCC_IS_INSIDE(s, r, box->e) << OCC_PLANE_LANES;
    met->held &= s > box->e;
}

static inline contact meet(const occ_relative_box *box, const occ_wide_shadow *shadow)
{
    const float *t = box->t, *a = box->a;
    contact met = {.held = true};
    for (uint32_t l = 0; l < OCC_PLANE_LANES && !met.apart; l += OCC_NODE_WIDTH) {
        fnode x = load_node(shadow->plane[0] + l), y = load_node(shadow->plane[1] + l);
        fnode z = load_node(shadow->plane[2] + l), d = load_node(shadow->plane[3] + l);
        fnode s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]);
        fnode r = OCC_REACH_OF_AXIS(x, y, z, a[0], a[1], a[2]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[3], a[4], a[5]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[6], a[7], a[8]);
        fnode e = splat_node(box->e);
        meet_planes(&met, l, above_node(-e, s + r), above_node(s - r, e), above_node(s, e));
    }
    if (!met.apart) meet_last_plane(&met, shadow, box);
    return met;
}

// As meet(), for a box whose axes are those of the coordinates, in order.
static inline contact meet_upright(const occ_relative_box *box, const occ_wide_shadow *shadow)
{
    const float *t = box->t, *a = box->a;
    contact met = {.held = true};
    for (uint32_t l = 0; l < OCC_PLANE_LANES && !met.apart; l += OCC_NODE_WIDTH) {
        fnode x = load_node(shadow->plane[0] + l), y = load_node(shadow->plane[1] + l);
        fnode z = load_node(shadow->plane[2] + l), d = load_node(shadow->plane[3] + l);
        fnode s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]);
        fnode r = OCC_REACH_OF_AABB(x, y, z, a[0], a[4], a[8]), e = splat_node(box->e);
        meet_planes(&met, l, above_node(-e, s + r), above_node(s - r, e), above_node(s, e));
    }
    if (!met.apart) meet_last_plane(&met, shadow, box);
    return met;
}

static inline void add_candidate(fusion_lanes *fusion, const occ_wide_shadow *shadow,
                                 const contact *met)
{
    fusion->held |= met->held;
    if (fusion->candidates == OCC_FUSION_CANDIDATES) return;
    fusion->faces |= met->cutting >> OCC_FACE_LANE;
    fusion->candidate[fusion->candidates] = shadow;
    fusion->planes[fusion->candidates++] = met->cutting;
}

// As occ_fusion_consider().
static inline bool consider(fusion_lanes *fusion, const occ_relative_box *box,
                            const occ_wide_shadow *shadow)
{
    contact met = meet(box, shadow);
    if (met.apart) return false;
    if (met.cutting) add_candidate(fusion, shadow, &met);
    return !met.cutting;
}

// As occ_piece_middle().
static inline occ_vertex middle_of(const piece_lanes *piece)
{
    uint32_t b = piece->count / OCC_MIDDLE_CORNERS, c = 2 * piece->count / OCC_MIDDLE_CORNERS;
    return (occ_vertex){
        (piece->x[0] + piece->x[b]) + piece->x[c], (piece->y[0] + piece->y[b]) + piece->y[c],
        (piece->z[0] + piece->z[b]) + piece->z[c], (piece->w[0] + piece->w[b]) + piece->w[c],
        (piece->e[0] + piece->e[b]) + piece->e[c]};
}

// As occ_shadow_holds().
static inline bool holds(const occ_wide_shadow *shadow, uint32_t planes, const occ_vertex *middle)
{
    uint32_t held = 0;
    for (uint32_t l = 0; l < OCC_PLANE_LANES; l += OCC_NODE_WIDTH) {
        fnode dw = load_node(shadow->plane[3] + l) * middle->w;
        fnode at =
            OCC_PLANE_AT(load_node(shadow->plane[0] + l), load_node(shadow->plane[1] + l),
                         load_node(shadow->plane[2] + l), dw, middle->x, middle->y, middle->z);
        held |= above_node(at, OCC_MIDDLE_LEAST(middle->e, dw)) << l;
    }
    if (planes & ~held & 0xffu) return false;
    if (!(planes >> OCC_PLANE_LANES)) return true;
    occ_cutter n = last_of(shadow);
    return occ_vertex_at(middle, &n) > OCC_MIDDLE_LEAST(middle->e, n.d * middle->w);
}

// As occ_shadow_holds_point().
static inline bool holds_point(const occ_wide_shadow *shadow, float x, float y, float z, float e)
{
    for (uint32_t l = 0; l < OCC_PLANE_LANES; l += OCC_NODE_WIDTH) {
        fnode at =
            OCC_PLANE_AT(load_node(shadow->plane[0] + l), load_node(shadow->plane[1] + l),
                         load_node(shadow->plane[2] + l), load_node(shadow->plane[3] + l), x, y, z);
        if (above_node(at, splat_node(e)) != (1u << OCC_NODE_WIDTH) - 1u) return false;
    }
    occ_cutter n = last_of(shadow);
    return OCC_PLANE_AT(n.x, n.y, n.z, n.d, x, y, z) > e;
}

// As occ_fusion_find().
static inline uint32_t find(const fusion_lanes *fusion, bool by_faces)
{
    occ_vertex middle = middle_of(&fusion->stack[fusion->depth - 1]);
    uint32_t i = 0;
    for (; i < fusion->candidates; i++) {
        if (!by_faces && fusion->planes[i] >> OCC_FACE_LANE) continue;
        if (holds(fusion->candidate[i], fusion->planes[i], &middle)) break;
    }
    return i;
}

// As occ_fusion_subtract(). The piece stays where it is while parts of it are put below.
static inline bool subtract(fusion_lanes *fusion, const occ_wide_shadow *shadow, uint32_t planes)
{
    piece_lanes piece = fusion->stack[--fusion->depth];
    for (; planes; planes &= planes - 1u) {
        occ_cutter n = cutter_of(shadow, (uint32_t)__builtin_ctz(planes));
        if (fusion->depth == OCC_FUSION_STACK) return false;
        int cut = cut_piece(&piece, &n, &fusion->stack[fusion->depth]);
        if (cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED) return false;
        if (cut == OCC_CUT_TWO) fusion->depth++;
    }
    return true;
}

// As occ_fusion_clip().
static inline void clip(fusion_lanes *fusion, const occ_eye *eye, uint32_t mask)
{
    for (uint32_t p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        const float *plane = eye->plane[p];
        occ_cutter beyond = {-plane[0], -plane[1], -plane[2], -plane[3]};
        uint32_t kept = 0;
        for (uint32_t i = 0; i < fusion->depth; i++) {
            piece_lanes lost = fusion->stack[i], rest;
            int cut = cut_piece(&lost, &beyond, &rest);
            if (cut == OCC_CUT_INSIDE) continue;
            fusion->stack[kept++] = cut == OCC_CUT_TWO ? rest : fusion->stack[i];
        }
        fusion->depth = kept;
    }
}

// As occ_fusion_covers().
static inline bool covers(fusion_lanes *fusion, const occ_eye *eye, uint32_t mask, bool by_faces)
{
    clip(fusion, eye, mask);
    for (uint32_t split = 0; fusion->depth; split++) {
        uint32_t i = find(fusion, by_faces);
        if (i == fusion->candidates || split == eye->splits ||
            !subtract(fusion, fusion->candidate[i], fusion->planes[i])) {
            return false;
        }
    }
    return true;
}

// Puts the outline, or the faces, on the stack.
static inline bool see_outline(fusion_lanes *fusion, const occ_relative_box *box,
                               const occ_eye *eye, bool by_faces)
{
    occ_outline outline;
    if (!occ_outline_set(&outline, box, eye, by_faces)) return false;
    fusion->depth = outline.polygons;
    for (uint32_t i = 0; i < outline.polygons; i++)
        if (!outline_piece(&fusion->stack[i], &outline, i, box)) return false;
    return true;
}

static inline void start_fusion(fusion_lanes *fusion)
{
    fusion->candidates = fusion->faces = 0;
    fusion->held = false;
}

// As the rest of occ_box_fused(), once no corner shows.
static inline bool fuse_candidates(fusion_lanes *fusion, const occ_relative_box *box,
                                   const occ_eye *eye, uint32_t mask)
{
    if (!see_outline(fusion, box, eye, false)) return false;
    if (covers(fusion, eye, mask, false)) return true;
    if (!fusion->faces) return false;
    return see_outline(fusion, box, eye, true) && covers(fusion, eye, mask, true);
}

#endif
