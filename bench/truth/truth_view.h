// SPDX-License-Identifier: Apache-2.0
/// @file
/// A camera for the sampling oracle, in double and relative to its eye: its frustum, and a ray
/// through every sample. The frustum is what the library is given: the rows of the matrix that
/// obs_view_projection() rounds to floats, with the eye at the frame's own `eye`.
///
/// A ray's parameter t is the depth of its point: clip w for a perspective camera, the distance
/// from the near plane in units of the ray's direction for an orthographic one.
#ifndef OCC_BENCH_TRUTH_VIEW_H
#define OCC_BENCH_TRUTH_VIEW_H

#include "obs.h"

enum { TRUTH_PLANES = 6, TRUTH_NEAR = 4 };

/// Points and directions are three doubles; where one depends on the sample, its constant part and
/// its parts along x and y of the viewport's [-1, 1].
typedef struct truth_view {
    double eye[3];                 ///< World point that all others are relative to.
    double plane[TRUTH_PLANES][4]; ///< Left, right, bottom, top, near, far: inside is not negative.
    bool has_plane[TRUTH_PLANES];  ///< False for an infinite far plane.
    double origin[3][3], direction[3][3]; ///< [constant, x, y] of rays.
    double row[3][4];                     ///< Of a point and 1: x, y, and what divides both.
    double depth[4];                      ///< Of a point and 1: its ray's parameter.
    double near_corner[4][3];
    int width, height; ///< Samples.
} truth_view;

/// False if the matrix has no eye, or no direction of view.
bool truth_view_make(truth_view *view, const obs_frame *frame, int width, int height);

/// The part of a ray that is in the frustum, or one with *low > *high if none is.
void truth_clip_ray(const truth_view *view, const double origin[3], const double direction[3],
                    double *low, double *high);

/// Where a sample's coordinate is in the viewport.
static inline double truth_at(int sample, int count)
{
    return (2.0 * sample + 1.0) / count - 1.0;
}

static inline double truth_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void truth_cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/// The value of four coefficients at a point.
static inline double truth_value(const double plane[4], const double point[3])
{
    return truth_dot(plane, point) + plane[3];
}

#endif
