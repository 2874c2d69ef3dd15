// SPDX-License-Identifier: Apache-2.0
// What several occluders hide together. Shadows are subtracted one after the other from what the
// eye sees of an object, until nothing is left, or a piece whose middle no shadow holds: then the
// object is visible there (after Weiler and Atherton, Hidden Surface Removal Using Polygon Area
// Sorting, SIGGRAPH 1977). Where the stack, the number of cuts or the floats do not suffice, the
// answer is "visible" as well.
#ifndef OCC_FUSION_H
#define OCC_FUSION_H

#include "outline.h"

#define OCC_SIDE_PLANES  4u // left, right, bottom, top; near and far follow
#define OCC_FUSION_STACK 16u

// The pieces in hand.
typedef struct occ_fusion {
    occ_piece stack[OCC_FUSION_STACK];
    occ_u32 depth;
    int faces; // whether what was last looked for was there, but for the box not being behind it
} occ_fusion;

// How many planes of a shadow are silhouettes; those of faces come after them.
OCC_FN occ_u32 occ_shadow_silhouettes(OCC_GLOBAL const occ_shadow *shadow)
{
    return shadow->silhouettes;
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
}

// Whether a shadow holds the middle of a piece with room to spare, so that cutting gets somewhere.
OCC_FN int occ_shadow_holds(OCC_GLOBAL const occ_shadow *shadow, const occ_vertex *middle,
                            occ_u32 cuts, float object)
{
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        occ_cutter n;
        occ_cutter_set(&n, shadow->plane[p], 1.0f, object);
        if (!(occ_vertex_at(middle, &n) > OCC_MIDDLE_LEAST(cuts))) return 0;
    }
    return 1;
}

// All of the box is behind the faces of a shadow's occluder.
OCC_FN int occ_box_is_behind(const occ_relative_box *box, OCC_GLOBAL const occ_shadow *shadow)
{
    for (occ_u32 p = occ_shadow_silhouettes(shadow); p < shadow->planes; p++)
        if (!occ_box_in_shadow(box, shadow->plane[p], 1)) return 0;
    return 1;
}

// Whether a shadow that holds the middle of a piece may be taken from it. An outline is no part of
// the object's surface: unless it is of faces, the box has to be wholly behind.
OCC_FN int occ_fusion_accepts(occ_fusion *fusion, const occ_relative_box *box,
                              OCC_GLOBAL const occ_shadow *shadow, int by_faces)
{
    if (by_faces || occ_box_is_behind(box, shadow)) return 1;
    fusion->faces = 1;
    return 0;
}

// The first of the list that may be taken from the piece on top of the stack, or their number.
OCC_FN occ_u32 occ_fusion_find(occ_fusion *fusion, const occ_relative_box *box,
                               OCC_GLOBAL const occ_shadow *shadows, OCC_GLOBAL const occ_u32 *list,
                               occ_u32 count, occ_u32 row, int by_faces)
{
    const occ_piece *top = &fusion->stack[fusion->depth - 1];
    occ_vertex middle;
    occ_piece_middle(top, &middle);
    for (occ_u32 i = 0; i < count; i++) {
        OCC_GLOBAL const occ_shadow *shadow = &shadows[list[i]];
        if (shadow->owner != row && occ_shadow_holds(shadow, &middle, top->cuts, box->e) &&
            occ_fusion_accepts(fusion, box, shadow, by_faces)) {
            return i;
        }
    }
    return count;
}

// Cuts a piece: the part outside goes on the stack, where there is room for two. One of eight
// vertices goes there in halves, to be met again. Whether there is something left to cut: *failed
// says why if there is not.
OCC_FN int occ_fusion_cut(occ_fusion *fusion, occ_piece *piece, const occ_cutter *n, int *failed)
{
    if (piece->count == OCC_PIECE_VERTICES && !occ_piece_is_inside(piece, n)) {
        occ_piece_halve(&fusion->stack[fusion->depth++], piece, 0);
        occ_piece_halve(&fusion->stack[fusion->depth++], piece, OCC_PIECE_VERTICES / 2);
        return 0;
    }
    int cut = occ_piece_cut(piece, n, piece, &fusion->stack[fusion->depth]);
    if (cut == OCC_CUT_TWO) fusion->depth++;
    *failed = cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED;
    return !*failed;
}

// Takes a shadow from the piece on top of the stack, which it replaces by what is left. Planes that
// all of the piece is inside of do not cut it, nor what others leave of it. 0 if that cannot be
// done.
OCC_FN int occ_fusion_subtract(occ_fusion *fusion, OCC_GLOBAL const occ_shadow *shadow,
                               float object)
{
    occ_piece piece = fusion->stack[--fusion->depth];
    occ_u32 cutting = 0;
    occ_cutter n;
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        occ_cutter_set(&n, shadow->plane[p], 1.0f, object);
        cutting |= (occ_u32)!occ_piece_is_inside(&piece, &n) << p;
    }
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        int failed = 0;
        if (!(cutting >> p & 1u)) continue;
        occ_cutter_set(&n, shadow->plane[p], 1.0f, object);
        if (fusion->depth + 2u > OCC_FUSION_STACK) return 0;
        if (!occ_fusion_cut(fusion, &piece, &n, &failed)) return !failed;
    }
    return 1;
}

// Takes away what is outside of the frustum's side planes that `mask` names.
OCC_FN void occ_fusion_clip(occ_fusion *fusion, OCC_GLOBAL const occ_eye *eye, occ_u32 mask,
                            float object)
{
    for (occ_u32 p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        occ_cutter beyond;
        occ_cutter_set(&beyond, eye->plane[p], -1.0f, object);
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

// Whether the listed shadows hide the pieces on the stack.
OCC_FN int occ_fusion_covers(occ_fusion *fusion, const occ_relative_box *box,
                             OCC_GLOBAL const occ_eye *eye, occ_u32 mask,
                             OCC_GLOBAL const occ_shadow *shadows, OCC_GLOBAL const occ_u32 *list,
                             occ_u32 count, occ_u32 row, int by_faces)
{
    fusion->faces = 0;
    occ_fusion_clip(fusion, eye, mask, box->e);
    for (occ_u32 split = 0; fusion->depth; split++) {
        occ_u32 i = occ_fusion_find(fusion, box, shadows, list, count, row, by_faces);
        if (i == count || split == eye->splits ||
            !occ_fusion_subtract(fusion, &shadows[list[i]], box->e)) {
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
// box: moving towards the eye leads out of shadows, never into one.
OCC_FN int occ_box_shows_corner(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye,
                                occ_u32 mask, OCC_GLOBAL const occ_shadow *shadows,
                                OCC_GLOBAL const occ_u32 *list, occ_u32 count, occ_u32 row)
{
    for (occ_u32 corner = 0; corner < 8u; corner++) {
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

// Whether a shadow holds all of the box. *held: one holds its center.
OCC_FN int occ_box_hidden_alone(const occ_relative_box *box, OCC_GLOBAL const occ_shadow *shadows,
                                OCC_GLOBAL const occ_u32 *list, occ_u32 count, occ_u32 row,
                                int *held)
{
    const float *t = box->t;
    for (occ_u32 i = 0; i < count; i++) {
        OCC_GLOBAL const occ_shadow *shadow = &shadows[list[i]];
        if (shadow->owner == row) continue;
        if (!occ_shadow_holds_point(shadow, t[0], t[1], t[2], box->e)) continue;
        *held = 1;
        if (occ_box_in_shadow(box, shadow->plane[0], shadow->planes)) return 1;
    }
    return 0;
}

// The object is hidden by a candidate, or by several together. Cheap answers come first: the center
// and the corners of what is visible mostly show.
OCC_FN int occ_box_fused(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye, occ_u32 mask,
                         OCC_GLOBAL const occ_shadow *shadows, OCC_GLOBAL const occ_u32 *list,
                         occ_u32 count, occ_u32 row)
{
    occ_fusion fusion;
    int held = 0;
    if (count == 0) return 0;
    if (occ_box_hidden_alone(box, shadows, list, count, row, &held)) return 1;
    if (!held && occ_point_in_frustum(box->t[0], box->t[1], box->t[2], eye, mask)) return 0;
    if (occ_box_shows_corner(box, eye, mask, shadows, list, count, row)) return 0;
    occ_outline outline;
    if (!occ_outline_set(&outline, box, eye, 0)) return 0;
    fusion.depth = occ_outline_pieces(&outline, box, fusion.stack);
    if (!fusion.depth) return 0;
    if (occ_fusion_covers(&fusion, box, eye, mask, shadows, list, count, row, 0)) return 1;
    if (!fusion.faces) return 0;
    if (!occ_outline_set(&outline, box, eye, 1)) return 0;
    fusion.depth = occ_outline_pieces(&outline, box, fusion.stack);
    return fusion.depth && occ_fusion_covers(&fusion, box, eye, mask, shadows, list, count, row, 1);
}

#endif
