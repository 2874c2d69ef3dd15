// SPDX-License-Identifier: Apache-2.0
// Worlds to be judged: boxes of every awkward kind, cameras of every kind, small scenes, and what
// every method on every backend makes of them.
#ifndef OCC_TEST_WORLDS_H
#define OCC_TEST_WORLDS_H

#include "kit.h"

#include <occlude/occlude.h>

// Instrumented builds are slow: there, a part of the work has to do.
#define WORLD_SHARE(count) ((count) / (OCC_TEST_SLOWNESS))

// --- numbers and boxes ---------------------------------------------------------------------------

double world_between(kit_random *random, double low, double high);

// Its logarithm is uniform.
double world_scale(kit_random *random, double low, double high);

void world_direction(kit_random *random, double out[3]);

typedef enum world_shape {
    WORLD_ALIGNED,
    WORLD_TURNED,
    WORLD_SHEARED,
    WORLD_MIRRORED,
    WORLD_SHEET,    // one zero axis
    WORLD_COPLANAR, // three axes in one plane
    WORLD_NEEDLE,   // 1 : 1e6
    WORLD_PLATE,    // nearly a sheet
    WORLD_SEGMENT,
    WORLD_POINT,
    WORLD_SHAPES
} world_shape;

// A box around `center` whose axes are about as long as `size`.
occ_box world_box(kit_random *random, world_shape shape, const double center[3], double size);

// The corner whose bit k says which end of axis k it is at.
void world_corner(const occ_box *box, unsigned corner, double out[3]);

// The box with every number times `factor`.
occ_box world_scaled(const occ_box *box, float factor);

// --- cameras -------------------------------------------------------------------------------------

typedef enum world_projection {
    WORLD_PERSPECTIVE,
    WORLD_INFINITE,
    WORLD_OFF_CENTRE,
    WORLD_JITTERED,
    WORLD_ORTHOGRAPHIC,
    WORLD_PROJECTIONS
} world_projection;

// How a camera projects. Zero members: 60 degrees (orthographic: 20 units high), 0.1, 1000.
typedef struct world_lens {
    world_projection projection;
    occ_depth depth;
    float height; // field of view in radians; orthographic: in units
    float near_z, far_z;
} world_lens;

// Built by cglm in float, as an engine does it. `up` is y, or z if the camera looks along y.
occ_camera_desc world_camera(const float eye[3], const float target[3], const world_lens *lens);

// Rows in random directions, two of which may be nearly parallel, that meet next to a point as far
// from the origin as `reach`.
occ_camera_desc world_skewed_camera(kit_random *random, double reach);

// --- scenes --------------------------------------------------------------------------------------

typedef struct world_occluder {
    occ_box box;
    int owner; // an object's number, or -1
} world_occluder;

// A committed scene in which object i has slot i.
occ_scene *world_scene(const occ_box *objects, uint32_t object_count,
                       const world_occluder *occluders, uint32_t occluder_count,
                       uint32_t leaf_objects);

// A view, or NULL if the backend is OpenCL and there is no device, which CI takes for a failure.
occ_view *world_view(occ_backend backend, uint32_t threads);

// What a cull makes of object i.
bool world_sees(const occ_view *view, uint32_t object);

// All occluders, however small.
occ_cull_desc world_knobs(occ_method method);

#endif
