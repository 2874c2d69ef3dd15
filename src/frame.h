// SPDX-License-Identifier: Apache-2.0
// One frame on its way: the occluders that the walk found and the ranges that it left open. The
// arrays belong to a view and keep their memory from frame to frame.
#ifndef OCC_FRAME_H
#define OCC_FRAME_H

#include "backend.h"
#include "camera.h"
#include "queue.h"

typedef struct occ_frame {
    occ_hooks *hooks;
    const occ_lanes *lanes;
    const occ_scene *scene;
    occ_camera camera;
    occ_cull_desc knobs; // with the defaults filled in
    occ_view_stats stats;

    // occluders.c: the occluders so far, nearest first, frozen after the walk
    occ_array shadows; // of occ_shadow
    occ_array wide;    // of occ_wide_shadow: the same
    occ_array sources; // of occ_occluder: whose shadow each is
    occ_array rects;   // of occ_rect_block: where they are on the screen
    occ_selection selection;

    // walk.c
    occ_queue queue;      // what is still to be looked at
    occ_array open;       // of open_range
    occ_queue closing;    // the open ranges, by their farthest points
    uint32_t hint;        // which corner of a node to ask first
    occ_array ranges;     // of occ_range
    occ_array candidates; // of uint32_t: the candidate lists of the ranges
    occ_array verdicts;   // of occ_verdict, one per range: the backend's

    // Where tests run while the walk goes on. What they read is in `job`, and moves only while they
    // pause.
    occ_team *team;
    occ_shadow_set set;
    occ_test_job job;
} occ_frame;

void occ_frame_init(occ_frame *frame, occ_hooks *hooks, const occ_lanes *lanes);
void occ_frame_free(occ_frame *frame);

// Makes room in an array that tests may be reading: as occ_array_extend().
void *occ_frame_extend(occ_frame *frame, occ_array *array, size_t more);

// Lets the backend read what there is now, all ranges so far.
void occ_frame_set_job(occ_frame *frame);

// Walks the octree of the objects, front to back: chooses this frame's occluders, decides whole
// nodes, and lists the ranges that stay open.
occ_result occ_walk(occ_frame *frame);

// How near the nearest point of an axis-aligned box is, and the farthest: a squared distance, or a
// depth for an orthographic camera. `t` is its center relative to the eye, `h` half its size.
float occ_frame_nearness(const occ_frame *frame, const float t[3], const float h[3]);
float occ_frame_farness(const occ_frame *frame, const float t[3], const float h[3]);

// occluders.c
void occ_occluders_clear(occ_frame *frame);

// Fills in `selection`: which occluders look large enough to be of use.
void occ_occluders_prepare(occ_frame *frame);

// Whether one with this reach may, at this distance at least.
bool occ_occluder_may_be_large(const occ_frame *frame, float reach, float key);

// Whether a sheet looks large enough, and shows a side from which it hides.
bool occ_occluder_sheet_is_large(const occ_frame *frame, const occ_sheet *sheet);

// Makes the shadow of the occluder in a row and adds it to the set, if it has one.
occ_result occ_occluders_add(occ_frame *frame, uint32_t row, float key, const occ_projection *seen);

// Puts those of a list that take up much of the screen first, in steps of a factor of four.
void occ_occluders_sort(const occ_shadow_set *set, uint32_t *list, uint32_t count);

occ_shadow_set occ_occluders_so_far(const occ_frame *frame);

// A box relative to the eye, with its error bound, and a node.
occ_relative_box occ_frame_relative(const occ_frame *frame, const occ_box *box);
occ_relative_box occ_frame_relative_node(const occ_frame *frame, const occ_node *node);

#endif
