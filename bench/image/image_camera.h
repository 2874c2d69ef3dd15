// SPDX-License-Identifier: Apache-2.0
/// @file
/// The camera of a frame as a picture is drawn with it.
#ifndef OCC_BENCH_IMAGE_CAMERA_H
#define OCC_BENCH_IMAGE_CAMERA_H

#include "obs.h"

/// World to clip in double, column-major: the matrix that the library is given
/// (obs_view_projection), with the eye that it is given, so that the picture and the verdicts are
/// of one camera. In x, y and w it is that matrix, moved by the rounding of its last column; z is
/// as OpenGL's zero to one wants it, reversed (near is 1), in which floats tell more depths apart.
/// Returns false if the matrix is singular.
bool image_camera_of(const obs_frame *frame, double clip[16]);

#endif
