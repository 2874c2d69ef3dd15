// SPDX-License-Identifier: Apache-2.0
#include "sheets.h"

#include "parallelogram.h"
#include "progress.h"

#include <math.h>
#include <stdlib.h>

// More triangles than this on one edge, in one direction, are not paired with each other: a soup
// may hold thousands of copies of one.
enum { EDGE_CROWD = 8 };

// One side of a triangle. Neighbours with the same facing run along it in opposite directions.
typedef struct side {
    uint32_t low, high; // vertices
    uint32_t triangle;
    uint32_t from;     // the corner where it starts, 0 to 2
    uint32_t backward; // it runs from high to low
} side;

static int compare_numbers(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

static int compare_sides(const void *left, const void *right)
{
    const side *a = left, *b = right;
    int order = compare_numbers(a->low, b->low);
    if (!order) order = compare_numbers(a->high, b->high);
    if (!order) order = compare_numbers(a->backward, b->backward);
    if (!order) order = compare_numbers(a->triangle, b->triangle);
    return order ? order : compare_numbers(a->from, b->from);
}

// What a sheet is worth: its area, less as it is more slanted. Of two ways to pair the triangles of
// a row of rectangles it is the one that leaves none over, and square sheets hide more.
static double worth(const sheet *s)
{
    double length[2];
    for (int n = 0; n < 2; n++) {
        const float *axis = s->box.axis[n];
        length[n] = sqrt((double)axis[0] * (double)axis[0] + (double)axis[1] * (double)axis[1] +
                         (double)axis[2] * (double)axis[2]);
    }
    return s->area * s->area / (4 * length[0] * length[1]);
}

// Worthier first; then by triangle, so that the order is total.
static int compare_worth(const void *left, const void *right)
{
    const sheet *a = left, *b = right;
    if (a->worth != b->worth) return a->worth > b->worth ? -1 : 1;
    int order = compare_numbers(a->triangles[0], b->triangles[0]);
    return order ? order : compare_numbers(a->triangles[1], b->triangles[1]);
}

// Larger first.
static int compare_area(const void *left, const void *right)
{
    const sheet *a = left, *b = right;
    if (a->area != b->area) return a->area > b->area ? -1 : 1;
    int order = compare_numbers(a->triangles[0], b->triangles[0]);
    return order ? order : compare_numbers(a->triangles[1], b->triangles[1]);
}

static side *list_sides(const model *m, size_t *count)
{
    side *sides = malloc(((size_t)m->triangle_count * 3 + 1) * sizeof *sides);
    *count = 0;
    for (uint32_t t = 0; sides && t < m->triangle_count; t++) {
        const uint32_t *c = m->corners[t];
        if (m->see_through[t] || c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = c[k], b = c[(k + 1) % 3];
            sides[(*count)++] = (side){a < b ? a : b, a < b ? b : a, t, k, a > b};
        }
    }
    if (sides) qsort(sides, *count, sizeof *sides, compare_sides);
    return sides;
}

// The quad of two triangles: the first from its far corner on, with the second's inserted.
static bool make_sheet(const model *m, const side *forward, const side *backward, sheet *out,
                       uint32_t *pairs)
{
    const uint32_t *f = m->corners[forward->triangle], *b = m->corners[backward->triangle];
    const float *quad[4] = {
        m->positions[f[(forward->from + 1) % 3]], m->positions[f[(forward->from + 2) % 3]],
        m->positions[f[forward->from]], m->positions[b[(backward->from + 2) % 3]]};
    if (!quad_is_flat_and_convex(quad)) return false;
    ++*pairs;
    out->area = quad_fit_parallelogram(quad, &out->box);
    out->triangles[0] = forward->triangle;
    out->triangles[1] = backward->triangle;
    if (out->area > 0) out->worth = worth(out);
    return out->area > 0;
}

// All sheets that one edge gives: its sides are `count` of one edge, forward ones first.
static bool sheets_of_edge(const model *m, const side *sides, size_t count, sheet_list *list,
                           size_t *room)
{
    size_t forward = 0;
    while (forward < count && !sides[forward].backward)
        forward++;
    for (size_t i = 0; i < forward && i < EDGE_CROWD; i++)
        for (size_t j = forward; j < count && j < forward + EDGE_CROWD; j++) {
            sheet found;
            if (!make_sheet(m, &sides[i], &sides[j], &found, &list->coplanar_pairs)) continue;
            if (list->count == *room) {
                *room = *room ? 2 * *room : 1024;
                sheet *grown = realloc(list->at, *room * sizeof *grown);
                if (!grown) return false;
                list->at = grown;
            }
            list->at[list->count++] = found;
        }
    return true;
}

static bool list_candidates(const model *m, const side *sides, size_t count, sheet_list *list)
{
    size_t room = 0;
    for (size_t first = 0, end; first < count; first = end) {
        end = first + 1;
        while (end < count && sides[end].low == sides[first].low &&
               sides[end].high == sides[first].high)
            end++;
        progress_step(first);
        if (!sheets_of_edge(m, sides + first, end - first, list, &room)) return false;
    }
    return true;
}

// Keeps the worthiest sheets that share no triangle, larger ones first.
static bool choose(const model *m, sheet_list *list)
{
    bool *taken = calloc((size_t)m->triangle_count + 1, sizeof *taken);
    if (!taken) return false;
    if (list->count) qsort(list->at, list->count, sizeof *list->at, compare_worth);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        sheet s = list->at[i];
        if (taken[s.triangles[0]] || taken[s.triangles[1]]) continue;
        taken[s.triangles[0]] = taken[s.triangles[1]] = true;
        list->area += s.area;
        list->at[kept++] = s;
    }
    list->count = kept;
    free(taken);
    if (kept) qsort(list->at, kept, sizeof *list->at, compare_area);
    return true;
}

bool sheets_find(const model *m, sheet_list *out)
{
    size_t count;
    *out = (sheet_list){0};
    side *sides = list_sides(m, &count);
    progress_begin("finding sheets, by edge", count);
    bool done = sides && list_candidates(m, sides, count, out) && choose(m, out);
    progress_end();
    free(sides);
    if (!done) sheets_free(out);
    return done;
}

void sheets_free(sheet_list *list)
{
    free(list->at);
    *list = (sheet_list){0};
}
