// SPDX-License-Identifier: Apache-2.0
// A small oriented box around points: which points matter, how the box should be turned, and floats
// that hold all of them.
#ifndef OCC_FIT_H
#define OCC_FIT_H

#include "memory.h"
#include "soup/overlap.h"

#include <occlude/soup.h>

// Points in the caller's memory, in a row or picked by indices. Coordinates are good.
typedef struct occ_points {
    const float *positions;
    size_t stride; // bytes
    size_t count;
    const uint32_t *indices; // or NULL
} occ_points;

static inline const float *occ_points_at(const occ_points *points, size_t i)
{
    if (points->indices) i = points->indices[i];
    const char *first = (const char *)points->positions;
    return (const float *)(const void *)(first + i * points->stride);
}

// Three directions of length 1 at right angles, as good as doubles are.
typedef struct occ_frame3 {
    double axis[3][3];
} occ_frame3;

// --- points that matter --------------------------------------------------------------------------

enum { OCC_FIT_DIRECTIONS = 49, OCC_FIT_POINTS = 2 * OCC_FIT_DIRECTIONS + 48 };

// Points that are extreme in some direction, relative to `origin`.
typedef struct occ_sample {
    double origin[3];
    float min[3], max[3]; // of all points
    double grain; // what a side is taken to be longer than it is, so that flat boxes compare
    int count;
    double at[OCC_FIT_POINTS][3];
} occ_sample;

void occ_sample_take(const occ_points *points, occ_sample *sample);

// Where all points lie along a frame's axes, relative to the sample's origin.
typedef struct occ_extent {
    double low[3], high[3];
} occ_extent;

// Adds to the sample the points that are extreme along the frame. False if it had points as far, or
// has no room.
bool occ_sample_extend(const occ_points *points, const occ_frame3 *frame, occ_sample *sample,
                       occ_extent *extent);

// --- directions ----------------------------------------------------------------------------------

// Finds a frame in which the sample's box is small.
void occ_fit_frame(const occ_sample *sample, occ_frame3 *frame);

// How large a box of these sides is, for comparing.
static inline double occ_fit_measure(const occ_sample *sample, const double side[3])
{
    return (side[0] + sample->grain) * (side[1] + sample->grain) * (side[2] + sample->grain);
}

// --- floats --------------------------------------------------------------------------------------

// The box of the frame's directions, as nearly as floats allow, that holds all points exactly.
// False if none was found: the frame is too close to the limits of floats.
bool occ_fit_hold(const occ_points *points, const occ_sample *sample, const occ_frame3 *frame,
                  const occ_extent *extent, occ_box *box);

// The length of a box's sides.
void occ_fit_sides(const occ_box *box, double side[3]);

// --- all of it -----------------------------------------------------------------------------------

// A small box around points, turned as is best, or as `given` says; or along the axes, where that
// is as small.
occ_result occ_fit_points(const occ_points *points, const occ_frame3 *given,
                          const occ_soup_work *work, const occ_hooks *hooks, occ_box *box);

#endif
