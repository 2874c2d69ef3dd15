// SPDX-License-Identifier: Apache-2.0
// Many boxes, or many shadows, at once. lanes.c is plain C that compilers turn into vector code; it
// is compiled once for every instruction set worth having, and the widest that the CPU has is
// chosen at run time. All give the same bits, since they do the same operations in the same order.
#ifndef OCC_LANES_H
#define OCC_LANES_H

#include "boxes.h"
#include "octree.h"
#include "screen.h"
#include "shadow.h"
#include "verdict.h"

#define OCC_NODE_LANES   8u
#define OCC_SHADOW_LANES 16u
#define OCC_PLANE_LANES  8u
#define OCC_FACE_LANE    6u
#define OCC_NO_PLANE_AT  1e30f // the offset in lanes without a plane

// One shadow with its planes side by side, in two lines of cache: coordinate j of plane p is
// plane[j][p]. Silhouettes begin at lane 0, faces at OCC_FACE_LANE; a third face, and the one of a
// sheet whose silhouettes take up more lanes, is `last`. Everything is inside the planes of the
// other lanes.
typedef struct occ_wide_shadow {
    float plane[4][OCC_PLANE_LANES];
    float last[4];
    uint32_t owner;  // as in occ_shadow
    uint32_t planes; // bit p: lane p has a plane; bit OCC_PLANE_LANES speaks of `last`
    uint32_t faces;  // those of them that are of faces
    uint32_t pad[9];
} occ_wide_shadow;

void occ_wide_shadow_set(occ_wide_shadow *wide, const occ_shadow *shadow);

// Up to eight sibling nodes and what is known of them.
typedef struct occ_siblings {
    const occ_node *nodes;
    uint32_t count;
    uint32_t frustum;                    // planes that may cut the parent
    uint32_t outside;                    // bit c: child c is outside the frustum
    uint32_t frustum_of[OCC_NODE_LANES]; // planes that may cut child c
} occ_siblings;

// Of sixteen occluders: where each is on the screen, with room to spare, and how near. What is not
// there is not in its shadow, so that this can say which of them are worth asking.
typedef struct occ_rect_block {
    float min[2][OCC_SHADOW_LANES], max[2][OCC_SHADOW_LANES];
    float key[OCC_SHADOW_LANES];
} occ_rect_block;

// The occluders so far, nearest first.
typedef struct occ_shadow_set {
    const occ_shadow *shadows;
    const occ_wide_shadow *wide;
    const occ_rect_block *rects;
    uint32_t count;
} occ_shadow_set;

// The candidates of a range: the frozen occluders and a list of those that matter here.
typedef struct occ_candidates {
    const occ_shadow_set *set;
    const uint32_t *list;
    uint32_t count;
} occ_candidates;

// Which occluders are worth looking at: those whose projected area over their squared distance, or
// over the area of an orthographic view, is `least` or more.
typedef struct occ_selection {
    const occ_eye *eye;
    const occ_screen *screen;
    float toward[3]; // orthographic: the direction to the viewer
    float scale;     // orthographic: 1 over the edge of a square as large as the view
    float least;
    bool orthographic;
} occ_selection;

// A box that the walk asks about.
typedef struct occ_question {
    const occ_relative_box *box;
    occ_projection *seen; // filled in as far as need be
    uint32_t frustum;     // planes that may cut it
    uint32_t first, rows; // what objects [first, first + rows) own cannot hide it
    uint32_t asked;       // how many occluders are known not to hide it, if they are asked alone
    float key;            // occluders that are farther do not matter
    bool fuse;            // whether occluders may hide it together
    bool upright;         // the box is axis-aligned, with its axes in order
    uint32_t *hint;       // which corner to ask first: that which showed last
} occ_question;

typedef struct occ_lanes {
    const char *name;

    // Makes the shadow volume of an occluder (shadow.h).
    occ_shade *shade;

    // Where a box is on the screen.
    void (*project)(const occ_screen *screen, const occ_relative_box *box, occ_projection *seen);

    // Whether the occluders hide a box.
    bool (*hide)(const occ_question *question, const occ_shadow_set *set, const occ_eye *eye,
                 const occ_screen *screen);

    // Lists those that touch a box, for which there is room, and sets *count; or returns true: one
    // of them hides it.
    bool (*gather)(const occ_question *question, const occ_shadow_set *set, uint32_t *list,
                   uint32_t *count);

    // Of at most OCC_SHADOW_LANES occluders: which of them are worth looking at, not outside of the
    // frustum's planes and not hidden by one of the occluders so far, and how near each is.
    uint32_t (*select)(const occ_box *boxes, uint32_t count, const occ_selection *choice,
                       uint32_t planes, const occ_shadow_set *set, float *key);

    // Decides siblings against the frustum.
    void (*cut)(occ_siblings *siblings, const occ_eye *eye);

    // Decides the objects of a range.
    occ_verdict (*test)(const occ_boxes *boxes, const occ_range *range, const occ_eye *eye,
                        const occ_screen *screen, const occ_candidates *candidates);
} occ_lanes;

// The widest that this CPU runs.
const occ_lanes *occ_lanes_choose(void);

// All that this CPU runs, for tests: the index-th, or NULL.
const occ_lanes *occ_lanes_get(uint32_t index);

#endif
