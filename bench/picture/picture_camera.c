// SPDX-License-Identifier: Apache-2.0
// Layers, each with its own depth: what is visible, the occluders in it, and over both, striped,
// what is hidden; or of what is hidden the explained object alone, and under it the occluders that
// hide it. Lines are drawn where neighbouring pixels show different faces.
#include "picture.h"

#include "raster.h"

#include <string.h>

enum { STRIPE_PERIOD = 14, STRIPE_WIDTH = 4 };

typedef struct layer {
    raster raster;
    bool of_occluders; // else of objects
    canvas_color color, line_color;
    float fill, line; // how much of what is below they cover
    bool striped;
} layer;

typedef struct layers {
    canvas *c;
    canvas_rect panel;
    const picture_facts *facts;
    layer visible, occluders, culprits, hidden, together;
} layers;

static void copy_directions(const float *a, const float *b, float u[3], float v[3])
{
    memcpy(u, a, 3 * sizeof *u);
    memcpy(v, b, 3 * sizeof *v);
}

// Two directions in a face, as a raster names it.
static void face_directions(const layer *from, const obs_scene *scene, uint32_t face, float u[3],
                            float v[3])
{
    uint32_t number = face / 6, axis = face % 6 / 2;
    if (from->of_occluders && number >= scene->occluder_count) {
        const occ_sheet *sheet = &scene->sheets[number - scene->occluder_count].sheet;
        copy_directions(sheet->corner[1], sheet->corner[2], u, v);
        for (int k = 0; k < 3; k++) {
            u[k] -= sheet->corner[0][k];
            v[k] -= sheet->corner[0][k];
        }
        return;
    }
    const occ_box *box =
        from->of_occluders ? &scene->occluders[number].box : &scene->objects[number];
    copy_directions(box->axis[(axis + 1) % 3], box->axis[(axis + 2) % 3], u, v);
}

static void paint(layers *l, const layer *from, int x, int y)
{
    const raster *r = &from->raster;
    if (!r->face) return;
    size_t i = (size_t)y * (size_t)r->width + (size_t)x;
    int cx = l->panel.x + x, cy = l->panel.y + y;
    if (r->face[i] != RASTER_EMPTY) {
        float u[3], v[3];
        face_directions(from, l->facts->scene, r->face[i], u, v);
        canvas_color color = picture_shade(from->color, u, v);
        bool stripe = !from->striped || (x + y) % STRIPE_PERIOD < STRIPE_WIDTH;
        if (stripe) canvas_mix(l->c, cx, cy, color, from->fill);
    }
    if (raster_is_edge(r, x, y, 1)) canvas_mix(l->c, cx, cy, from->line_color, from->line);
}

// An occluder lies within its owner's box: there it shows through, elsewhere only in front of a
// box, or in its face (1 - z falls with the distance, so the slack is a thousandth of it).
static bool occluder_shows(const layers *l, size_t i)
{
    uint32_t face = l->occluders.raster.face[i], object = l->visible.raster.face[i];
    if (face == RASTER_EMPTY) return false;
    if (object == RASTER_EMPTY) return true;
    uint32_t owner = obs_occluder_owner(l->facts->scene, face / 6);
    float front = l->visible.raster.depth[i];
    return owner == object / 6 || l->occluders.raster.depth[i] <= front + 1e-3f * (1 - front);
}

static void compose(layers *l)
{
    for (int y = 0; y < l->panel.height; y++)
        for (int x = 0; x < l->panel.width; x++) {
            size_t i = (size_t)y * (size_t)l->panel.width + (size_t)x;
            paint(l, &l->visible, x, y);
            if (occluder_shows(l, i)) paint(l, &l->occluders, x, y);
            paint(l, &l->culprits, x, y);
            paint(l, &l->hidden, x, y);
            paint(l, &l->together, x, y);
        }
}

static void draw_occluder(raster *to, const raster_camera *camera, const obs_scene *scene,
                          uint32_t number)
{
    const occ_sheet *sheet = obs_occluder_sheet(scene, number);
    if (sheet)
        raster_sheet(to, camera, sheet, number);
    else
        raster_box(to, camera, &scene->occluders[number].box, number);
}

static void draw_boxes(layers *l)
{
    const obs_scene *scene = l->facts->scene;
    raster_camera camera = raster_camera_of(l->facts->frame);
    const picture_facts *facts = l->facts;
    raster *of[PICTURE_VERDICTS] = {[PICTURE_HIDDEN] = &l->hidden.raster,
                                    [PICTURE_TOGETHER] = &l->together.raster,
                                    [PICTURE_VISIBLE] = &l->visible.raster};
    for (uint32_t i = 0; i < scene->object_count; i++) {
        raster *to = of[facts->verdicts[i]];
        if (!to || (facts->explained && to != &l->visible.raster && i != facts->object)) continue;
        raster_box(to, &camera, &scene->objects[i], i);
    }
    for (size_t i = 0; i < facts->used_count; i++)
        draw_occluder(&l->occluders.raster, &camera, scene, facts->used[i]);
    for (size_t i = 0; i < facts->culprit_count; i++)
        draw_occluder(&l->culprits.raster, &camera, scene, facts->culprits[i]);
}

static layer make_layer(canvas_color color, bool shines_through)
{
    layer l = {.color = color, .line_color = picture_half(color)};
    l.striped = shines_through;
    l.fill = shines_through ? 0.8f : 1.0f;
    l.line = shines_through ? 0.9f : 0.45f;
    if (shines_through) l.line_color = color;
    return l;
}

bool picture_draw_camera(canvas *c, canvas_rect panel, const picture_facts *facts)
{
    layers l = {.c = c, .panel = panel, .facts = facts};
    int width = panel.width, height = panel.height;
    l.visible = make_layer(picture_colors[PICTURE_VISIBLE], false);
    l.occluders = make_layer(picture_occluder_color, false);
    l.occluders.of_occluders = true;
    l.occluders.fill = 0.75f;
    l.culprits = l.occluders;
    l.culprits.color = picture_culprit_color;
    l.culprits.line_color = picture_half(picture_culprit_color);
    l.hidden = make_layer(picture_colors[PICTURE_HIDDEN], true);
    l.together = make_layer(picture_colors[PICTURE_TOGETHER], true);
    bool good = raster_create(&l.visible.raster, width, height) &&
                raster_create(&l.occluders.raster, width, height) &&
                raster_create(&l.hidden.raster, width, height) &&
                (!facts->fused || raster_create(&l.together.raster, width, height)) &&
                (!facts->explained || raster_create(&l.culprits.raster, width, height));
    if (good) {
        picture_sky(c, panel);
        draw_boxes(&l);
        compose(&l);
    }
    raster_free(&l.visible.raster);
    raster_free(&l.occluders.raster);
    raster_free(&l.culprits.raster);
    raster_free(&l.hidden.raster);
    raster_free(&l.together.raster);
    return good;
}
