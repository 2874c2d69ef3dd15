// SPDX-License-Identifier: Apache-2.0
/// @file
/// A context of OpenGL 4.5 core without a window.
#ifndef OCC_BENCH_IMAGE_CONTEXT_H
#define OCC_BENCH_IMAGE_CONTEXT_H

#include <EGL/egl.h>

/// All zero is none; image_context_close() it when done.
typedef struct image_context {
    EGLDisplay display;
    EGLContext context;
} image_context;

/// Makes a context current: the first that EGL's devices give, in their order, else Mesa's without
/// a surface. Returns NULL, or what is missing.
const char *image_context_open(image_context *out);

void image_context_close(image_context *c);

#endif
