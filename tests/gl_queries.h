// SPDX-License-Identifier: Apache-2.0
// Occlusion queries of OpenGL without a window: occluders are drawn into depth buffers, objects are
// drawn against them, and the samples that pass are counted. Since an object is not hidden by its
// own occluders there are two depths: the nearest, and the nearest of another owner.
// Nothing here is shared with the library.
// OpenGL may start threads: open it in a test, never before Check forks.
#ifndef OCC_TEST_GL_QUERIES_H
#define OCC_TEST_GL_QUERIES_H

#include "gl_boxes.h"

#include <stddef.h>

typedef struct gl_queries gl_queries;

// 0 if OpenGL 4.5 can be had; otherwise says so and returns what main is to return: 77, or 1 where
// OCC_REQUIRE_GL=1 or CI is set. The look happens in a process of its own.
int glq_skip(void);

// A framebuffer for frusta of up to so many pixels. Fails the test if there is none.
gl_queries *glq_open(int width, int height);
void glq_close(gl_queries *q);

// Who draws: the name of the OpenGL implementation.
const char *glq_renderer(const gl_queries *q);

// A camera whose frustum fills so many pixels.
glb_camera glq_camera(const gl_queries *q, const occ_camera_desc *desc, int width, int height);

// A rectangle of pixels, in those of glb_project().
typedef struct glq_rect {
    int x, y, width, height;
} glq_rect;

// The frustum, less so many pixels at each of its sides.
glq_rect glq_frustum(const glb_camera *camera, int inset);

// Takes these occluders, and no others, as far as the rectangle goes. owners[i] is the number of
// the object that is not hidden by box i, or GLQ_NOBODY; NULL: all are nobody's.
#define GLQ_NOBODY UINT32_MAX
void glq_occlude(gl_queries *q, const glb_camera *camera, const glq_rect *rect,
                 const occ_box *boxes, const uint32_t *owners, size_t count, glb_manner manner);

// For each box, the samples of the rectangle where it is nearer than what glq_occlude() took.
// numbers[i] is the number of box i among owners; NULL: i.
void glq_count(gl_queries *q, const glb_camera *camera, const glq_rect *rect, const occ_box *boxes,
               const uint32_t *numbers, size_t count, glb_manner manner, uint32_t *samples);

#endif
