// SPDX-License-Identifier: Apache-2.0
// A crew: one view for every backend and thread count, all of which are to say the same.
#ifndef OCC_TEST_KIT_CREW_H
#define OCC_TEST_KIT_CREW_H

#include "kit.h"

enum { KIT_CREW_MOST = 6 };

// The first is the plain backend. OpenCL comes last and stays away where there is no device, which
// CI takes for a failure.
typedef struct kit_crew {
    occ_view *view[KIT_CREW_MOST];
    const char *name[KIT_CREW_MOST];
    unsigned size;
} kit_crew;

// They start threads: gather and dismiss them within a test, or in a checked fixture.
void kit_crew_gather(kit_crew *crew);
void kit_crew_dismiss(kit_crew *crew);

occ_view_stats kit_stats(const occ_view *view);

// Fails the test, naming `who`, unless two views hold the same masks and counts.
void kit_same_answers(const occ_view *a, const occ_view *b, const char *who);

// Culls with all of the crew, and fails the test unless all agree with the first. Returns the
// mask, to be freed.
uint32_t *kit_crew_cull(kit_crew *crew, const occ_scene *scene, const occ_camera_desc *camera,
                        const occ_cull_desc *knobs);

// Whether two masks over so many slots are the same.
bool kit_same_words(const uint32_t *a, const uint32_t *b, uint32_t slots);

// Moves many of the objects, each within its cell of the octree: no row changes place, and only
// those of the moved objects change. Returns how many were moved.
uint32_t kit_move_within_cells(occ_scene *scene, const occ_object *objects, uint32_t count,
                               kit_random *random);

#endif
