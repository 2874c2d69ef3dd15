// SPDX-License-Identifier: Apache-2.0
// Boxes as triangles for OpenGL, so that all its roundings stay within a stated tolerance, on
// whichever side is asked for.
//
// What is assumed of OpenGL: it divides, scales to pixels and interpolates depth in float, snaps
// corners to a grid of GL_SUBPIXEL_BITS, covers a pixel if its center is inside the snapped
// triangle, and counts those that pass the depth test. The rest is kept from it: polygons are cut
// here in double, to a little more than the frustum, so that its clipper has nothing to do, and
// depth runs from 1 (near) to 0 (far), where floats are densest.
//
// The tolerance, in pixels, is how far a corner may be from where it belongs: one and a half steps
// of the grid and 16 roundings of the largest coordinate. A pixel that is covered has a point of
// the triangle within three tolerances, with the depth that OpenGL finds at the pixel's center to
// within four tolerances of slope and the roundings of interpolation. A GENEROUS triangle is
// brought nearer by twice that, a SPARING one is moved away. Where a triangle is so thin that its
// slope may be off by more than half, it lies in the near plane, or is left out.
#ifndef OCC_TEST_GL_BOXES_H
#define OCC_TEST_GL_BOXES_H

#include <occlude/cull.h>

// What a box is grown by, in tolerances, so that OpenGL finds it at every pixel within three of
// them from what the box itself covers. Four would do.
#define GLB_MARGIN 6.0

// Pixels around the frustum's own, so that nothing is cut where it would be seen.
enum { GLB_BORDER = 8 };

// A camera, and the pixels that its frustum fills.
typedef struct glb_camera {
    double row[4][4];  // of a world point and 1: x, y, reversed depth, w
    double eye[4];     // (x, y, z, 1), or a direction and 0
    double lateral[2]; // the least world distance that moves x, y by w
    double pixels[2];
    double shift[2]; // in pixels
    double tolerance;
} glb_camera;

// Fills pixels, and so the tolerance, for an OpenGL with that many bits below a pixel.
glb_camera glb_camera_of(const occ_camera_desc *desc, int width, int height, int subpixel_bits);

// In pixels from the lower left corner of the framebuffer, shift and border included.
void glb_project(const glb_camera *camera, const double point[3], double out[2]);

// The box with everything added that is within so many pixels of it, and as much towards the eye;
// or, for a negative number, without whatever is so close to its outline. False if it has no area,
// if nothing would be left, or if it is a sheet seen too much from its edge to be made smaller.
bool glb_grow(const glb_camera *camera, const occ_box *box, double pixels, occ_box *out);

// Whether the box comes too close to the eye to be drawn closed.
bool glb_is_open(const glb_camera *camera, const occ_box *box);

// Whether the near plane cuts the box open where that can be seen.
bool glb_is_cut_by_near(const glb_camera *camera, const occ_box *box);

typedef enum glb_manner { GLB_SPARING, GLB_GENEROUS } glb_manner;

typedef struct glb_vertex {
    float x, y, z, w; // clip coordinates
} glb_vertex;

// Of six faces two halves, each with up to eleven corners.
enum { GLB_MOST_VERTICES = 6 * 2 * 9 * 3 };

// Writes the vertices of the box's triangles and returns their number. A sparing box ends at the
// near and far planes and is open there; the part of a generous one that is before the near plane
// lies in it.
int glb_triangles(const glb_camera *camera, const occ_box *box, glb_manner manner,
                  glb_vertex out[GLB_MOST_VERTICES]);

#endif
