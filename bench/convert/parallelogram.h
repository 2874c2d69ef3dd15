// SPDX-License-Identifier: Apache-2.0
/// @file
/// A large parallelogram inside a flat convex polygon, proven to be inside without rounding.
#ifndef OCC_BENCH_PARALLELOGRAM_H
#define OCC_BENCH_PARALLELOGRAM_H

#include <occlude/scene.h>

/// Whether the four points are exactly in one plane and, in this order, the corners of a convex
/// polygon with area on both sides of its diagonal 0-2.
bool quad_is_flat_and_convex(const float *const corner[4]);

/// Puts a parallelogram into such a quad: a box whose third axis is zero. Its corners
/// center ± axis[0] ± axis[1], as real numbers, are in the quad's plane and in the quad. Returns
/// its area, or 0 if no floats were found that fit exactly.
double quad_fit_parallelogram(const float *const corner[4], occ_box *box);

#endif
