// SPDX-License-Identifier: Apache-2.0
#include "soup/silhouette.h"

#include <math.h>
#include <string.h>

static const int8_t directions[OCC_DIRECTIONS][3] = {
    {1, 0, 0}, {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0}, {1, 0, 1}, {1, 0, -1},
    {0, 1, 1}, {0, 1, -1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

// --- pictures ------------------------------------------------------------------------------------

// Two unit vectors at right angles to a direction and to each other.
static void choose_axes(const int8_t direction[3], occ_picture *p)
{
    double d[3], size = 0.0, least = 2.0, length = 0.0;
    int k = 0;
    for (int j = 0; j < 3; j++)
        size += (double)(direction[j] * direction[j]);
    for (int j = 0; j < 3; j++) {
        d[j] = direction[j] / sqrt(size);
        if (fabs(d[j]) >= least) continue;
        least = fabs(d[j]);
        k = j;
    }
    for (int j = 0; j < 3; j++) {
        p->across[j] = (j == k ? 1.0 : 0.0) - d[k] * d[j];
        length += p->across[j] * p->across[j];
    }
    for (int j = 0; j < 3; j++) {
        p->across[j] /= sqrt(length);
        p->along[j] = d[j];
    }
    for (int j = 0; j < 3; j++)
        p->up[j] =
            d[(j + 1) % 3] * p->across[(j + 2) % 3] - d[(j + 2) % 3] * p->across[(j + 1) % 3];
}

static double dot_double(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Fits the picture around bounds: both axes in pixels, the origin one pixel outside.
static void fit_picture(occ_picture *p, const float min[3], const float max[3], uint32_t side)
{
    p->near = INFINITY;
    p->far = -INFINITY;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int c = 0; c < 8; c++) {
        double corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = (double)(c >> k & 1 ? max[k] : min[k]);
        double at[2] = {dot_double(p->across, corner), dot_double(p->up, corner)};
        p->near = occ_least(p->near, dot_double(p->along, corner));
        p->far = occ_most(p->far, dot_double(p->along, corner));
        for (int i = 0; i < 2; i++) {
            low[i] = occ_least(low[i], at[i]);
            high[i] = occ_most(high[i], at[i]);
        }
    }
    double longest = occ_most(high[0] - low[0], high[1] - low[1]);
    double edge = longest > 0.0 ? longest / (side - 2.0) : 1.0;
    for (int k = 0; k < 3; k++) {
        p->across[k] /= edge;
        p->up[k] /= edge;
    }
    p->pixel = edge * edge;
    p->origin[0] = low[0] / edge - 1.0;
    p->origin[1] = low[1] / edge - 1.0;
    p->width = ((uint32_t)((high[0] - low[0]) / edge) + 3 + 63) / 64 * 64;
    p->height = (uint32_t)((high[1] - low[1]) / edge) + 3;
}

// The ends of the whole are left open: there may be boxes beyond the triangles.
static void cut_layer(occ_picture *p, uint32_t layer, uint32_t layers)
{
    double near = p->near, depth = (p->far - p->near) / layers;
    p->near = layer ? near + depth * layer : -INFINITY;
    p->far = layer + 1 < layers ? near + depth * (layer + 1) : INFINITY;
}

// --- spans ---------------------------------------------------------------------------------------

// What happens to pixels: the model is drawn, a box covers them, or is only looked at.
typedef enum span_action { DRAW_MODEL, COVER_MODEL, COUNT_NEW } span_action;

static uint64_t bits_from(uint32_t first)
{
    return ~(uint64_t)0 << first % 64;
}

static uint64_t bits_up_to(uint32_t last)
{
    return ~(uint64_t)0 >> (63 - last % 64);
}

// Does it to the pixels [first, end) of a row, which is not empty.
static uint32_t fill_span(uint64_t *covered, uint64_t *model, uint32_t first, uint32_t end,
                          span_action action)
{
    uint32_t last = (end - 1) / 64, count = 0;
    for (uint32_t w = first / 64; w <= last; w++) {
        uint64_t mask = w == first / 64 ? bits_from(first) : ~(uint64_t)0;
        if (w == last) mask &= bits_up_to(end - 1);
        if (action == COUNT_NEW) {
            count += (uint32_t)__builtin_popcountll(model[w] & ~covered[w] & mask);
        } else if (action == COVER_MODEL) {
            covered[w] |= model[w] & mask;
        } else {
            model[w] |= mask;
        }
    }
    return count;
}

static uint32_t clip_pixel(double at, uint32_t most)
{
    double first = ceil(at - 0.5); // the first pixel whose middle is not before `at`
    return first <= 0.0 ? 0 : first >= (double)most ? most : (uint32_t)first;
}

// Does it to all pixels whose middle is in a convex polygon with corners in order around it.
static uint32_t fill(const occ_silhouette *s, const occ_picture *p, const double (*corner)[2],
                     int corners, span_action action)
{
    double low = INFINITY, high = -INFINITY;
    uint32_t sum = 0;
    for (int i = 0; i < corners; i++) {
        low = occ_least(low, corner[i][1]);
        high = occ_most(high, corner[i][1]);
    }
    uint32_t end = clip_pixel(high, p->height);
    for (uint32_t y = clip_pixel(low, p->height); y < end; y++) {
        double middle = y + 0.5, from = INFINITY, to = -INFINITY;
        for (int i = 0; i < corners; i++) {
            const double *a = corner[i], *b = corner[i + 1 < corners ? i + 1 : 0];
            if ((a[1] <= middle) == (b[1] <= middle)) continue;
            double x = a[0] + (middle - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            from = occ_least(from, x);
            to = occ_most(to, x);
        }
        uint32_t first = clip_pixel(from, p->width), last = clip_pixel(to, p->width);
        size_t row = p->first + (size_t)y * (p->width / 64);
        if (from <= to && first < last)
            sum += fill_span(s->covered + row, s->model + row, first, last, action);
    }
    return sum;
}

// --- boxes ---------------------------------------------------------------------------------------

// The outline of a box is a hexagon: twice the axes, in order of their direction, up one side and
// down the other.
static void outline_box(const occ_picture *p, const occ_box *box, double corner[6][2])
{
    double axis[3][2], at[2] = {-p->origin[0], -p->origin[1]};
    for (int k = 0; k < 3; k++) {
        double v[3] = {(double)box->axis[k][0], (double)box->axis[k][1], (double)box->axis[k][2]};
        axis[k][0] = dot_double(p->across, v);
        axis[k][1] = dot_double(p->up, v);
        if (axis[k][1] < 0.0 || (axis[k][1] == 0.0 && axis[k][0] < 0.0)) {
            axis[k][0] = -axis[k][0];
            axis[k][1] = -axis[k][1];
        }
    }
    for (int i = 0; i < 3; i++) // three steps of exchange sort three
        for (int k = 0; k < 2; k++) {
            if (axis[k][0] * axis[k + 1][1] - axis[k][1] * axis[k + 1][0] >= 0.0) continue;
            for (int j = 0; j < 2; j++) {
                double held = axis[k][j];
                axis[k][j] = axis[k + 1][j];
                axis[k + 1][j] = held;
            }
        }
    double c[3] = {(double)box->center[0], (double)box->center[1], (double)box->center[2]};
    at[0] += dot_double(p->across, c) - axis[0][0] - axis[1][0] - axis[2][0];
    at[1] += dot_double(p->up, c) - axis[0][1] - axis[1][1] - axis[2][1];
    for (int i = 0; i < 6; i++) {
        corner[i][0] = at[0];
        corner[i][1] = at[1];
        for (int j = 0; j < 2; j++)
            at[j] += (i < 3 ? 2.0 : -2.0) * axis[i % 3][j];
    }
}

// Whether some of a box is in what a picture shows.
static bool shows_box(const occ_picture *p, const occ_box *box)
{
    double middle = 0.0, reach = 0.0;
    for (int j = 0; j < 3; j++)
        middle += p->along[j] * (double)box->center[j];
    for (int k = 0; k < 3; k++) {
        double v[3] = {(double)box->axis[k][0], (double)box->axis[k][1], (double)box->axis[k][2]};
        reach += fabs(dot_double(p->along, v));
    }
    return middle + reach > p->near && middle - reach < p->far;
}

double occ_silhouette_gain(const occ_silhouette *silhouette, const occ_box *box)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < silhouette->pictures; i++) {
        const occ_picture *p = &silhouette->picture[i];
        double corner[6][2];
        if (!shows_box(p, box)) continue;
        outline_box(p, box, corner);
        sum += p->pixel * fill(silhouette, p, (const double(*)[2])corner, 6, COUNT_NEW);
    }
    return sum / OCC_DIRECTIONS;
}

void occ_silhouette_cover(occ_silhouette *silhouette, const occ_box *box)
{
    for (uint32_t i = 0; i < silhouette->pictures; i++) {
        const occ_picture *p = &silhouette->picture[i];
        double corner[6][2];
        if (!shows_box(p, box)) continue;
        outline_box(p, box, corner);
        (void)fill(silhouette, p, (const double(*)[2])corner, 6, COVER_MODEL);
    }
}

// --- the model -----------------------------------------------------------------------------------

typedef struct draw_job {
    const occ_silhouette *silhouette;
    const occ_triangles *triangles;
} draw_job;

static void draw_picture(void *context, uint32_t picture)
{
    const draw_job *job = context;
    const occ_picture *p = &job->silhouette->picture[picture];
    const occ_triangles *t = job->triangles;
    for (uint32_t i = 0; i < t->count; i++) {
        double corner[3][2], near = INFINITY, far = -INFINITY;
        for (int c = 0; c < 3; c++) {
            const float *q = occ_mesh_corner(t->mesh, occ_triangle_at(t, i), c);
            double v[3] = {(double)q[0], (double)q[1], (double)q[2]};
            corner[c][0] = dot_double(p->across, v) - p->origin[0];
            corner[c][1] = dot_double(p->up, v) - p->origin[1];
            near = occ_least(near, dot_double(p->along, v));
            far = occ_most(far, dot_double(p->along, v));
        }
        if (near > p->far || far < p->near) continue;
        (void)fill(job->silhouette, p, (const double(*)[2])corner, 3, DRAW_MODEL);
    }
}

static void sum_model(occ_silhouette *s)
{
    for (uint32_t i = 0; i < s->pictures; i++) {
        const occ_picture *p = &s->picture[i];
        uint64_t count = 0;
        for (uint32_t w = 0; w < p->height * (p->width / 64); w++)
            count += (uint64_t)__builtin_popcountll(s->model[p->first + w]);
        s->area += p->pixel * (double)count / OCC_DIRECTIONS;
    }
}

occ_result occ_silhouette_make(occ_hooks *hooks, const occ_triangles *triangles, const float min[3],
                               const float max[3], uint32_t side, uint32_t layers, occ_team *team,
                               occ_silhouette *silhouette)
{
    occ_silhouette *s = silhouette;
    *s = (occ_silhouette){0};
    for (uint32_t d = 0; d < OCC_DIRECTIONS; d++)
        for (uint32_t layer = 0; layer < layers; layer++) {
            occ_picture *p = &s->picture[s->pictures++];
            choose_axes(directions[d], p);
            fit_picture(p, min, max, side);
            cut_layer(p, layer, layers);
            p->first = s->words;
            s->words += p->height * (p->width / 64);
        }
    s->covered = occ_alloc(hooks, s->words * sizeof *s->covered);
    s->model = occ_alloc(hooks, s->words * sizeof *s->model);
    if (!s->covered || !s->model) {
        occ_silhouette_free(hooks, s);
        return OCC_ERROR_OUT_OF_MEMORY;
    }
    memset(s->covered, 0, s->words * sizeof *s->covered);
    memset(s->model, 0, s->words * sizeof *s->model);
    draw_job job = {s, triangles};
    occ_do_parts(team, s->pictures, draw_picture, &job);
    sum_model(s);
    return OCC_SUCCESS;
}

void occ_silhouette_free(occ_hooks *hooks, occ_silhouette *silhouette)
{
    occ_free(hooks, silhouette->covered, silhouette->words * sizeof *silhouette->covered);
    occ_free(hooks, silhouette->model, silhouette->words * sizeof *silhouette->model);
    *silhouette = (occ_silhouette){0};
}
