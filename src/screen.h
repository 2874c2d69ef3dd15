// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SCREEN_H
#define OCC_SCREEN_H

// How points relative to the eye come to the screen: u = (row[0].p) / (row[2].p + w), v likewise.
typedef struct occ_screen {
    float row[3][3];
    float w;     // 0, unless the camera is orthographic
    float least; // the least divisor, as a share of |p|, with which u and v are exact enough
} occ_screen;

// The corners of a box, relative to the eye, and where they and the center are on the screen: u and
// v are normalised device coordinates, or NaN where a point is not clearly in front of the eye.
typedef struct occ_projection {
    float x[8], y[8], z[8];
    float u[9], v[9];     // the center is the last
    float min[2], max[2]; // bounds of u and v; infinite if any is NaN
} occ_projection;

#endif
