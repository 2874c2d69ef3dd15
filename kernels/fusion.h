// SPDX-License-Identifier: Apache-2.0
// What several occluders hide together. Shadows are subtracted one after the other from what the
// eye sees of an object, until nothing is left, or a piece whose middle no shadow holds: then the
// object is visible there (after Weiler and Atherton, Hidden Surface Removal Using Polygon Area
// Sorting, SIGGRAPH 1977). Where the stack, the number of cuts or the floats do not suffice, the
// answer is "visible" as well.
#ifndef OCC_FUSION_H
#define OCC_FUSION_H

#include "outline.h"

#define OCC_SIDE_PLANES       4u // left, right, bottom, top; near and far follow
#define OCC_FUSION_STACK      16u
#define OCC_FUSION_CANDIDATES 64u

// The shadows that the object touches, and the pieces in hand.
typedef struct occ_fusion {
    occ_piece stack[OCC_FUSION_STACK];
    occ_u32 depth;
    occ_u32 candidate[OCC_FUSION_CANDIDATES];
    occ_u32 planes[OCC_FUSION_CANDIDATES]; // bit p: plane p of the shadow cuts the object
    occ_u32 candidates;
    occ_u32 faces; // whether a face is among those planes
    int held;      // whether a shadow holds the object's center
} occ_fusion;

// How many planes of a shadow are silhouettes; those of faces come after them.
OCC_FN occ_u32 occ_shadow_silhouettes(OCC_GLOBAL const occ_shadow *shadow)
{
    return shadow->planes == 5u ? 4u : 6u;
}

// (A structure that is returned by value would do; oclgrind does not know what LLVM makes of it.)
OCC_FN void occ_cutter_set(occ_cutter *n, OCC_PLANES_OF plane, float turn)
{
    n->x = turn * plane[0];
    n->y = turn * plane[1];
    n->z = turn * plane[2];
    n->d = turn * plane[3];
}

// Lists a shadow that the object touches, with the planes that cut the object. Returns whether it
// holds all of the object.
OCC_FN int occ_fusion_consider(occ_fusion *fusion, const occ_relative_box *box,
                               OCC_GLOBAL const occ_shadow *shadow, occ_u32 index)
{
    occ_u32 cutting = 0;
    int held = 1;
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        OCC_PLANES_OF plane = shadow->plane[p];
        float s =
            OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], box->t[0], box->t[1], box->t[2]);
        float r = occ_box_reach(box, plane[0], plane[1], plane[2]);
        if (OCC_IS_OUTSIDE(s, r, box->e)) return 0;
        if (!OCC_IS_INSIDE(s, r, box->e)) cutting |= 1u << p;
        held = held && s > box->e;
    }
    if (!cutting) return 1;
    fusion->held = fusion->held || held;
    if (fusion->candidates == OCC_FUSION_CANDIDATES) return 0;
    fusion->faces |= cutting >> occ_shadow_silhouettes(shadow);
    fusion->candidate[fusion->candidates] = index;
    fusion->planes[fusion->candidates++] = cutting;
    return 0;
}

// The sum of three corners of a piece: three times a point inside.
#define OCC_MIDDLE_CORNERS 3u

OCC_FN void occ_piece_middle(const occ_piece *piece, occ_vertex *middle)
{
    const occ_vertex *a = &piece->v[0], *b = &piece->v[piece->count / OCC_MIDDLE_CORNERS];
    const occ_vertex *c = &piece->v[2 * piece->count / OCC_MIDDLE_CORNERS];
    middle->x = (a->x + b->x) + c->x;
    middle->y = (a->y + b->y) + c->y;
    middle->z = (a->z + b->z) + c->z;
    middle->w = (a->w + b->w) + c->w;
    middle->e = (a->e + b->e) + c->e;
}

// Whether a shadow's planes hold the middle with room to spare, so that cutting gets somewhere.
OCC_FN int occ_shadow_holds(OCC_GLOBAL const occ_shadow *shadow, occ_u32 planes,
                            const occ_vertex *middle)
{
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        if (!(planes >> p & 1u)) continue;
        occ_cutter n;
        occ_cutter_set(&n, shadow->plane[p], 1.0f);
        float least = OCC_MIDDLE_LEAST(middle->e, n.d * middle->w);
        if (!(occ_vertex_at(middle, &n) > least)) return 0;
    }
    return 1;
}

// The first candidate that holds the middle of the piece on top of the stack, or their number.
OCC_FN occ_u32 occ_fusion_find(const occ_fusion *fusion, OCC_GLOBAL const occ_shadow *shadows,
                               int by_faces)
{
    const occ_piece *top = &fusion->stack[fusion->depth - 1];
    occ_vertex middle;
    occ_piece_middle(top, &middle);
    occ_u32 i = 0;
    for (; i < fusion->candidates; i++) {
        OCC_GLOBAL const occ_shadow *shadow = &shadows[fusion->candidate[i]];
        if (!by_faces && fusion->planes[i] >> occ_shadow_silhouettes(shadow)) continue;
        if (occ_shadow_holds(shadow, fusion->planes[i], &middle)) break;
    }
    return i;
}

// Takes a shadow from the piece on top of the stack, which it replaces by what is left. 0 if that
// cannot be done.
OCC_FN int occ_fusion_subtract(occ_fusion *fusion, OCC_GLOBAL const occ_shadow *shadow,
                               occ_u32 planes)
{
    occ_piece piece = fusion->stack[--fusion->depth];
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        if (!(planes >> p & 1u)) continue;
        occ_cutter n;
        occ_cutter_set(&n, shadow->plane[p], 1.0f);
        if (fusion->depth == OCC_FUSION_STACK) return 0;
        int cut = occ_piece_cut(&piece, &n, &piece, &fusion->stack[fusion->depth]);
        if (cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED) return 0;
        if (cut == OCC_CUT_TWO) fusion->depth++;
    }
    return 1;
}

// Takes away what is outside of the frustum's side planes that `mask` names.
OCC_FN void occ_fusion_clip(occ_fusion *fusion, OCC_GLOBAL const occ_eye *eye, occ_u32 mask)
{
    for (occ_u32 p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        occ_cutter beyond;
        occ_cutter_set(&beyond, eye->plane[p], -1.0f);
        occ_u32 kept = 0;
        for (occ_u32 i = 0; i < fusion->depth; i++) {
            occ_piece lost, rest;
            int cut = occ_piece_cut(&fusion->stack[i], &beyond, &lost, &rest);
            if (cut == OCC_CUT_INSIDE) continue;
            if (cut != OCC_CUT_TWO) rest = fusion->stack[i];
            fusion->stack[kept++] = rest;
        }
        fusion->depth = kept;
    }
}

// Whether the candidates hide the pieces on the stack. An outline is no part of the object's
// surface: unless it is of faces, only candidates that are wholly in front may be taken from it.
OCC_FN int occ_fusion_covers(occ_fusion *fusion, OCC_GLOBAL const occ_eye *eye, occ_u32 mask,
                             OCC_GLOBAL const occ_shadow *shadows, int by_faces)
{
    occ_fusion_clip(fusion, eye, mask);
    for (occ_u32 split = 0; fusion->depth; split++) {
        occ_u32 i = occ_fusion_find(fusion, shadows, by_faces);
        if (i == fusion->candidates || split == eye->splits ||
            !occ_fusion_subtract(fusion, &shadows[fusion->candidate[i]], fusion->planes[i])) {
            return 0;
        }
    }
    return 1;
}

// A point is on the inner side of those side planes that `mask` names.
OCC_FN int occ_point_in_frustum(float x, float y, float z, OCC_GLOBAL const occ_eye *eye,
                                occ_u32 mask)
{
    for (occ_u32 p = 0; p < OCC_SIDE_PLANES; p++) {
        OCC_PLANES_OF n = eye->plane[p];
        if ((mask >> p & 1u) && !(OCC_PLANE_AT(n[0], n[1], n[2], n[3], x, y, z) > 0.0f)) return 0;
    }
    return 1;
}

// A shadow holds a point by more than the bound e.
OCC_FN int occ_shadow_holds_point(OCC_GLOBAL const occ_shadow *shadow, float x, float y, float z,
                                  float e)
{
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        OCC_PLANES_OF n = shadow->plane[p];
        if (!(OCC_PLANE_AT(n[0], n[1], n[2], n[3], x, y, z) > e)) return 0;
    }
    return 1;
}

// A point of the box that is in the picture and in no shadow is a witness, wherever it is in the
// box: moving towards the eye leads out of shadows, never into one. Asks corners [first, end).
OCC_FN int occ_box_shows_corners(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye,
                                 occ_u32 mask, OCC_GLOBAL const occ_shadow *shadows,
                                 OCC_GLOBAL const occ_u32 *list, occ_u32 count, occ_u32 row,
                                 occ_u32 first, occ_u32 end)
{
    for (occ_u32 corner = first; corner < end; corner++) {
        float x, y, z;
        occ_box_corner(box, corner, &x, &y, &z);
        if (!occ_point_in_frustum(x, y, z, eye, mask)) continue;
        occ_u32 i = 0;
        for (; i < count; i++) {
            OCC_GLOBAL const occ_shadow *shadow = &shadows[list[i]];
            if (shadow->owner != row && occ_shadow_holds_point(shadow, x, y, z, box->e)) break;
        }
        if (i == count) return 1;
    }
    return 0;
}

OCC_FN int occ_box_shows_corner(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye,
                                occ_u32 mask, OCC_GLOBAL const occ_shadow *shadows,
                                OCC_GLOBAL const occ_u32 *list, occ_u32 count, occ_u32 row)
{
    return occ_box_shows_corners(box, eye, mask, shadows, list, count, row, 0, 8u);
}

// The object is hidden by a candidate, or by several together. Cheap answers come first: the center
// and the corners of what is visible mostly show.
OCC_FN int occ_box_fused(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye, occ_u32 mask,
                         OCC_GLOBAL const occ_shadow *shadows, OCC_GLOBAL const occ_u32 *list,
                         occ_u32 count, occ_u32 row)
{
    occ_fusion fusion;
    fusion.candidates = fusion.faces = 0;
    fusion.held = 0;
    for (occ_u32 i = 0; i < count; i++) {
        OCC_GLOBAL const occ_shadow *shadow = &shadows[list[i]];
        if (shadow->owner != row && occ_fusion_consider(&fusion, box, shadow, list[i])) return 1;
    }
    if (fusion.candidates == 0) return 0;
    if (!fusion.held && occ_point_in_frustum(box->t[0], box->t[1], box->t[2], eye, mask)) return 0;
    if (occ_box_shows_corner(box, eye, mask, shadows, list, count, row)) return 0;
    occ_outline outline;
    if (!occ_outline_set(&outline, box, eye, 0)) return 0;
    fusion.depth = occ_outline_pieces(&outline, box, fusion.stack);
    if (!fusion.depth) return 0;
    if (occ_fusion_covers(&fusion, eye, mask, shadows, 0)) return 1;
    if (!fusion.faces) return 0;
    if (!occ_outline_set(&outline, box, eye, 1)) return 0;
    fusion.depth = occ_outline_pieces(&outline, box, fusion.stack);
    return fusion.depth && occ_fusion_covers(&fusion, eye, mask, shadows, 1);
}

#endif
