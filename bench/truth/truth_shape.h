// SPDX-License-Identifier: Apache-2.0
/// @file
/// Boxes and triangles as the sampling oracle sees them: what part of the frustum they touch, faces
/// cut to the frustum, and solids that a ray can be tested against.
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

/// The same of the triangle between three corners relative to the eye.
bool truth_outline_triangle(const truth_view *view, double corner[3][3], truth_outline *outline);

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

/// What a ray meets of a solid.
typedef enum truth_kind {
    TRUTH_SLABS,    ///< A parallelepiped, or a parallelogram (extent[2] is 0).
    TRUTH_TRIANGLE, ///< From both sides.
    TRUTH_FRONT     ///< A triangle, from where its corners go counterclockwise.
} truth_kind;

/// Slabs: the points whose offsets from `center`, times `inverse`, are within ±extent. A triangle:
/// a ray passes between the lines through two corners each, to the same side of all three. Of two
/// triangles with an edge in common one meets any ray through it, since the same numbers tell, with
/// opposite signs: no light gets through a seam.
typedef struct truth_solid {
    double center[3]; ///< Relative to the eye, as `corner`.
    union {
        struct {
            double inverse[3][3], extent[3]; ///< Slabs.
        };
        struct {
            double corner[3][3], normal[3]; ///< A triangle.
        };
    };
    double half[3]; ///< Of its bounds along x, y and z.
    truth_kind kind;
    uint32_t owner; ///< Index of an object.
    truth_outline outline;
} truth_solid;

enum { TRUTH_MAX_SOLIDS = 3 };

/// Splits a box into solids that no ray meets twice: one for most, up to three parallelograms if
/// the three axes lie in a plane, none if the box has no area or is seen edge-on. Leaves `owner`
/// and `outline` unset.
int truth_solids_of(const truth_view *view, const occ_box *box,
                    truth_solid solids[TRUTH_MAX_SOLIDS]);

/// Triangle `t` (0 to corner_count - 3) of a sheet's fan. False where it has no area or is seen
/// edge-on. Leaves `owner` and `outline` unset.
bool truth_triangle_of(const truth_view *view, const occ_sheet *sheet, uint32_t t,
                       truth_solid *solid);

/// On which side of edge k of a triangle a ray passes: positive where the edge goes around it
/// counterclockwise for who looks along the ray. Exactly the opposite for the edge turned round.
double truth_pass(const truth_solid *solid, int k, const double origin[3],
                  const double direction[3]);

/// What moving the origin of a ray takes from that.
double truth_aside(const truth_solid *solid, int k, const double origin[3],
                   const double direction[3]);

/// Where a ray enters a solid. Infinity if it misses it, or enters outside of low to high.
double truth_enter(const truth_solid *solid, const double origin[3], const double direction[3],
                   double low, double high);

#endif
