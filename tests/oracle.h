// SPDX-License-Identifier: Apache-2.0
// The judge of verdicts about one occluder. Every float and double is a rational number, and here
// they are computed with as such: nothing is rounded, nothing is shared with the library but the
// types of its header. The library may be unsure where the judge is not; it may never disagree.
#ifndef OCC_TEST_ORACLE_H
#define OCC_TEST_ORACLE_H

#include <occlude/cull.h>

// A camera, exactly: the eye or direction, and the clip planes.
typedef struct oracle oracle;

// What a matrix says, and `eye` if it is given: then the frustum is carried to it. NULL if the
// matrix is exactly singular.
oracle *oracle_of_camera(const occ_camera_desc *camera);

// A camera without planes: an eye, or a direction towards a viewer at infinity.
oracle *oracle_of_eye(const double eye[3]);
oracle *oracle_of_direction(const double toward[3]);

void oracle_free(oracle *o);

// What the occluder does to a point or to a whole box. A point is hidden if the segment to the eye
// crosses the occluder, and grazed if it only touches it (its rim, or a face with an end).
typedef enum oracle_sight { ORACLE_SEEN, ORACLE_GRAZED, ORACLE_HIDDEN } oracle_sight;

// The least hidden of the eight corners. What is hidden of the corners is hidden of all between
// them, since the shadow is convex. An occluder that holds the eye hides nothing. The near plane
// plays no part.
oracle_sight oracle_box(oracle *o, const occ_box *object, const occ_box *occluder);

// One point, when of the occluder only what the near and the far plane leave can hide.
oracle_sight oracle_point(oracle *o, const double point[3], const occ_box *occluder);

// Whether all corners are strictly outside of one and the same clip plane.
bool oracle_outside(oracle *o, const occ_box *object);

// Whether a point is inside all clip planes, or on them.
bool oracle_holds(oracle *o, const double point[3]);

// The eye, rounded to double. False for a direction.
bool oracle_eye(const oracle *o, double eye[3]);

#endif
