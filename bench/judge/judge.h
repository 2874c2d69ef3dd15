// SPDX-License-Identifier: Apache-2.0
// The exact judge of what several occluders hide together. Every float and double is a rational
// number, and a verdict is computed with those; nothing is rounded, and nothing is shared with the
// library but the types of its header. Doubles with proven bounds are asked first, exact integers
// whenever these cannot tell.
//
// The words. The shadow of an occluder is the closed set of all points whose closed segment to the
// eye meets it: rims and the occluder's own faces belong to it, and so a seam between two boxes
// that share an edge lets nothing through. An occluder that holds the eye, on its surface or
// inside, has no shadow; in a camera with clip planes, only what the near and the far plane leave
// of an occluder has one. An object is seen if some point of it, inside the clip planes, is in no
// shadow. That set is open within the object: if there is one such point there is a patch of them,
// with a positive area on the faces towards the eye (the near plane's cut through the object is
// such a face) for a solid, on the sheet itself for a flat box even when the eye is in its plane,
// and with a positive length on a segment. A solid of which the clip planes leave no volume, a
// sheet of which they leave no area and a segment of which they leave no length is outside. A solid
// that holds the eye is seen.
#ifndef OCC_JUDGE_H
#define OCC_JUDGE_H

#include <occlude/cull.h>

typedef struct judge judge;

// Without clip planes: an eye, or a direction towards a viewer at infinity (not zero).
judge *judge_of_eye(const double eye[3]);
judge *judge_of_direction(const double toward[3]);

// Eye (or direction) and clip planes of a matrix; where `eye` is given the planes are carried to
// it. NULL if the matrix is exactly singular.
judge *judge_of_camera(const occ_camera_desc *camera);

void judge_free(judge *j);

// Whether doubles are asked before exact integers. They are unless this says no: then all is exact,
// and nothing is skipped.
void judge_filter(judge *j, bool on);

// Copies the occluders. `owners` names who is not hidden by each: any number that judge_sees() is
// given as `self`; -1 is nobody. NULL: they have no owners.
void judge_set_occluders(judge *j, const occ_box *boxes, const int *owners, size_t count);

// Adds sheets to the occluders that were set; `owners` as there. A sheet hides what the triangles
// of its fan hide, each as its floats are, whether or not they lie in one plane. One that hides
// from its front alone does so triangle by triangle: each that the eye is before. A triangle
// without an area hides nothing.
void judge_add_sheets(judge *j, const occ_sheet *sheets, const int *owners, size_t count);

// Widens the shadows of all occluders: each plane through the eye and an edge is turned outward
// about the eye, by atan(`by`) in the middle of the edge; planes of faces stay. What is hidden now
// is no farther than that outside of the planes of an occluder. Until the next
// judge_set_occluders(). False if it cannot be said what that is: at infinity, where a clip plane
// cuts an occluder, or the eye is next to the plane of a face. Then the occluders have to be set
// again.
bool judge_grow(judge *j, double by);

// Whether any part of the object is seen. `self` is its number among owners, or -1.
bool judge_sees(judge *j, const occ_box *object, int self);

// A point of the patch that the latest judge_sees() saw, rounded to double: the middle of what is
// left of a face, not of all that is seen; the eye itself if the object holds it. False if nothing
// was seen.
bool judge_witness(const judge *j, double point[3]);

// The part that is seen of all the area that judge_sees() looks at, 0 to 1: a measure, with the
// areas in double. 0 exactly if nothing is seen.
double judge_share(judge *j, const occ_box *object, int self);

// Like oracle_sight: a box is hidden if all segments from its corners cross the occluder, and
// grazed if some only touch it. The clip planes play no part.
typedef enum judge_sight { JUDGE_SEEN, JUDGE_GRAZED, JUDGE_HIDDEN } judge_sight;

judge_sight judge_single(judge *j, const occ_box *object, const occ_box *occluder);

// The same from every eye in a box: the least of all 64 segments between corners. An occluder that
// touches the box of eyes hides nothing.
judge_sight judge_single_from(const occ_box *eyes, const occ_box *object, const occ_box *occluder,
                              bool filter);

// Where the object is: wholly inside or on all clip planes; having some part inside as said above;
// or neither.
typedef enum judge_place { JUDGE_OUTSIDE, JUDGE_CROSSING, JUDGE_INSIDE } judge_place;

judge_place judge_frustum(judge *j, const occ_box *object);

// How many signs were asked for, and how many of them doubles could not tell.
typedef struct judge_effort {
    uint64_t signs, exact;
} judge_effort;

judge_effort judge_spent(const judge *j);

#endif
