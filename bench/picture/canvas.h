// SPDX-License-Identifier: Apache-2.0
/// @file
/// A picture in memory: rectangles, convex shapes, lines and text, written as PNG.
///
/// Everything is drawn at CANVAS_FINE times the size of the file and averaged down, which is what
/// smooths edges. Coordinates are in these finer pixels, from the upper left.
#ifndef OCC_BENCH_CANVAS_H
#define OCC_BENCH_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CANVAS_FINE = 2 };

typedef struct canvas_color {
    uint8_t r, g, b;
} canvas_color;

/// A rectangle of pixels from (x, y) to before (x + width, y + height).
typedef struct canvas_rect {
    int x, y, width, height;
} canvas_rect;

/// Pixels row by row from the top. Nothing is drawn outside `clip`. canvas_free() it when done.
typedef struct canvas {
    int width, height;
    canvas_color *pixels;
    canvas_rect clip;
} canvas;

/// Makes a picture whose file has this size, all of one colour. Returns false when memory runs out.
bool canvas_create(canvas *c, int file_width, int file_height, canvas_color color);

/// The whole canvas, as a clip.
canvas_rect canvas_all(const canvas *c);

/// Mixes a colour over a pixel: `share` 0 leaves it, 1 replaces it.
void canvas_mix(canvas *c, int x, int y, canvas_color color, float share);

void canvas_fill(canvas *c, canvas_rect rect, canvas_color color);

/// A frame of this thickness inside the rectangle's edges.
void canvas_frame(canvas *c, canvas_rect rect, int thickness, canvas_color color);

/// A convex polygon of x, y pairs, either way round; pixels whose centers are inside.
void canvas_polygon(canvas *c, const double (*points)[2], int count, canvas_color color,
                    float share);

/// A straight line of this thickness.
void canvas_line(canvas *c, const double from[2], const double to[2], double thickness,
                 canvas_color color, float share);

void canvas_disc(canvas *c, double x, double y, double radius, canvas_color color);

/// One line of ASCII, its upper left corner at (x, y), capitals 7 * size pixels high. Other
/// characters show as a question mark.
void canvas_text(canvas *c, int x, int y, int size, canvas_color color, const char *text);

/// How wide canvas_text() would draw it.
int canvas_text_width(const char *text, int size);

/// Writes the file whole or not at all. On failure says why and returns false.
bool canvas_write_png(const canvas *c, const char *path);

void canvas_free(canvas *c);

#endif
