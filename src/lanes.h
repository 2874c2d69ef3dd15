// SPDX-License-Identifier: Apache-2.0
// Many boxes, or many shadows, at once. lanes.c is plain C that compilers turn into vector code; it
// is compiled once for every instruction set worth having, and the widest that the CPU has is
// chosen at run time. All give the same bits, since they do the same operations in the same order.
#ifndef OCC_LANES_H
#define OCC_LANES_H

#include "boxes.h"
#include "octree.h"
#include "verdict.h"

#define OCC_NODE_LANES   8u
#define OCC_SHADOW_LANES 16u

// Sixteen shadows side by side, to be asked about one box. A shadow with fewer planes repeats its
// last; a lane without a shadow has planes that hold nothing.
typedef struct occ_shadow_block {
    float plane[OCC_SHADOW_PLANES][4][OCC_SHADOW_LANES];
} occ_shadow_block;

#define OCC_FACE_LANE 6u

// One shadow with its planes side by side: coordinate j of plane p is plane[j][p]. Silhouettes
// begin at lane 0, faces at OCC_FACE_LANE; everything is inside the planes of the other lanes.
typedef struct occ_wide_shadow {
    float plane[4][OCC_SHADOW_LANES];
} occ_wide_shadow;

void occ_wide_shadow_set(occ_wide_shadow *wide, const occ_shadow *shadow);

// Up to eight sibling nodes and what is known of them.
typedef struct occ_siblings {
    const occ_node *nodes;
    uint32_t count;
    uint32_t frustum;                    // planes that may cut the parent
    uint32_t outside;                    // bit c: child c is outside the frustum
    uint32_t hidden;                     // bit c: one shadow holds all of child c
    uint32_t frustum_of[OCC_NODE_LANES]; // planes that may cut child c
} occ_siblings;

// The frozen occluders and a list of those that matter here.
typedef struct occ_candidates {
    const occ_shadow *shadows;
    const occ_wide_shadow *wide; // the same shadows
    const uint32_t *list;
    uint32_t count;
} occ_candidates;

typedef struct occ_lanes {
    const char *name;

    // Whether one of the shadows in `count` blocks holds the box.
    bool (*any_hides)(const occ_shadow_block *blocks, uint32_t count, const occ_relative_box *box);

    // Decides siblings against the frustum.
    void (*cut)(occ_siblings *siblings, const occ_eye *eye);

    // Decides siblings against the candidates. touched[i] gets bit c where candidate i may hide
    // something of child c: the child's own candidates.
    void (*shade)(occ_siblings *siblings, const occ_eye *eye, const occ_candidates *candidates,
                  uint8_t *touched);

    // Decides the objects of a range.
    occ_verdict (*test)(const occ_boxes *boxes, const occ_range *range, const occ_eye *eye,
                        const occ_candidates *candidates);
} occ_lanes;

// The widest that this CPU runs.
const occ_lanes *occ_lanes_choose(void);

// All that this CPU runs, for tests: the index-th, or NULL.
const occ_lanes *occ_lanes_get(uint32_t index);

#endif
