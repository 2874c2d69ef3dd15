// SPDX-License-Identifier: Apache-2.0
#include "canvas.h"

#include "canvas_png.h"
#include "outfile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool canvas_create(canvas *c, int file_width, int file_height, canvas_color color)
{
    *c = (canvas){.width = file_width * CANVAS_FINE, .height = file_height * CANVAS_FINE};
    c->clip = canvas_all(c);
    c->pixels = malloc((size_t)c->width * (size_t)c->height * sizeof *c->pixels);
    if (c->pixels) canvas_fill(c, c->clip, color);
    return c->pixels != NULL;
}

canvas_rect canvas_all(const canvas *c)
{
    return (canvas_rect){0, 0, c->width, c->height};
}

static uint8_t mix(uint8_t old, uint8_t new, float share)
{
    return (uint8_t)((float)old + ((float)new - (float)old) * share + 0.5f);
}

static bool in_clip(const canvas *c, int x, int y)
{
    const canvas_rect *r = &c->clip;
    return x >= r->x && y >= r->y && x < r->x + r->width && y < r->y + r->height;
}

void canvas_mix(canvas *c, int x, int y, canvas_color color, float share)
{
    if (!in_clip(c, x, y)) return;
    canvas_color *p = &c->pixels[(size_t)y * (size_t)c->width + (size_t)x];
    p->r = mix(p->r, color.r, share);
    p->g = mix(p->g, color.g, share);
    p->b = mix(p->b, color.b, share);
}

void canvas_fill(canvas *c, canvas_rect rect, canvas_color color)
{
    for (int y = rect.y; y < rect.y + rect.height; y++)
        for (int x = rect.x; x < rect.x + rect.width; x++)
            if (in_clip(c, x, y)) c->pixels[(size_t)y * (size_t)c->width + (size_t)x] = color;
}

void canvas_frame(canvas *c, canvas_rect r, int thickness, canvas_color color)
{
    canvas_fill(c, (canvas_rect){r.x, r.y, r.width, thickness}, color);
    canvas_fill(c, (canvas_rect){r.x, r.y + r.height - thickness, r.width, thickness}, color);
    canvas_fill(c, (canvas_rect){r.x, r.y, thickness, r.height}, color);
    canvas_fill(c, (canvas_rect){r.x + r.width - thickness, r.y, thickness, r.height}, color);
}

static int clamp_to(double value, int least, int most)
{
    return value < least ? least : value > most ? most : (int)value;
}

// The x range of a convex polygon on the line through a row's centers.
static bool row_span(const double (*points)[2], int count, double y, double *left, double *right)
{
    *left = INFINITY;
    *right = -INFINITY;
    for (int i = 0; i < count; i++) {
        const double *a = points[i], *b = points[(i + 1) % count];
        if ((a[1] <= y) == (b[1] <= y)) continue;
        double x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        *left = fmin(*left, x);
        *right = fmax(*right, x);
    }
    return *left <= *right;
}

void canvas_polygon(canvas *c, const double (*points)[2], int count, canvas_color color,
                    float share)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < count; i++) {
        low = fmin(low, points[i][1]);
        high = fmax(high, points[i][1]);
    }
    int first = clamp_to(ceil(low - 0.5), c->clip.y, c->clip.y + c->clip.height);
    int last = clamp_to(floor(high - 0.5), c->clip.y - 1, c->clip.y + c->clip.height - 1);
    for (int y = first; y <= last; y++) {
        double left, right;
        if (!row_span(points, count, y + 0.5, &left, &right)) continue;
        int from = clamp_to(ceil(left - 0.5), c->clip.x, c->clip.x + c->clip.width);
        int to = clamp_to(floor(right - 0.5), c->clip.x - 1, c->clip.x + c->clip.width - 1);
        for (int x = from; x <= to; x++)
            canvas_mix(c, x, y, color, share);
    }
}

void canvas_line(canvas *c, const double from[2], const double to[2], double thickness,
                 canvas_color color, float share)
{
    double d[2] = {to[0] - from[0], to[1] - from[1]};
    double length = sqrt(d[0] * d[0] + d[1] * d[1]), half = thickness / 2;
    if (length < 1e-9) {
        d[0] = length = 1;
        d[1] = 0;
    }
    double along[2] = {d[0] / length * half, d[1] / length * half};
    double across[2] = {-along[1], along[0]};
    const double corners[4][2] = {{from[0] - along[0] + across[0], from[1] - along[1] + across[1]},
                                  {to[0] + along[0] + across[0], to[1] + along[1] + across[1]},
                                  {to[0] + along[0] - across[0], to[1] + along[1] - across[1]},
                                  {from[0] - along[0] - across[0], from[1] - along[1] - across[1]}};
    canvas_polygon(c, corners, 4, color, share);
}

void canvas_disc(canvas *c, double x, double y, double radius, canvas_color color)
{
    for (int j = (int)floor(y - radius); j <= (int)ceil(y + radius); j++)
        for (int i = (int)floor(x - radius); i <= (int)ceil(x + radius); i++) {
            double dx = i + 0.5 - x, dy = j + 0.5 - y;
            if (dx * dx + dy * dy <= radius * radius) canvas_mix(c, i, j, color, 1);
        }
}

static canvas_color average(const canvas *c, int x, int y)
{
    unsigned sum[3] = {0, 0, 0};
    for (int j = 0; j < CANVAS_FINE; j++)
        for (int i = 0; i < CANVAS_FINE; i++) {
            size_t row = (size_t)(y * CANVAS_FINE + j) * (size_t)c->width;
            const canvas_color *p = &c->pixels[row + (size_t)(x * CANVAS_FINE + i)];
            sum[0] += p->r;
            sum[1] += p->g;
            sum[2] += p->b;
        }
    const unsigned count = CANVAS_FINE * CANVAS_FINE;
    return (canvas_color){(uint8_t)((sum[0] + count / 2) / count),
                          (uint8_t)((sum[1] + count / 2) / count),
                          (uint8_t)((sum[2] + count / 2) / count)};
}

bool canvas_write_png(const canvas *c, const char *path)
{
    int width = c->width / CANVAS_FINE, height = c->height / CANVAS_FINE;
    outfile file;
    canvas_color *pixels = malloc((size_t)width * (size_t)height * sizeof *pixels);
    if (!pixels) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            pixels[(size_t)y * (size_t)width + (size_t)x] = average(c, x, y);
    bool good = outfile_open(&file, path);
    if (good) {
        good = canvas_encode_png(file.stream, width, height, pixels);
        if (good)
            good = outfile_commit(&file);
        else
            outfile_abandon(&file);
    }
    free(pixels);
    return good;
}

void canvas_free(canvas *c)
{
    free(c->pixels);
    *c = (canvas){0};
}
