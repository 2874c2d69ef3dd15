// SPDX-License-Identifier: Apache-2.0
// The scene from above, without depth: what is larger is drawn first, and of small things the
// visible ones last, so that nothing is buried under a roof or a ceiling.
#include "picture.h"

#include "raster.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Which part of the world's x and z is drawn.
typedef struct map {
    canvas *c;
    canvas_rect panel;
    const picture_facts *facts;
    double left, top, scale; // world x and z of the panel's upper left corner; pixels a unit
} map;

// When to draw an object: in order of layer, then of area, larger first.
typedef struct map_entry {
    uint32_t object;
    int layer;
    float area;
} map_entry;

static double box_reach(const occ_box *box, int k)
{
    return fabs((double)box->axis[0][k]) + fabs((double)box->axis[1][k]) +
           fabs((double)box->axis[2][k]);
}

static int compare_doubles(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// The middle of an object as the map sees it.
static void middle_of(const occ_box *box, double out[2])
{
    out[0] = (double)box->center[0];
    out[1] = (double)box->center[2];
}

static double distance_to(const double a[2], const double b[2])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

// The distance from the eye that nine tenths of the visible objects' middles are within.
static bool usual_distance(const picture_facts *facts, const double eye[2], double *out)
{
    double *distances = malloc(((size_t)facts->counts[PICTURE_VISIBLE] + 1) * sizeof *distances);
    size_t count = 0;
    if (!distances) return false;
    for (uint32_t i = 0; i < facts->scene->object_count; i++) {
        if (facts->verdicts[i] != PICTURE_VISIBLE) continue;
        double middle[2];
        middle_of(&facts->scene->objects[i], middle);
        distances[count++] = distance_to(eye, middle);
    }
    qsort(distances, count, sizeof *distances, compare_doubles);
    *out = count ? distances[(count - 1) * 9 / 10] : 0;
    free(distances);
    return true;
}

static void grow(double low[2], double high[2], const double p[2], double reach)
{
    for (int k = 0; k < 2; k++) {
        low[k] = fmin(low[k], p[k] - reach);
        high[k] = fmax(high[k], p[k] + reach);
    }
}

static void scene_bounds(const obs_scene *scene, double low[2], double high[2])
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        for (int k = 0; k < 2; k++) {
            double c = (double)scene->objects[i].center[2 * k];
            double r = box_reach(&scene->objects[i], 2 * k);
            low[k] = fmin(low[k], c - r);
            high[k] = fmax(high[k], c + r);
        }
}

// Chooses a square around the eye and what it sees, no larger than the scene.
static bool choose_window(map *m, double *side, double *scene_side)
{
    const obs_frame *frame = m->facts->frame;
    const double eye[2] = {(double)frame->eye[0], (double)frame->eye[2]};
    double low[2] = {eye[0], eye[1]}, high[2] = {eye[0], eye[1]}, usual;
    double all_low[2] = {eye[0], eye[1]}, all_high[2] = {eye[0], eye[1]};
    if (!usual_distance(m->facts, eye, &usual)) return false;
    for (uint32_t i = 0; i < m->facts->scene->object_count; i++) {
        double middle[2];
        if (m->facts->verdicts[i] != PICTURE_VISIBLE) continue;
        middle_of(&m->facts->scene->objects[i], middle);
        if (distance_to(eye, middle) <= usual) grow(low, high, middle, 0);
    }
    scene_bounds(m->facts->scene, all_low, all_high);
    *scene_side = 1.04 * fmax(all_high[0] - all_low[0], all_high[1] - all_low[1]);
    *side = 1.4 * fmax(high[0] - low[0], high[1] - low[1]);
    *side = fmax(*side, *scene_side / 50);
    if (*side > 0.7 * *scene_side) { // The whole is worth more than a slight enlargement.
        *side = *scene_side;
        memcpy(low, all_low, sizeof low);
        memcpy(high, all_high, sizeof high);
    }
    if (!(*side > 0)) *side = *scene_side = 1;
    m->scale = m->panel.width / *side;
    m->left = 0.5 * (low[0] + high[0]) - 0.5 * *side;
    m->top = 0.5 * (low[1] + high[1]) - 0.5 * *side;
    return true;
}

static void to_panel(const map *m, double x, double z, double out[2])
{
    out[0] = m->panel.x + (x - m->left) * m->scale;
    out[1] = m->panel.y + (z - m->top) * m->scale;
}

static double turn(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int compare_points(const void *left, const void *right)
{
    const double *a = left, *b = right;
    if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
    return (a[1] > b[1]) - (a[1] < b[1]);
}

// The convex hull of 8 points (Andrew's monotone chain). `hull` has room for 16.
static int hull_of(double (*points)[2], double (*hull)[2])
{
    int count = 0;
    qsort(points, 8, sizeof *points, compare_points);
    for (int i = 0; i < 8; i++) {
        while (count >= 2 && turn(hull[count - 2], hull[count - 1], points[i]) <= 0)
            count--;
        memcpy(hull[count++], points[i], sizeof *points);
    }
    int lower = count + 1;
    for (int i = 6; i >= 0; i--) {
        while (count >= lower && turn(hull[count - 2], hull[count - 1], points[i]) <= 0)
            count--;
        memcpy(hull[count++], points[i], sizeof *points);
    }
    return count - 1;
}

static int footprint(const map *m, const occ_box *box, double (*hull)[2])
{
    double points[8][2];
    for (int i = 0; i < 8; i++) {
        double p[2];
        for (int k = 0; k < 2; k++) {
            p[k] = (double)box->center[2 * k];
            for (int n = 0; n < 3; n++)
                p[k] += (i >> n & 1 ? 1.0 : -1.0) * (double)box->axis[n][2 * k];
        }
        to_panel(m, p[0], p[1], points[i]);
    }
    return hull_of(points, hull);
}

static void outline(const map *m, const double (*hull)[2], int count, double thickness,
                    canvas_color color, float share)
{
    for (int i = 0; i < count; i++)
        canvas_line(m->c, hull[i], hull[(i + 1) % count], thickness, color, share);
}

static bool in_panel(const map *m, const occ_box *box)
{
    for (int k = 0; k < 2; k++) {
        double at[2], reach = box_reach(box, 2 * k) * m->scale + 4;
        to_panel(m, (double)box->center[0], (double)box->center[2], at);
        double start = k ? m->panel.y : m->panel.x, size = k ? m->panel.height : m->panel.width;
        if (at[k] + reach < start || at[k] - reach > start + size) return false;
    }
    return true;
}

static void draw_object(const map *m, const map_entry *entry)
{
    double hull[16][2];
    const occ_box *box = &m->facts->scene->objects[entry->object];
    uint8_t verdict = m->facts->verdicts[entry->object];
    canvas_color color = picture_colors[verdict];
    canvas_color dark = {(uint8_t)(color.r / 2), (uint8_t)(color.g / 2), (uint8_t)(color.b / 2)};
    int count = footprint(m, box, hull);
    bool large = entry->layer == 0;
    canvas_polygon(m->c, (const double(*)[2])hull, count, color, large ? 0.2f : 0.85f);
    if (entry->area > 150) outline(m, (const double(*)[2])hull, count, 1.5, dark, 0.6f);
    if (entry->area < 16 && verdict != PICTURE_OUTSIDE) { // too small to be seen otherwise
        double at[2];
        to_panel(m, (double)box->center[0], (double)box->center[2], at);
        canvas_disc(m->c, at[0], at[1], verdict == PICTURE_VISIBLE ? 2.5 : 1.2, color);
    }
}

static int compare_entries(const void *left, const void *right)
{
    const map_entry *a = left, *b = right;
    if (a->layer != b->layer) return a->layer < b->layer ? -1 : 1;
    if (a->area != b->area) return a->area > b->area ? -1 : 1;
    return (a->object > b->object) - (a->object < b->object);
}

static bool draw_objects(const map *m)
{
    const obs_scene *scene = m->facts->scene;
    map_entry *entries = malloc(((size_t)scene->object_count + 1) * sizeof *entries);
    size_t count = 0;
    if (!entries) return false;
    double whole = (double)m->panel.width * m->panel.height;
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const occ_box *box = &scene->objects[i];
        if (!in_panel(m, box)) continue;
        double area = 4 * box_reach(box, 0) * box_reach(box, 2) * m->scale * m->scale;
        int layer = area > 0.05 * whole ? 0 : 1 + m->facts->verdicts[i];
        entries[count++] = (map_entry){i, layer, (float)area};
    }
    qsort(entries, count, sizeof *entries, compare_entries);
    for (size_t i = 0; i < count; i++)
        draw_object(m, &entries[i]);
    free(entries);
    return true;
}

// An occluder's footprint and, of a sheet, its bounds.
static int occluder_footprint(const map *m, uint32_t number, occ_box *box, double (*hull)[2])
{
    const occ_sheet *sheet = obs_occluder_sheet(m->facts->scene, number);
    double points[8][2];
    if (!sheet) {
        *box = m->facts->scene->occluders[number].box;
        return footprint(m, box, hull);
    }
    for (uint32_t i = 0; i < 8; i++) { // the last corner as often as there are too few
        const float *p = sheet->corner[i < sheet->corner_count ? i : sheet->corner_count - 1];
        to_panel(m, (double)p[0], (double)p[2], points[i]);
    }
    if (occ_box_from_points(sheet->corner[0], sheet->corner_count, 0, box) != OCC_SUCCESS)
        *box = (occ_box){{0}, {{0}}}; // too far off for the library
    return hull_of(points, hull);
}

// Whether a box stands: floors and ceilings would cover the map.
static bool is_upright(const occ_box *box)
{
    return box_reach(box, 1) > 0.25 * fmin(box_reach(box, 0), box_reach(box, 2));
}

// What stands is what hides on a map: it is filled, and a sheet seen from its edge is a line.
static void draw_occluders(const map *m, const uint32_t *places, size_t places_count,
                           canvas_color color)
{
    for (size_t i = places_count; i-- > 0;) {
        double hull[16][2];
        occ_box box;
        int count = occluder_footprint(m, places[i], &box, hull);
        if (!in_panel(m, &box)) continue;
        double area = 4 * box_reach(&box, 0) * box_reach(&box, 2) * m->scale * m->scale;
        bool large = area > 0.05 * m->panel.width * m->panel.height;
        bool upright = is_upright(&box);
        canvas_polygon(m->c, (const double(*)[2])hull, count, color,
                       large     ? 0.1f
                       : upright ? 0.8f
                                 : 0.2f);
        outline(m, (const double(*)[2])hull, count, upright ? 4 : 2, color, upright ? 1.0f : 0.25f);
    }
}

// The object that is explained, and what hides it, over all else.
static void draw_explained(const map *m)
{
    const picture_facts *facts = m->facts;
    double hull[16][2], at[2];
    const occ_box *box = &facts->scene->objects[facts->object];
    draw_occluders(m, facts->culprits, facts->culprit_count, picture_culprit_color);
    int count = footprint(m, box, hull);
    to_panel(m, (double)box->center[0], (double)box->center[2], at);
    canvas_disc(m->c, at[0], at[1], 7, picture_ink);
    canvas_disc(m->c, at[0], at[1], 5, picture_colors[facts->verdicts[facts->object]]);
    outline(m, (const double(*)[2])hull, count, 3, picture_ink, 1.0f);
}

static bool invert(const double a[16], double out[16])
{
    double w[4][8];
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            w[r][c] = a[4 * c + r];
            w[r][c + 4] = r == c;
        }
    for (int k = 0; k < 4; k++) {
        int pivot = k;
        for (int r = k + 1; r < 4; r++)
            if (fabs(w[r][k]) > fabs(w[pivot][k])) pivot = r;
        if (w[pivot][k] == 0) return false;
        double head = w[pivot][k];
        for (int c = 0; c < 8; c++) {
            double kept = w[k][c];
            w[k][c] = w[pivot][c] / head;
            if (pivot != k) w[pivot][c] = kept;
        }
        for (int r = 0; r < 4; r++) {
            double factor = w[r][k];
            for (int c = 0; r != k && c < 8; c++)
                w[r][c] -= factor * w[k][c];
        }
    }
    for (int i = 0; i < 16; i++)
        out[i] = w[i % 4][4 + i / 4];
    return true;
}

// The frustum's corners as the map sees them: 4 near, 4 far.
static bool frustum_corners(const map *m, double out[8][2])
{
    double inverse[16];
    raster_camera camera = raster_camera_of(m->facts->frame);
    if (!invert(camera.clip, inverse)) return false;
    for (int i = 0; i < 8; i++) {
        double world[4];
        for (int r = 0; r < 4; r++)
            world[r] = (i & 1 ? inverse[r] : -inverse[r]) +
                       (i & 2 ? inverse[4 + r] : -inverse[4 + r]) +
                       (i & 4 ? inverse[8 + r] : -inverse[8 + r]) + inverse[12 + r];
        if (world[3] == 0) return false;
        to_panel(m, world[0] / world[3], world[2] / world[3], out[i]);
    }
    return true;
}

static void draw_frustum(const map *m)
{
    static const canvas_color glow = {250, 214, 70};
    double corners[8][2], hull[16][2], eye[2];
    to_panel(m, (double)m->facts->frame->eye[0], (double)m->facts->frame->eye[2], eye);
    if (frustum_corners(m, corners)) {
        int count = hull_of(corners, hull);
        canvas_polygon(m->c, (const double(*)[2])hull, count, glow, 0.16f);
        outline(m, (const double(*)[2])hull, count, 3, picture_ink, 0.8f);
    }
    canvas_disc(m->c, eye[0], eye[1], 9, picture_paper);
    canvas_disc(m->c, eye[0], eye[1], 7, picture_ink);
}

bool picture_draw_map(canvas *c, canvas_rect panel, const picture_facts *facts, char *caption,
                      size_t size)
{
    double side, whole;
    map m = {.c = c, .panel = panel, .facts = facts};
    if (!choose_window(&m, &side, &whole)) return false;
    canvas_fill(c, panel, picture_paper);
    c->clip = panel;
    bool good = draw_objects(&m);
    draw_occluders(&m, facts->used, facts->used_count, picture_occluder_color);
    draw_frustum(&m);
    if (facts->explained) draw_explained(&m);
    c->clip = canvas_all(c);
    int digits = whole < 10 ? 2 : whole < 100 ? 1 : 0;
    if (side < whole)
        snprintf(caption, size, "from above: %.*f of %.*f units across", digits, side, digits,
                 whole / 1.04);
    else
        snprintf(caption, size, "from above: the whole scene, %.*f units across", digits,
                 whole / 1.04);
    return good;
}
