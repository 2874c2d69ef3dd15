// SPDX-License-Identifier: Apache-2.0
// Named scenes that are told in other words (scaled, moved, mirrored, in another order), and what
// the library makes of both.
#ifndef OCC_TEST_META_H
#define OCC_TEST_META_H

#include "kit.h"
#include "obs.h"
#include "worlds.h"

enum { META_CAMERAS = 4 };

typedef struct meta_camera {
    occ_camera_desc desc; // its pointers lead to the two below, or nowhere
    double eye[3], origin[3];
    bool derived; // the library is left to find the eye
} meta_camera;

typedef struct meta {
    uint32_t object_count, occluder_count;
    occ_box *objects;
    world_occluder *occluders;
    meta_camera cameras[META_CAMERAS];
} meta;

// A named scene and some frames of its path. What is placed is placed at multiples of 2^-8: there
// is room in the floats to move it.
meta meta_scene(const char *name, uint32_t count, uint64_t seed);
meta meta_copy(const meta *m);
void meta_free(meta *m);

// Points times a signed permutation, times a power of two, plus a shift.
typedef struct meta_map {
    int from[3];     // coordinate j comes from coordinate from[j],
    float sign[3];   // times this
    float factor;    // and this,
    double shift[3]; // plus this
    bool by_origin;  // the shift stands in the cameras' origin, and not in their matrices
} meta_map;

extern const meta_map meta_identity;

meta meta_mapped(const meta *m, const meta_map *map);

// The numbers 0 to count - 1 in some order. To be freed.
uint32_t *meta_order(uint32_t count, uint64_t seed);

// Object i of the result is object order[i]; owners follow.
meta meta_objects_in_order(const meta *m, const uint32_t *order);
meta meta_occluders_in_order(const meta *m, const uint32_t *order);

occ_scene *meta_build(const meta *m);

// Culls camera c; one byte for each object. To be freed.
bool *meta_seen(occ_view *view, const occ_scene *scene, const meta *m, uint32_t c,
                const occ_cull_desc *knobs);

uint32_t meta_count(const bool *seen, uint32_t count);

// How the answers in `now` differ from those in `before`. Objects that only one of the two leaves
// out are put before the exact judge, who must not see them, and so is every `every`-th of those
// that `now` leaves out (0: none).
typedef struct meta_difference {
    uint32_t gone, come, judged; // only `now` leaves it out; only `before`
} meta_difference;

meta_difference meta_compare(const meta *m, uint32_t c, const bool *before, const bool *now,
                             uint32_t every);

#endif
