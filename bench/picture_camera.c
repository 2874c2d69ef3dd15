// SPDX-License-Identifier: Apache-2.0
// Two layers, each with its own depth: what is visible with the occluders in it, and over it, pale,
// what is hidden. Lines are drawn where neighbouring pixels show different faces.
#include "picture.h"

#include "raster.h"

#include <math.h>

typedef struct layers {
    canvas *c;
    canvas_rect panel;
    const picture_facts *facts;
    raster visible, occluders, hidden;
} layers;

// From how bright a face is by its axis and side: tops are lightest.
static canvas_color shade(canvas_color color, uint32_t face)
{
    static const float light[6] = {0.80f, 0.90f, 0.70f, 1.12f, 0.86f, 0.96f};
    float share = light[face % 6];
    float rgb[3] = {(float)color.r * share, (float)color.g * share, (float)color.b * share};
    return (canvas_color){(uint8_t)fminf(rgb[0], 255), (uint8_t)fminf(rgb[1], 255),
                          (uint8_t)fminf(rgb[2], 255)};
}

static bool is_edge(const raster *r, int x, int y)
{
    size_t i = (size_t)y * (size_t)r->width + (size_t)x;
    if (x + 1 < r->width && r->face[i] != r->face[i + 1]) return true;
    return y + 1 < r->height && r->face[i] != r->face[i + (size_t)r->width];
}

static void paint(layers *l, const raster *r, int x, int y, canvas_color color, float fill,
                  float line)
{
    size_t i = (size_t)y * (size_t)r->width + (size_t)x;
    int cx = l->panel.x + x, cy = l->panel.y + y;
    if (r->face[i] != RASTER_EMPTY) canvas_mix(l->c, cx, cy, shade(color, r->face[i]), fill);
    if (!is_edge(r, x, y)) return;
    canvas_color dark = {(uint8_t)(color.r / 2), (uint8_t)(color.g / 2), (uint8_t)(color.b / 2)};
    canvas_mix(l->c, cx, cy, dark, line);
}

// An occluder lies within its owner's box: there it shows through, elsewhere only in front.
static bool occluder_shows(const layers *l, size_t i)
{
    uint32_t face = l->occluders.face[i], object = l->visible.face[i];
    if (face == RASTER_EMPTY) return false;
    if (object == RASTER_EMPTY) return true;
    uint32_t owner = l->facts->scene->occluders[face / 6].owner;
    return owner == object / 6 || l->occluders.depth[i] <= l->visible.depth[i];
}

static void compose(layers *l)
{
    for (int y = 0; y < l->panel.height; y++)
        for (int x = 0; x < l->panel.width; x++) {
            size_t i = (size_t)y * (size_t)l->panel.width + (size_t)x;
            paint(l, &l->visible, x, y, picture_colors[PICTURE_VISIBLE], 1, 0.6f);
            if (occluder_shows(l, i))
                paint(l, &l->occluders, x, y, picture_occluder_color, 0.75f, 0.6f);
            paint(l, &l->hidden, x, y, picture_colors[PICTURE_HIDDEN], 0.22f, 0.55f);
        }
}

static void draw_boxes(layers *l)
{
    const obs_scene *scene = l->facts->scene;
    raster_camera camera = raster_camera_of(l->facts->frame);
    for (uint32_t i = 0; i < scene->object_count; i++) {
        if (l->facts->verdicts[i] == PICTURE_OUTSIDE) continue;
        bool hidden = l->facts->verdicts[i] == PICTURE_HIDDEN;
        raster_box(hidden ? &l->hidden : &l->visible, &camera, &scene->objects[i], i);
    }
    for (size_t i = 0; i < l->facts->used_count; i++) {
        uint32_t place = l->facts->used[i];
        raster_box(&l->occluders, &camera, &scene->occluders[place].box, place);
    }
}

// Sky to horizon, so that empty pixels do not read as a surface.
static void fill_background(canvas *c, canvas_rect panel)
{
    for (int y = 0; y < panel.height; y++) {
        int tone = 236 + 16 * y / panel.height;
        canvas_color color = {(uint8_t)(tone - 4), (uint8_t)(tone - 1), (uint8_t)tone};
        canvas_fill(c, (canvas_rect){panel.x, panel.y + y, panel.width, 1}, color);
    }
}

bool picture_draw_camera(canvas *c, canvas_rect panel, const picture_facts *facts)
{
    layers l = {.c = c, .panel = panel, .facts = facts};
    bool good = raster_create(&l.visible, panel.width, panel.height) &&
                raster_create(&l.occluders, panel.width, panel.height) &&
                raster_create(&l.hidden, panel.width, panel.height);
    if (good) {
        fill_background(c, panel);
        draw_boxes(&l);
        compose(&l);
    }
    raster_free(&l.visible);
    raster_free(&l.occluders);
    raster_free(&l.hidden);
    return good;
}
