// SPDX-License-Identifier: Apache-2.0
// The flat test: every object of a table, without an octree. The table's rows are cut into blocks
// of 64 and groups of 64 blocks. What falls as a whole is not read; a block that stays open gets a
// list of the occluders that touch it, and its objects are asked about those alone.
//
//     occluders -> group: which touch it? -> block: which of those? -> object: cheap answers ->
//     fusion
//
// Every step is the same arithmetic on the host and on each device, so that the masks are the same
// bits. Lists are in the order of the set, and any subset of the occluders is safe.
#ifndef OCC_FLAT_H
#define OCC_FLAT_H

#include "fusion.h"

#define OCC_FLAT_ROWS    64u  // objects to a block
#define OCC_FLAT_BLOCKS  64u  // blocks to a group
#define OCC_FLAT_LIST    128u // candidates that a block keeps
#define OCC_FLAT_SHADOWS 1024u
#define OCC_FLAT_WORDS   (OCC_FLAT_SHADOWS / 32u)
#define OCC_FLAT_BOUNDS  6u // columns: least x, y, z, then most

// Beside the verdicts: neither of them without cutting.
#define OCC_UNRESOLVED 3u

// How a box and a shadow lie.
#define OCC_MEET_APART   0u
#define OCC_MEET_TOUCHES 1u
#define OCC_MEET_HELD    2u // all of the box

// What goes to the device for a frame, in one piece; the shadows come after it.
typedef struct occ_flat_frame {
    occ_eye eye;
    occ_u32 planes;  // bit p: plane p of the frustum exists
    occ_u32 shadows; // how many
    occ_u32 fused;
    occ_u32 counts; // which of the two sets of counts this frame uses
} occ_flat_frame;

// What a frame counts on the device.
#define OCC_COUNT_OPEN       0u // blocks
#define OCC_COUNT_UNRESOLVED 1u // objects
#define OCC_COUNT_VISIBLE    2u // objects
#define OCC_COUNTS           4u // of a set

// A row without an object has a center of NaN.
#define OCC_FLAT_MOST 4e15f // what the magnitudes of a box's numbers may add up to

OCC_FN int occ_flat_is_object(OCC_GLOBAL const float *box)
{
    float size = 0.0f;
    for (occ_u32 c = 0; c < 12u; c++)
        size += OCC_FABS(box[c]);
    return size <= OCC_FLAT_MOST;
}

// An axis-aligned box that holds an object's box: outward by more than what all of this rounds.
OCC_FN void occ_flat_extent(float c, float a0, float a1, float a2, float *least, float *most)
{
    float h = (OCC_FABS(a0) + OCC_FABS(a1)) + OCC_FABS(a2);
    float room = (OCC_FABS(c) + h) * 0x1p-20f;
    *least = (c - h) - room;
    *most = (c + h) + room;
}

// Relative to the eye, with the half sizes where axes that lie along the coordinates have them.
OCC_FN void occ_flat_node(occ_relative_box *box, const float *least, const float *most,
                          OCC_GLOBAL const occ_eye *eye)
{
    for (occ_u32 j = 0; j < 9u; j++)
        box->a[j] = 0.0f;
    for (occ_u32 j = 0; j < 3u; j++) {
        float min = OCC_RELATIVE(least[j], eye->high[j], eye->low[j]);
        float max = OCC_RELATIVE(most[j], eye->high[j], eye->low[j]);
        box->t[j] = OCC_MIDDLE(min, max);
        box->a[4 * j] = OCC_HALF(min, max);
    }
    box->e = occ_box_slack(box, eye->slack_floor);
}

#define OCC_NODE_AT(box, n)                                                                        \
    OCC_PLANE_AT((n)[0], (n)[1], (n)[2], (n)[3], (box)->t[0], (box)->t[1], (box)->t[2])
#define OCC_NODE_REACH(box, n)                                                                     \
    OCC_REACH_OF_AABB((n)[0], (n)[1], (n)[2], (box)->a[0], (box)->a[4], (box)->a[8])

// The planes of the frustum that may cut a node, of those that `planes` names. OCC_FLAT_OUTSIDE: it
// is outside.
#define OCC_FLAT_OUTSIDE 0xffffffffu

OCC_FN occ_u32 occ_flat_cut(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye,
                            occ_u32 planes)
{
    occ_u32 cutting = 0;
    for (occ_u32 p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (!(planes >> p & 1u)) continue;
        OCC_PLANES_OF n = eye->plane[p];
        float s = OCC_NODE_AT(box, n), r = OCC_NODE_REACH(box, n);
        if (OCC_IS_OUTSIDE(s, r, box->e)) return OCC_FLAT_OUTSIDE;
        if (!OCC_IS_INSIDE(s, r, box->e)) cutting |= 1u << p;
    }
    return cutting;
}

// How a node and a shadow lie. Objects in rows [first, end) are in the node: if one of them owns
// the occluder, it does not hold them all.
OCC_FN occ_u32 occ_flat_meet_node(const occ_relative_box *box, OCC_GLOBAL const occ_shadow *shadow,
                                  occ_u32 first, occ_u32 end)
{
    int held = shadow->owner < first || shadow->owner >= end;
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        OCC_PLANES_OF n = shadow->plane[p];
        float s = OCC_NODE_AT(box, n), r = OCC_NODE_REACH(box, n);
        if (OCC_IS_OUTSIDE(s, r, box->e)) return OCC_MEET_APART;
        held = held && OCC_IS_INSIDE(s, r, box->e);
    }
    return held ? OCC_MEET_HELD : OCC_MEET_TOUCHES;
}

// How an object and a shadow lie; whether the shadow holds its center is added to *centered.
OCC_FN occ_u32 occ_flat_meet(const occ_relative_box *box, OCC_GLOBAL const occ_shadow *shadow,
                             int *centered)
{
    int held = 1, center = 1;
    for (occ_u32 p = 0; p < shadow->planes; p++) {
        OCC_PLANES_OF n = shadow->plane[p];
        float s = OCC_PLANE_AT(n[0], n[1], n[2], n[3], box->t[0], box->t[1], box->t[2]);
        float r = occ_box_reach(box, n[0], n[1], n[2]);
        if (OCC_IS_OUTSIDE(s, r, box->e)) return OCC_MEET_APART;
        held = held && OCC_IS_INSIDE(s, r, box->e);
        center = center && s > box->e;
    }
    *centered = *centered || center;
    return held ? OCC_MEET_HELD : OCC_MEET_TOUCHES;
}

// What is cheap to know of an object. What stays unresolved is for occ_box_fused(), which would
// have given the other answers too.
OCC_FN occ_u32 occ_flat_object(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye,
                               occ_u32 planes, OCC_GLOBAL const occ_shadow *shadows,
                               OCC_GLOBAL const occ_u32 *list, occ_u32 count, occ_u32 row,
                               occ_u32 fused)
{
    int centered = 0;
    if (!(box->t[0] == box->t[0])) return OCC_OUTSIDE;
    if (occ_box_outside(box, eye->plane[0], planes)) return OCC_OUTSIDE;
    for (occ_u32 i = 0; i < count; i++) {
        OCC_GLOBAL const occ_shadow *shadow = &shadows[list[i]];
        if (shadow->owner == row) continue;
        if (occ_flat_meet(box, shadow, &centered) == OCC_MEET_HELD) return OCC_HIDDEN;
    }
    if (!count || !fused) return OCC_VISIBLE;
    if (!centered && occ_point_in_frustum(box->t[0], box->t[1], box->t[2], eye, planes)) {
        return OCC_VISIBLE;
    }
    if (occ_box_shows_corner(box, eye, planes, shadows, list, count, row)) return OCC_VISIBLE;
    return OCC_UNRESOLVED;
}

#define OCC_FRAME_SHADOWS(frame) ((OCC_GLOBAL const occ_shadow *)((frame) + 1))

#endif
