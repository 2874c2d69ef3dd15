// SPDX-License-Identifier: Apache-2.0
// Choosing a frame's occluders where nothing else is asked of the walk: the picture is cut into
// strips side by side, and each strip has a walk of its own that others can do meanwhile. Which
// occluders are chosen depends on the number of strips, and on nothing else. An occluder that shows
// between two strips alone may be missed: any choice of occluders is safe.
#ifndef OCC_STRIPS_H
#define OCC_STRIPS_H

#include "frame.h"

#include <stdatomic.h>

#define OCC_MOST_STRIPS 16u
#define OCC_MOST_MERGED 2048u // occluders

#define OCC_MERGED_PLACES (2u * OCC_MOST_MERGED)

typedef struct occ_strip {
    occ_hooks hooks; // the owner's, one call at a time
    occ_frame frame;
    occ_result result;
    uint32_t taken; // occluders that are merged
} occ_strip;

typedef struct occ_strips {
    occ_hooks *hooks;
    atomic_flag allocating;
    occ_team *team;
    uint32_t count;
    uint32_t merged[OCC_MERGED_PLACES]; // by their numbers: which ones are in; 0: nobody
    occ_strip strip[OCC_MOST_STRIPS];
} occ_strips;

// `strips` is 1 to OCC_MOST_STRIPS; as many threads share them, or as many as there are. What is
// open is closed by occ_strips_close() even on failure.
occ_result occ_strips_open(occ_strips *strips, occ_hooks *hooks, const occ_lanes *lanes,
                           uint32_t count);
void occ_strips_close(occ_strips *strips);

// Fills in shadows and sources of a frame whose scene, camera and knobs are set.
occ_result occ_strips_choose(occ_strips *strips, occ_frame *frame);

#endif
