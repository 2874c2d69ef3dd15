// SPDX-License-Identifier: Apache-2.0
// Rasters of one camera, each with its own depth, laid over each other pixel by pixel.
#include "picture_surface.h"

#include "image_parts.h"
#include "raster.h"

// Triangles are pale, so that the occluders stand out.
const canvas_color picture_surface_color = {206, 204, 200};
const canvas_color picture_sheet_color = {38, 98, 178};
const canvas_color picture_inner_color = {240, 190, 20};

static const canvas_color glass_color = {120, 200, 224};

// Where a line lies at the edge of all that is drawn, only the half within shows.
enum { LINE_REACH = CANVAS_FINE };

typedef struct coats {
    canvas *c;
    canvas_rect panel;
    const picture_facts *facts;
    const picture_surface *surface;
    raster opaque, glass; // triangles, as the model numbers them
    raster sheets, boxes; // occluders
    raster bounds;        // objects
} coats;

bool picture_surface_read(picture_files files, const division_options *options,
                          const obs_scene *scene, picture_surface *out)
{
    *out = (picture_surface){.bounds = out->bounds};
    if (!model_read(files.model, &options->model, &out->model)) return false;
    bool good = division_make(&out->model, options, &out->division) &&
                image_parts_agree(&out->division, scene, files.scene, files.model);
    if (!good) picture_surface_free(out);
    return good;
}

static bool is_hidden(const coats *l, uint32_t triangle)
{
    uint8_t verdict = l->facts->verdicts[l->surface->division.object_of[triangle]];
    return verdict == PICTURE_HIDDEN || verdict == PICTURE_TOGETHER;
}

// Those of hidden objects come last: where triangles lie in each other, the first one stays.
static void draw_triangles(coats *l, const raster_camera *camera)
{
    const model *m = &l->surface->model;
    for (int hidden = 0; hidden < 2; hidden++)
        for (uint32_t t = 0; t < m->triangle_count; t++) {
            const float *const corner[3] = {m->positions[m->corners[t][0]],
                                            m->positions[m->corners[t][1]],
                                            m->positions[m->corners[t][2]]};
            if (is_hidden(l, t) != hidden) continue;
            raster_triangle(m->see_through[t] ? &l->glass : &l->opaque, camera, corner, t);
        }
}

static void draw_occluders(coats *l, const raster_camera *camera)
{
    const obs_scene *scene = l->facts->scene;
    for (uint32_t i = 0; i < scene->occluder_count; i++)
        raster_box(&l->boxes, camera, &scene->occluders[i].box, i);
    for (uint32_t i = 0; i < scene->sheet_count; i++)
        raster_sheet(&l->sheets, camera, &scene->sheets[i].sheet, i);
    for (uint32_t i = 0; l->surface->bounds && i < scene->object_count; i++)
        if (l->facts->verdicts[i] == PICTURE_VISIBLE)
            raster_box(&l->bounds, camera, &scene->objects[i], i);
}

// Whether what a raster shows at a pixel is not behind the opaque surface there. (1 - z falls with
// the distance, so the slack is a thousandth of it.)
static bool is_before(const coats *l, const raster *r, size_t i)
{
    float front = l->opaque.depth[i];
    if (r->face[i] == RASTER_EMPTY) return false;
    return l->opaque.face[i] == RASTER_EMPTY || r->depth[i] <= front + 1e-3f * (1 - front);
}

static canvas_color triangle_color(const coats *l, uint32_t triangle, canvas_color color)
{
    const model *m = &l->surface->model;
    const uint32_t *corner = m->corners[triangle];
    float u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = m->positions[corner[1]][k] - m->positions[corner[0]][k];
        v[k] = m->positions[corner[2]][k] - m->positions[corner[0]][k];
    }
    if (is_hidden(l, triangle))
        color = picture_colors[l->facts->verdicts[l->surface->division.object_of[triangle]]];
    return picture_shade(color, u, v);
}

static canvas_color box_color(const coats *l, uint32_t face)
{
    const occ_box *box = &l->facts->scene->occluders[face / 6].box;
    uint32_t axis = face % 6 / 2;
    return picture_shade(picture_inner_color, box->axis[(axis + 1) % 3], box->axis[(axis + 2) % 3]);
}

// A raster's colour, and a darker one for its lines.
static void lay(coats *l, const raster *r, int x, int y, canvas_color color, float fill)
{
    int cx = l->panel.x + x, cy = l->panel.y + y;
    canvas_mix(l->c, cx, cy, color, fill);
    if (raster_is_edge(r, x, y, LINE_REACH)) canvas_mix(l->c, cx, cy, picture_half(color), 0.75f);
}

static void compose_pixel(coats *l, int x, int y)
{
    size_t i = (size_t)y * (size_t)l->panel.width + (size_t)x;
    int cx = l->panel.x + x, cy = l->panel.y + y;
    if (l->opaque.face[i] != RASTER_EMPTY) {
        canvas_mix(l->c, cx, cy, triangle_color(l, l->opaque.face[i] / 6, picture_surface_color),
                   1);
        if (raster_is_edge(&l->opaque, x, y, 1)) canvas_mix(l->c, cx, cy, picture_ink, 0.15f);
    }
    if (is_before(l, &l->sheets, i)) lay(l, &l->sheets, x, y, picture_sheet_color, 0.35f);
    if (l->boxes.face[i] != RASTER_EMPTY)
        lay(l, &l->boxes, x, y, box_color(l, l->boxes.face[i]), 0.5f);
    if (is_before(l, &l->glass, i))
        canvas_mix(l->c, cx, cy, triangle_color(l, l->glass.face[i] / 6, glass_color), 0.4f);
    if (l->surface->bounds && is_before(l, &l->bounds, i) &&
        raster_is_edge(&l->bounds, x, y, LINE_REACH))
        canvas_mix(l->c, cx, cy, picture_colors[PICTURE_VISIBLE], 0.8f);
}

bool picture_draw_surface(canvas *c, canvas_rect panel, const picture_facts *facts,
                          const picture_surface *surface)
{
    coats l = {.c = c, .panel = panel, .facts = facts, .surface = surface};
    raster *const all[5] = {&l.opaque, &l.glass, &l.sheets, &l.boxes, &l.bounds};
    bool good = true;
    for (int k = 0; good && k < 5; k++)
        good = raster_create(all[k], panel.width, panel.height);
    if (good) {
        raster_camera camera = raster_camera_of(facts->frame);
        picture_sky(c, panel);
        draw_triangles(&l, &camera);
        draw_occluders(&l, &camera);
        for (int y = 0; y < panel.height; y++)
            for (int x = 0; x < panel.width; x++)
                compose_pixel(&l, x, y);
    }
    for (int k = 0; k < 5; k++)
        raster_free(all[k]);
    return good;
}

void picture_surface_free(picture_surface *surface)
{
    division_free(&surface->division);
    model_free(&surface->model);
}
