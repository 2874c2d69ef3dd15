// SPDX-License-Identifier: Apache-2.0
/// @file
/// What worlds are made of: random numbers with a purpose, boxes of every awkward kind, cameras of
/// every kind. All of it gives the same bits on every machine (see steady.h).
#ifndef OCC_HARD_WORLD_H
#define OCC_HARD_WORLD_H

#include "steady.h"

#include <occlude/cull.h>

// --- numbers -------------------------------------------------------------------------------------

/// Uniform from `low` to `high`.
double world_between(steady_random *random, double low, double high);

/// Its logarithm is uniform.
double world_scale(steady_random *random, double low, double high);

/// Of length 1.
void world_direction(steady_random *random, double out[3]);

/// Three axes of length 1 at right angles.
void world_turn(steady_random *random, double axis[3][3]);

/// The nearest number of `bits` significant bits. 0 stays.
double world_few_bits(double value, int bits);

// --- boxes ---------------------------------------------------------------------------------------

typedef enum world_shape {
    WORLD_ALIGNED,
    WORLD_TURNED,
    WORLD_SHEARED,
    WORLD_MIRRORED,
    WORLD_SHEET,    ///< One zero axis.
    WORLD_COPLANAR, ///< Three axes in one plane, or next to it.
    WORLD_NEEDLE,   ///< 1 : 1e6
    WORLD_PLATE,    ///< Nearly a sheet.
    WORLD_SEGMENT,
    WORLD_POINT,
    WORLD_SHAPES
} world_shape;

/// A box that hides, and the number of the object that it is part of, or -1.
typedef struct world_occluder {
    occ_box box;
    int owner;
} world_occluder;

/// A sheet that hides, and its owner likewise.
typedef struct world_sheet {
    occ_sheet sheet;
    int owner;
} world_sheet;

/// A box around `center` whose axes are about as long as `size`.
occ_box world_box(steady_random *random, world_shape shape, const double center[3], double size);

/// The corner whose bit k says which end of axis k it is at.
void world_corner(const occ_box *box, unsigned corner, double out[3]);

/// The box with every number times `factor`.
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

/// How a camera projects. Zero members: 60 degrees (orthographic: 20 units high), 0.1, 1000.
typedef struct world_lens {
    world_projection projection;
    occ_depth depth;
    float height; ///< Field of view in radians; orthographic: in units.
    float near_z, far_z;
} world_lens;

/// The projection, right-handed, looking down -z, 16 : 9, as rows: clip[r] . (x, y, z, 1).
void world_project(const world_lens *lens, double clip[4][4]);

/// The product of view and projection in float, as an engine computes it. `up` is y, or z if the
/// camera looks along y.
occ_camera_desc world_camera(const float eye[3], const float target[3], const world_lens *lens);

/// Rows in random directions, two of which may be nearly parallel, that meet next to a point as far
/// from the origin as `reach`.
occ_camera_desc world_skewed_camera(steady_random *random, double reach);

#endif
