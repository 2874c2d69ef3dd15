// SPDX-License-Identifier: Apache-2.0
/// @file
/// The hard cases as families of small worlds: each stands for a situation that breaks culling, and
/// makes as many worlds of it as there are seeds, at any scale and any distance from the origin.
/// docs/hard-cases.md says what each is about.
///
/// What a situation lives from (an eye exactly in a plane, faces that touch) is made of numbers so
/// short that floats hold them and their sums, after turning and scaling too; a share of the worlds
/// is then nudged by single ulps on purpose. The same place gives the same bits on every machine.
#ifndef OCC_HARD_FAMILY_H
#define OCC_HARD_FAMILY_H

#include "world.h"

enum { FAMILY_OBJECTS = 64, FAMILY_OCCLUDERS = 64, FAMILY_SHEETS = 64 };

/// Where a world is, and which it is.
typedef struct family_place {
    /// World units for one unit of the family's own, in which the camera is some ten units from
    /// what it looks at: 1e-6 to 1e6. It is rounded to eight significant bits.
    double scale;
    /// How far off the world is, in world units: the largest coordinate of the point that is its
    /// origin, 0 to 1e7, rounded likewise. The seed picks the direction. Where a float's step at
    /// that distance is no longer small against `scale`, centers fall on each other: a heap of
    /// boxes, legal, and judged like any other world.
    double offset;
    uint64_t seed;
} family_place;

/// What a family makes. `camera` points into the world itself: call family_aim() after copying it.
typedef struct family_world {
    occ_camera_desc camera;
    double eye[3], origin[3]; ///< What camera.eye and camera.origin point to, if they are set.
    /// The camera's parts, eye included, in OpenGL's conventions but for the range of depths, which
    /// is the camera's: what a scene file would say of it. Rounded: the camera is the matrix.
    float view[16], proj[16];
    occ_box objects[FAMILY_OBJECTS];
    world_occluder occluders[FAMILY_OCCLUDERS]; ///< Those that are boxes.
    world_sheet sheets[FAMILY_SHEETS];
    uint32_t object_count, occluder_count, sheet_count;
} family_world;

/// Lets the pointers of a copied world's camera point into it again.
void family_aim(family_world *world);

typedef struct family {
    const char *name, *brief;
    /// Fills in the world, all of it.
    void (*make)(family_world *world, const family_place *place);
} family;

/// All families; the last entry has no name.
extern const family families[];

/// The places that tests and bench go over: all scales and distances in turn, 28 of them, and the
/// number as the seed.
family_place family_sweep(uint64_t number);

/// The family of that name, or NULL.
const family *family_find(const char *name);

/// How many there are.
uint32_t family_count(void);

#endif
