// SPDX-License-Identifier: Apache-2.0
/// @file
/// Boxes as the sampling oracle sees them: what part of the frustum they touch, their faces cut to
/// the frustum, and solids that a ray can be tested against.
#ifndef OCC_BENCH_TRUTH_SHAPE_H
#define OCC_BENCH_TRUTH_SHAPE_H

#include "truth_view.h"

/// Samples from (x0, y0) up to but not including (x1, y1).
typedef struct truth_rect {
    int x0, y0, x1, y1;
} truth_rect;

/// What a box touches of the frustum.
typedef struct truth_outline {
    truth_rect rect; ///< No sample outside of it has the box on its ray.
    double depth;    ///< No point of the box is nearer.
} truth_outline;

/// False if no point of the box is in the frustum, `outline` is unset then.
bool truth_outline_box(const truth_view *view, const occ_box *box, truth_outline *outline);

enum { TRUTH_MAX_CORNERS = 4 + TRUTH_PLANES };

/// A convex polygon, corners relative to the eye.
typedef struct truth_polygon {
    int count;
    double corner[TRUTH_MAX_CORNERS][3];
} truth_polygon;

/// Face `face` (0 to 5: axis face / 2, the side of -axis or +axis), cut to the frustum. Nothing is
/// left of one outside.
void truth_face(const truth_view *view, const occ_box *box, int face, truth_polygon *polygon);

/// Whether a face looks towards the eye. Always true where a box is flat.
bool truth_face_is_seen(const truth_view *view, const occ_box *box, int face);

/// A parallelepiped, or a parallelogram (extent[2] is 0): the points whose offsets from `center`,
/// times `inverse`, are within ±extent.
typedef struct truth_solid {
    double center[3]; ///< Relative to the eye.
    double inverse[3][3], extent[3];
    double half[3]; ///< Of its bounds along x, y and z.
    uint32_t owner; ///< Index of an object.
    truth_outline outline;
} truth_solid;

enum { TRUTH_MAX_SOLIDS = 3 };

/// Splits a box into solids that no ray meets twice: one for most, up to three parallelograms if
/// the three axes lie in a plane, none if the box has no area or is seen edge-on. Leaves `owner`
/// and `outline` unset.
int truth_solids_of(const truth_view *view, const occ_box *box,
                    truth_solid solids[TRUTH_MAX_SOLIDS]);

/// Where a ray enters a solid. Infinity if it misses it, or enters outside of low to high.
double truth_enter(const truth_solid *solid, const double origin[3], const double direction[3],
                   double low, double high);

#endif
