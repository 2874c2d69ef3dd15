// SPDX-License-Identifier: Apache-2.0
// Where points and triangles lie to a box, exactly: floating point answers when it can be sure, and
// numbers without rounding answer what is left.
//
// Numbers must be finite and at most OCC_MAX_COORDINATE: the corners of a box (occ_box_check()) and
// the points.
#ifndef OCC_OVERLAP_H
#define OCC_OVERLAP_H

#include <occlude/scene.h>

// A box made ready for many questions. It is the closed set of points center + s0 axis[0] +
// s1 axis[1] + s2 axis[2] with every |s| <= 1.
typedef struct occ_ready_box {
    occ_box box;
    double inverse[3][3]; // leads from a point relative to the center to its s0, s1, s2
    double error;         // of them, for each unit of the largest coordinate that is led there
    int along[3];         // the coordinate that a pair of faces is perpendicular to, or -1
    bool flat;            // it has no volume, exactly
} occ_ready_box;

// How a triangle and a box meet.
typedef enum occ_contact {
    OCC_APART = 0,    // they have no point in common
    OCC_TOUCHING = 1, // only points of the box's surface; of a flat box, any points
    OCC_ENTERING = 2  // points of the box's interior too
} occ_contact;

void occ_ready_box_make(const occ_box *box, occ_ready_box *ready);

// Whether the box, its surface included, holds a point of three floats.
bool occ_ready_box_holds(const occ_ready_box *ready, const float *point);

// How a triangle with these corners meets the box. It may be a segment or a point.
occ_contact occ_ready_box_meets(const occ_ready_box *ready, const float *const corner[3]);

// Whether that is OCC_ENTERING: a quicker question where much touches.
bool occ_ready_box_entered(const occ_ready_box *ready, const float *const corner[3]);

#endif
