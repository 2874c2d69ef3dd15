// SPDX-License-Identifier: Apache-2.0
#include "image_compare.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool image_pixels_create(image_pixels *p, uint32_t width, uint32_t height)
{
    size_t count = (size_t)width * height + 1;
    *p = (image_pixels){width, height, calloc(count, sizeof *p->front),
                        calloc(count, sizeof *p->veil)};
    if (p->front && p->veil) return true;
    image_pixels_free(p);
    return false;
}

void image_pixels_free(image_pixels *p)
{
    free(p->front);
    free(p->veil);
    *p = (image_pixels){0};
}

// All that a comparison needs.
typedef struct comparison {
    const image_pixels *full, *culled;
    const image_parts *parts;
    const bool *is_drawn;
    image_missing *missing; // one for each object
    bool *is_named;         // one for each pixel
    uint32_t *veil;         // of one object
} comparison;

static bool out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

static size_t pixel_count(const comparison *c)
{
    return (size_t)c->full->width * c->full->height;
}

static void blame(comparison *c, uint32_t object, size_t pixel, uint32_t triangle)
{
    image_missing *m = &c->missing[object];
    uint32_t x = (uint32_t)(pixel % c->full->width), row = (uint32_t)(pixel / c->full->width);
    uint32_t y = c->full->height - 1 - row;
    c->is_named[pixel] = true;
    bool is_first = m->pixels++ == 0 || y < m->y || (y == m->y && x < m->x);
    if (!is_first) return;
    m->x = x;
    m->y = y;
    m->triangle = triangle;
}

// The opaque triangle of the first picture, if its object was left out of the second one. Of two
// that are in both pictures the same one wins.
static void blame_fronts(comparison *c)
{
    for (size_t i = 0; i < pixel_count(c); i++) {
        uint32_t front = c->full->front[i];
        if (front == 0 || front == c->culled->front[i]) continue;
        uint32_t object = image_parts_object(c->parts, front - 1);
        if (!c->is_drawn[object]) blame(c, object, i, c->parts->triangles[front - 1]);
    }
}

// Every object left out whose see-through triangles show where the second picture lacks some.
static bool blame_veils(comparison *c, image_veil_probe *probe, void *state)
{
    const image_parts *p = c->parts;
    if (memcmp(c->full->veil, c->culled->veil, pixel_count(c) * sizeof *c->full->veil) == 0)
        return true;
    for (uint32_t object = 0; object < p->object_count; object++) {
        if (c->is_drawn[object] || p->see_through[object] == p->first[object + 1]) continue;
        if (!probe(state, object, c->veil)) return false;
        for (size_t i = 0; i < pixel_count(c); i++)
            if (c->veil[i] != 0 && c->full->front[i] == c->culled->front[i] &&
                c->full->veil[i] != c->culled->veil[i])
                blame(c, object, i, UINT32_MAX);
    }
    return true;
}

static void gather(const comparison *c, image_difference *out)
{
    for (size_t i = 0; i < pixel_count(c); i++) {
        bool same =
            c->full->front[i] == c->culled->front[i] && c->full->veil[i] == c->culled->veil[i];
        out->pixels += !same;
        out->unnamed += !same && !c->is_named[i];
    }
    for (uint32_t i = 0; i < c->parts->object_count; i++) {
        if (c->missing[i].pixels == 0) continue;
        out->missing[out->count] = c->missing[i];
        out->missing[out->count++].object = i;
    }
}

bool image_compare(const image_pixels *full, const image_pixels *culled, const image_parts *parts,
                   const bool *is_drawn, image_veil_probe *probe, void *state,
                   image_difference *out)
{
    *out = (image_difference){0};
    comparison c = {.full = full, .culled = culled, .parts = parts, .is_drawn = is_drawn};
    size_t count = pixel_count(&c), bytes = count * sizeof *full->front;
    if (memcmp(full->front, culled->front, bytes) == 0 &&
        memcmp(full->veil, culled->veil, bytes) == 0)
        return true;
    out->missing = calloc((size_t)parts->object_count + 1, sizeof *out->missing);
    c.missing = out->missing;
    c.is_named = calloc(count + 1, sizeof *c.is_named);
    c.veil = malloc(bytes + 1);
    bool good = (c.missing && c.is_named && c.veil) || out_of_memory();
    if (good) blame_fronts(&c);
    good = good && blame_veils(&c, probe, state);
    if (good) gather(&c, out);
    free(c.is_named);
    free(c.veil);
    if (!good) image_difference_free(out);
    return good;
}

void image_difference_free(image_difference *d)
{
    free(d->missing);
    *d = (image_difference){0};
}
