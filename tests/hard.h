// SPDX-License-Identifier: Apache-2.0
// A small scene in which the fate of every object is known beforehand.
#ifndef OCC_TEST_HARD_H
#define OCC_TEST_HARD_H

#include "worlds.h"

#include <check.h>

enum { HARD_OBJECTS = 32, HARD_OCCLUDERS = 8 };

// What is known of an object: SEEN by all methods, HIDDEN by one occluder, OUTSIDE of the frustum,
// or DOUBTFUL, where an error bound may decide.
typedef enum hard_fate { SEEN, HIDDEN, OUTSIDE, DOUBTFUL } hard_fate;

typedef struct hard {
    occ_camera_desc camera;
    double eye[3], origin[3];
    occ_box objects[HARD_OBJECTS];
    hard_fate fates[HARD_OBJECTS];
    world_occluder occluders[HARD_OCCLUDERS];
    uint32_t object_count, occluder_count;
} hard;

// Fills in a scene that is empty.
typedef void hard_builder(hard *h);

void hard_object(hard *h, occ_box box, hard_fate expected);
void hard_occluder(hard *h, occ_box box, int owner);

// A camera at the eye that looks along -z.
void hard_look(hard *h, float x, float y, float z, const world_lens *lens);

// An aligned box with center (x, y, z) and half sizes (a, b, c).
occ_box hard_brick(float x, float y, float z, float a, float b, float c);

// A wall and what is behind, beside and before it, all times `s`.
void hard_wall(hard *h, float s, const world_lens *lens);

// Builds the scene and demands all fates of every method, on the plain and the OpenMP backend, and
// that the judge agrees with all that was left out.
void hard_run(hard_builder *build);

// The same for several scenes on an OpenCL device, if there is one. (Starting it takes longer than
// the scenes do.)
void hard_run_on_device(hard_builder *const *builders, size_t count);

// A test, and behind it the body of the function that builds its scene.
#define HARD_CASE(name)                                                                            \
    static void build_##name(hard *h);                                                             \
    START_TEST(name)                                                                               \
    {                                                                                              \
        hard_run(build_##name);                                                                    \
    }                                                                                              \
    END_TEST                                                                                       \
    static void build_##name(hard *h)

#define HARD_BUILDER(name) build_##name,
#define HARD_ADD(name)     tcase_add_test(host, name);

#endif
