// SPDX-License-Identifier: Apache-2.0
/// @file
/// The triangles that a scene was made of, and its occluders drawn over them.
#ifndef OCC_BENCH_PICTURE_SURFACE_H
#define OCC_BENCH_PICTURE_SURFACE_H

#include "division.h"
#include "picture.h"

/// A scene's model. All zero is none; picture_surface_free() it when done.
typedef struct picture_surface {
    model model;
    division division; ///< Of the model, into the scene's objects.
    bool bounds;       ///< Draw the boxes around the visible objects too.
} picture_surface;

/// The names of the files that messages are about.
typedef struct picture_files {
    const char *scene, *model;
} picture_files;

/// The colours of opaque triangles and of sheets and boxes over them.
extern const canvas_color picture_surface_color;
extern const canvas_color picture_sheet_color;
extern const canvas_color picture_inner_color;

/// Reads the model and divides it as convert did. On failure, or if its objects are not the
/// scene's, says why and returns false.
bool picture_surface_read(picture_files files, const division_options *options,
                          const obs_scene *scene, picture_surface *out);

/// Draws the triangles that the camera sees; over them the sheets that lie in what is seen, filled
/// and outlined, and the boxes of the file, which shine through what is before them. Triangles of
/// an object that was reported hidden have that verdict's colour. Returns false when memory runs
/// out.
bool picture_draw_surface(canvas *c, canvas_rect panel, const picture_facts *facts,
                          const picture_surface *surface);

void picture_surface_free(picture_surface *surface);

#endif
