// SPDX-License-Identifier: Apache-2.0
// Fusion in vectors: kernels/fusion.h with the planes of a shadow, or the vertices of a piece, side
// by side. Every decision is the same.
#ifndef OCC_LANES_FUSION_H
#define OCC_LANES_FUSION_H

#include "lanes_piece.h"

#include "fusion.h"
#include "lanes.h"

#define PLANE_GROUPS ((OCC_FACE_LANE + 3 + OCC_WIDTH - 1) / OCC_WIDTH)

typedef struct fusion_lanes {
    piece_lanes stack[OCC_FUSION_STACK + 1]; // cut_piece() needs room for one more
    uint32_t depth;
    const occ_wide_shadow *candidate[OCC_FUSION_CANDIDATES];
    uint32_t planes[OCC_FUSION_CANDIDATES];
    uint32_t candidates;
    uint32_t faces;
    bool held;
} fusion_lanes;

static inline occ_cutter cutter_of(const occ_wide_shadow *shadow, uint32_t p)
{
    return (occ_cutter){shadow->plane[0][p], shadow->plane[1][p], shadow->plane[2][p],
                        shadow->plane[3][p]};
}

// As occ_fusion_consider().
static inline bool consider(fusion_lanes *fusion, const occ_relative_box *box,
                            const occ_wide_shadow *shadow)
{
    const float *t = box->t, *a = box->a;
    uint32_t cutting = 0, beyond = 0;
    for (uint32_t g = 0; g < PLANE_GROUPS; g++) {
        fwide x = load_wide(shadow->plane[0] + g * OCC_WIDTH);
        fwide y = load_wide(shadow->plane[1] + g * OCC_WIDTH);
        fwide z = load_wide(shadow->plane[2] + g * OCC_WIDTH);
        fwide s =
            OCC_PLANE_AT(x, y, z, load_wide(shadow->plane[3] + g * OCC_WIDTH), t[0], t[1], t[2]);
        fwide r = OCC_REACH_OF_AXIS(x, y, z, a[0], a[1], a[2]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[3], a[4], a[5]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[6], a[7], a[8]);
        if (bits_wide(OCC_IS_OUTSIDE(s, r, box->e))) return false;
        cutting |= (bits_wide(OCC_IS_INSIDE(s, r, box->e)) ^ ALL_WIDE) << g * OCC_WIDTH;
        beyond |= (bits_wide(s > box->e) ^ ALL_WIDE) << g * OCC_WIDTH;
    }
    if (!cutting) return true;
    fusion->held |= !beyond;
    if (fusion->candidates == OCC_FUSION_CANDIDATES) return false;
    fusion->faces |= cutting >> OCC_FACE_LANE;
    fusion->candidate[fusion->candidates] = shadow;
    fusion->planes[fusion->candidates++] = cutting;
    return false;
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
    for (uint32_t g = 0; g < PLANE_GROUPS; g++) {
        fwide dw = load_wide(shadow->plane[3] + g * OCC_WIDTH) * middle->w;
        fwide at = OCC_PLANE_AT(load_wide(shadow->plane[0] + g * OCC_WIDTH),
                                load_wide(shadow->plane[1] + g * OCC_WIDTH),
                                load_wide(shadow->plane[2] + g * OCC_WIDTH), dw, middle->x,
                                middle->y, middle->z);
        uint32_t held = bits_wide(at > OCC_MIDDLE_LEAST(middle->e, dw));
        if (planes >> g * OCC_WIDTH & ALL_WIDE & ~held) return false;
    }
    return true;
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

// As occ_fusion_corner_shows().
static inline bool corner_shows(const fusion_lanes *fusion, const occ_eye *eye, uint32_t mask)
{
    for (uint32_t i = 0; i < fusion->depth; i++) {
        const piece_lanes *piece = &fusion->stack[i];
        uint32_t shown = lanes_below(piece->count);
        for (uint32_t p = 0; p < OCC_SIDE_PLANES; p++) {
            if (!(mask >> p & 1u)) continue;
            const float *plane = eye->plane[p];
            occ_cutter n = {plane[0], plane[1], plane[2], plane[3]};
            for (uint32_t g = 0; g < VERTEX_GROUPS; g++) {
                fwide least, at = vertices_at(piece, g * OCC_WIDTH, &n, &least);
                shown &= ~((bits_wide(at > 0.0f) ^ ALL_WIDE) << g * OCC_WIDTH);
            }
        }
        for (uint32_t c = 0; c < fusion->candidates && shown; c++) {
            uint32_t held = shown;
            for (uint32_t planes = fusion->planes[c]; planes && held; planes &= planes - 1u) {
                occ_cutter n = cutter_of(fusion->candidate[c], (uint32_t)__builtin_ctz(planes));
                held &= vertices_inside(piece, &n);
            }
            shown &= ~held;
        }
        if (shown) return true;
    }
    return false;
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

// As the rest of occ_box_fused(), once all candidates have been considered.
static inline bool fuse_candidates(fusion_lanes *fusion, const occ_relative_box *box,
                                   const occ_eye *eye, uint32_t mask)
{
    if (!fusion->candidates) return false;
    if (!fusion->held && occ_center_in_frustum(box, eye, mask)) return false;
    if (!see_outline(fusion, box, eye, false)) return false;
    if (corner_shows(fusion, eye, mask)) return false;
    if (covers(fusion, eye, mask, false)) return true;
    if (!fusion->faces) return false;
    return see_outline(fusion, box, eye, true) && covers(fusion, eye, mask, true);
}

#endif
