// SPDX-License-Identifier: Apache-2.0
/// @file
/// Boxes, sheets and triangles drawn from a camera into a depth buffer.
#ifndef OCC_BENCH_RASTER_H
#define OCC_BENCH_RASTER_H

#include "obs.h"

/// What a pixel shows, one entry each. RASTER_EMPTY in `face`: nothing.
typedef struct raster {
    int width, height;
    float *depth;   ///< Clip z over w: less is nearer.
    uint32_t *face; ///< 6 * the box's number + the face's (0 to 5): axis * 2 + (positive side). A
                    ///< sheet or a triangle has face 0 alone.
} raster;

#define RASTER_EMPTY UINT32_MAX

/// A camera, ready to draw with.
typedef struct raster_camera {
    double clip[16]; ///< World to clip, column-major.
    double eye[4];   ///< Homogeneous: w is 0 for an orthographic camera's direction to the eye.
} raster_camera;

raster_camera raster_camera_of(const obs_frame *frame);

/// Makes an empty raster. Returns false when memory runs out.
bool raster_create(raster *r, int width, int height);

/// Draws the faces of a box that are turned to the eye (both sides of a flat one), as far as they
/// are beyond the near plane. From inside a box nothing of it is seen.
void raster_box(raster *r, const raster_camera *camera, const occ_box *box, uint32_t number);

/// Draws a sheet from the sides from which it hides, as far as it is beyond the near plane.
void raster_sheet(raster *r, const raster_camera *camera, const occ_sheet *sheet, uint32_t number);

/// Draws a triangle from both sides, as far as it is beyond the near plane.
void raster_triangle(raster *r, const raster_camera *camera, const float *const corner[3],
                     uint32_t number);

/// Whether a face ends at a pixel, or less than `reach` pixels beside it: on each side of where it
/// ends so many are edge.
bool raster_is_edge(const raster *r, int x, int y, int reach);

void raster_free(raster *r);

#endif
