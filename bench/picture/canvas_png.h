// SPDX-License-Identifier: Apache-2.0
/// @file
/// The part of canvas.h that encodes.
#ifndef OCC_BENCH_CANVAS_PNG_H
#define OCC_BENCH_CANVAS_PNG_H

#include "canvas.h"

#include <stdio.h>

/// Writes tightly packed rows as a PNG. Returns false when memory runs out; whether all was written
/// is for the stream's error flag to say.
bool canvas_encode_png(FILE *stream, int width, int height, const canvas_color *pixels);

#endif
