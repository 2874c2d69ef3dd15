// SPDX-License-Identifier: Apache-2.0
// Fusion in vectors: kernels/fusion.h with the planes of a shadow, or the vertices of a piece, side
// by side. Every decision is the same.
#ifndef OCC_LANES_FUSION_H
#define OCC_LANES_FUSION_H

#include "lanes_piece.h"

#include "fusion.h"
#include "lanes.h"

typedef struct fusion_lanes {
    piece_lanes stack[OCC_FUSION_STACK];
    uint32_t depth;
    bool faces; // as in occ_fusion
} fusion_lanes;

// As occ_cutter_set() makes them of the planes.
static inline occ_cutter last_of(const occ_wide_shadow *shadow, float object)
{
    const float *n = shadow->last;
    return (occ_cutter){n[0], n[1], n[2], OCC_CUTTER_OFFSET(n[3], object)};
}

static inline occ_cutter cutter_of(const occ_wide_shadow *shadow, uint32_t p, float object)
{
    if (p == OCC_PLANE_LANES) return last_of(shadow, object);
    return (occ_cutter){shadow->plane[0][p], shadow->plane[1][p], shadow->plane[2][p],
                        OCC_CUTTER_OFFSET(shadow->plane[3][p], object)};
}

// |n.a| of a box along the planes of some lanes, in sum.
static inline fnode reach_along(fnode x, fnode y, fnode z, const float *a)
{
    fnode r = OCC_REACH_OF_AXIS(x, y, z, a[0], a[1], a[2]);
    r += OCC_REACH_OF_AXIS(x, y, z, a[3], a[4], a[5]);
    r += OCC_REACH_OF_AXIS(x, y, z, a[6], a[7], a[8]);
    return r;
}

// How a box and a shadow lie.
typedef struct contact {
    bool apart;       // it holds nothing of the box
    uint32_t cutting; // planes that cut the box
} contact;

// The last face, if it lies there.
static inline void meet_last_plane(contact *met, const occ_wide_shadow *shadow,
                                   const occ_relative_box *box)
{
    const float *n = shadow->last;
    if (n[3] == OCC_NO_PLANE_AT) return;
    float s = OCC_PLANE_AT(n[0], n[1], n[2], n[3], box->t[0], box->t[1], box->t[2]);
    float r = occ_box_reach(box, n[0], n[1], n[2]);
    met->apart = OCC_IS_OUTSIDE(s, r, box->e);
    met->cutting |= (uint32_t)!OCC_IS_INSIDE(s, r, box->e) << OCC_PLANE_LANES;
}

// `upright`: the axes of the box are those of the coordinates, in order.
static inline contact meet(const occ_relative_box *box, const occ_wide_shadow *shadow, bool upright)
{
    const uint32_t all = (1u << OCC_NODE_WIDTH) - 1u;
    const float *t = box->t, *a = box->a;
    contact met = {.apart = false};
    for (uint32_t l = 0; l < OCC_PLANE_LANES && !met.apart; l += OCC_NODE_WIDTH) {
        fnode x = load_node(shadow->plane[0] + l), y = load_node(shadow->plane[1] + l);
        fnode z = load_node(shadow->plane[2] + l), d = load_node(shadow->plane[3] + l);
        fnode s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]), e = splat_node(box->e);
        fnode r = upright ? OCC_REACH_OF_AABB(x, y, z, a[0], a[4], a[8]) : reach_along(x, y, z, a);
        met.apart = above_node(-e, s + r) != 0;
        met.cutting |= (above_node(s - r, e) ^ all) << l;
    }
    if (!met.apart) meet_last_plane(&met, shadow, box);
    return met;
}

// As occ_piece_middle().
static inline occ_vertex middle_of(const piece_lanes *piece)
{
    uint32_t b = piece->count / OCC_MIDDLE_CORNERS, c = 2 * piece->count / OCC_MIDDLE_CORNERS;
    return (occ_vertex){
        (piece->x[0] + piece->x[b]) + piece->x[c], (piece->y[0] + piece->y[b]) + piece->y[c],
        (piece->z[0] + piece->z[b]) + piece->z[c], (piece->w[0] + piece->w[b]) + piece->w[c]};
}

// As occ_shadow_holds().
static inline bool holds(const occ_wide_shadow *shadow, const occ_vertex *middle, uint32_t cuts,
                         float object)
{
    float least = OCC_MIDDLE_LEAST(cuts);
    uint32_t held = 0;
    for (uint32_t l = 0; l < OCC_PLANE_LANES; l += OCC_NODE_WIDTH) {
        fnode d = load_node(shadow->plane[3] + l);
        fnode dw = OCC_CUTTER_OFFSET(d, object) * middle->w;
        fnode at =
            OCC_PLANE_AT(load_node(shadow->plane[0] + l), load_node(shadow->plane[1] + l),
                         load_node(shadow->plane[2] + l), dw, middle->x, middle->y, middle->z);
        held |= above_node(at, splat_node(least)) << l;
    }
    if (shadow->planes & ~held & 0xffu) return false;
    if (!(shadow->planes >> OCC_PLANE_LANES)) return true;
    occ_cutter n = last_of(shadow, object);
    return occ_vertex_at(middle, &n) > least;
}

// As occ_box_is_behind().
static inline bool is_behind(const occ_relative_box *box, const occ_wide_shadow *shadow)
{
    const uint32_t l = OCC_FACE_LANE / OCC_NODE_WIDTH * OCC_NODE_WIDTH;
    const float *t = box->t, *a = box->a;
    fnode x = load_node(shadow->plane[0] + l), y = load_node(shadow->plane[1] + l);
    fnode z = load_node(shadow->plane[2] + l), d = load_node(shadow->plane[3] + l);
    fnode s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]);
    uint32_t inside = above_node(s - reach_along(x, y, z, a), splat_node(box->e)) << l;
    if (shadow->faces & ~inside & 0xffu) return false;
    return !(shadow->faces >> OCC_PLANE_LANES) || occ_box_in_shadow(box, shadow->last, 1);
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
    const float *n = shadow->last;
    return OCC_PLANE_AT(n[0], n[1], n[2], n[3], x, y, z) > e;
}

// The planes that not all of a piece is inside of.
static inline uint32_t planes_that_cut(const piece_lanes *piece, const occ_wide_shadow *shadow,
                                       float object)
{
    float least = OCC_VERTEX_LEAST(piece->cuts);
    uint32_t inside = 0;
    for (uint32_t l = 0; l < OCC_PLANE_LANES; l += OCC_NODE_WIDTH) {
        fnode x = load_node(shadow->plane[0] + l), y = load_node(shadow->plane[1] + l);
        fnode z = load_node(shadow->plane[2] + l), d = load_node(shadow->plane[3] + l);
        uint32_t in = lanes_below(OCC_NODE_WIDTH);
        d = OCC_CUTTER_OFFSET(d, object);
        for (uint32_t i = 0; i < piece->count; i++) {
            fnode dw = d * piece->w[i];
            fnode at = OCC_PLANE_AT(x, y, z, dw, piece->x[i], piece->y[i], piece->z[i]);
            in &= above_node(at, splat_node(least));
        }
        inside |= in << l;
    }
    if (shadow->planes >> OCC_PLANE_LANES) {
        occ_cutter n = last_of(shadow, object);
        inside |= (uint32_t)is_inside(piece, &n) << OCC_PLANE_LANES;
    }
    return shadow->planes & ~inside;
}

// As occ_fusion_cut(), where there is a piece of eight vertices: true if it was halved.
static inline bool halve_on_stack(fusion_lanes *fusion, const piece_lanes *piece,
                                  const occ_cutter *n)
{
    if (is_inside(piece, n)) return false;
    halve_piece(&fusion->stack[fusion->depth++], piece, 0);
    halve_piece(&fusion->stack[fusion->depth++], piece, OCC_PIECE_VERTICES / 2);
    return true;
}

// As occ_fusion_subtract(). The piece stays where it is while parts of it are put below.
static inline bool subtract(fusion_lanes *fusion, const occ_wide_shadow *shadow, float object)
{
    piece_lanes piece = fusion->stack[--fusion->depth];
    uint32_t planes = planes_that_cut(&piece, shadow, object);
    for (; planes; planes &= planes - 1u) {
        occ_cutter n = cutter_of(shadow, (uint32_t)__builtin_ctz(planes), object);
        if (fusion->depth + 2u > OCC_FUSION_STACK) return false;
        if (piece.count == OCC_PIECE_VERTICES && halve_on_stack(fusion, &piece, &n)) return true;
        int cut = cut_piece(&piece, &n, &fusion->stack[fusion->depth]);
        if (cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED) return false;
        if (cut == OCC_CUT_TWO) fusion->depth++;
    }
    return true;
}

// As occ_fusion_clip().
static inline void clip(fusion_lanes *fusion, const occ_eye *eye, uint32_t mask, float object)
{
    for (uint32_t p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        occ_cutter beyond;
        occ_cutter_set(&beyond, eye->plane[p], -1.0f, object);
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

#endif
