// SPDX-License-Identifier: Apache-2.0
/// @file
/// Pictures of a model's triangles by OpenGL 4.5, without a window.
///
/// A picture has two numbers to a pixel. `front` is 1 + the place (image_parts.h) of the opaque
/// triangle that is seen there, or 0; `veil` is a number made of all the see-through triangles
/// before it, whatever their order, or 0. So any triangle that shows makes a difference.
#ifndef OCC_BENCH_IMAGE_GL_H
#define OCC_BENCH_IMAGE_GL_H

#include "image_parts.h"

/// The one context of this thread, with the model on its device.
typedef struct image_gl image_gl;

/// How pictures are made.
typedef struct image_gl_options {
    uint32_t width, height;
    bool one_sided; ///< Triangles are seen from where their corners run counterclockwise only.
} image_gl_options;

/// Takes the first device of EGL that has OpenGL 4.5. On failure says why on standard error and
/// returns NULL.
image_gl *image_gl_open(const image_parts *parts, const image_gl_options *options);

void image_gl_close(image_gl *gl);

/// Who draws, as it calls itself.
const char *image_gl_renderer(const image_gl *gl);

/// What a picture took.
typedef struct image_pass {
    uint32_t draws, triangles;
    double cpu_ms;   ///< To say what is to be drawn.
    double gpu_ms;   ///< To draw it, by OpenGL's own clock. Mesa's software says too little here.
    double whole_ms; ///< From the first word until all is drawn.
} image_pass;

/// Draws these objects, in ascending order, one draw call each and one more where an object has
/// see-through triangles too. `clip` is image_camera_of()'s. On failure says why and returns false.
bool image_gl_draw(image_gl *gl, const double clip[16], const uint32_t *objects, size_t count,
                   image_pass *pass);

/// Copies the latest picture, rows from the bottom. On failure says why and returns false.
bool image_gl_read(image_gl *gl, uint32_t *front, uint32_t *veil);

/// Where an object's see-through triangles show in the latest picture, or would, alone: its veil is
/// not 0 there. What image_gl_read() gives afterwards is no longer that picture.
bool image_gl_veil(image_gl *gl, uint32_t object, uint32_t *veil);

#endif
