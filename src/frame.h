// SPDX-License-Identifier: Apache-2.0
// One frame on its way: the occluders that select.c froze and the ranges that walk.c left open. The
// arrays belong to a view and keep their memory from frame to frame.
#ifndef OCC_FRAME_H
#define OCC_FRAME_H

#include "backend.h"
#include "camera.h"

typedef struct occ_frame {
    occ_hooks *hooks;
    const occ_lanes *lanes;
    const occ_scene *scene;
    occ_camera camera;
    occ_cull_desc knobs; // with the defaults filled in
    occ_view_stats stats;

    // select.c
    occ_array heap;    // of select_entry
    occ_array blocks;  // of occ_shadow_block: the shadows so far, sixteen by sixteen
    occ_array shadows; // of occ_shadow, frozen after select
    occ_array wide;    // of occ_wide_shadow: the same
    occ_array sources; // of occ_occluder: whose shadow each is

    // walk.c
    occ_array stack;      // of walk_entry
    occ_array pool;       // of uint32_t: the candidate lists of the stack's entries
    occ_array inherited;  // of uint32_t: the list of the entry in hand
    occ_array touched;    // of uint8_t
    occ_array ranges;     // of occ_range
    occ_array candidates; // of uint32_t: the candidate lists of the ranges
    occ_array verdicts;   // of occ_verdict, filled by the backend
} occ_frame;

void occ_frame_init(occ_frame *frame, occ_hooks *hooks, const occ_lanes *lanes);
void occ_frame_free(occ_frame *frame);

// Chooses this frame's occluders and freezes them, nearest first.
occ_result occ_select(occ_frame *frame);

// Walks the octree of the objects: decides whole nodes and lists the ranges that stay open.
occ_result occ_walk(occ_frame *frame);

// A box relative to the eye, with its error bound.
occ_relative_box occ_frame_relative(const occ_frame *frame, const occ_box *box);

#endif
