// SPDX-License-Identifier: Apache-2.0
#include "soup/triangles.h"

#include "log.h"
#include "soup/unrounded.h"

#include <math.h>
#include <string.h>

occ_result occ_soup_hooks(const occ_soup_work *work, occ_hooks *hooks)
{
    static const occ_soup_work plain = {0};
    if (!work) work = &plain;
    occ_result result = occ_hooks_init(hooks, &work->allocator, &work->logger);
    return result ? occ_fail(hooks, result, "the allocator has one of its two functions") : result;
}

occ_result occ_soup_progress(const occ_soup_work *work, const occ_hooks *hooks, double done)
{
    if (!work || !work->progress || work->progress((float)done, work->user_data))
        return OCC_SUCCESS;
    return occ_fail(hooks, OCC_ERROR_CANCELLED, "stopped by the caller");
}

// --- validation ----------------------------------------------------------------------------------

static occ_result check_shape(const occ_soup *soup, const occ_hooks *hooks)
{
    const char *complaint = NULL;
    if (!soup) {
        complaint = "the soup is NULL";
    } else if (!soup->positions) {
        complaint = "the soup has no positions";
    } else if (!soup->triangle_count) {
        complaint = "the soup has no triangles";
    } else if (soup->stride % sizeof(float) || (soup->stride && soup->stride < 3 * sizeof(float))) {
        complaint = "the stride is neither 0 nor a multiple of 4 that is at least 12";
    }
    if (complaint) return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "%s", complaint);
    return OCC_SUCCESS;
}

static occ_result check_vertex(const occ_soup *soup, const occ_hooks *hooks, uint32_t triangle,
                               int corner)
{
    uint64_t vertex = 3 * (uint64_t)triangle + (uint64_t)corner;
    if (soup->indices) vertex = soup->indices[vertex];
    if (vertex >= soup->vertex_count) {
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "triangle %u names vertex %llu of %u",
                        (unsigned)triangle, (unsigned long long)vertex,
                        (unsigned)soup->vertex_count);
    }
    const float *at = occ_soup_vertex(soup, (uint32_t)vertex);
    for (int k = 0; k < 3; k++) {
        if (fabsf(at[k]) <= OCC_MAX_COORDINATE) continue;
        occ_result result = isfinite(at[k]) ? OCC_ERROR_OUT_OF_RANGE : OCC_ERROR_NOT_FINITE;
        return occ_fail(hooks, result, "vertex %u of triangle %u: %c is %g", (unsigned)vertex,
                        (unsigned)triangle, "xyz"[k], (double)at[k]);
    }
    return OCC_SUCCESS;
}

occ_result occ_soup_validate(const occ_soup *soup, const occ_hooks *hooks)
{
    occ_result result = check_shape(soup, hooks);
    if (result) return result;
    for (uint32_t t = 0; t < soup->triangle_count; t++)
        for (int c = 0; c < 3; c++)
            if ((result = check_vertex(soup, hooks, t, c))) return result;
    return OCC_SUCCESS;
}

// --- triangles without area ----------------------------------------------------------------------

static bool has_no_area_exactly(const float *const corner[3])
{
    occ_unrounded_vector point[3];
    for (int c = 0; c < 3; c++)
        point[c] = occ_unrounded_vector_from(corner[c]);
    occ_unrounded_vector u = occ_unrounded_vector_subtract(&point[1], &point[0]);
    occ_unrounded_vector v = occ_unrounded_vector_subtract(&point[2], &point[0]);
    occ_unrounded_vector n = occ_unrounded_cross(&u, &v);
    return n.at[0].sign == 0 && n.at[1].sign == 0 && n.at[2].sign == 0;
}

bool occ_triangle_is_degenerate(const float *const corner[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)corner[1][k] - (double)corner[0][k];
        v[k] = (double)corner[2][k] - (double)corner[0][k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double left = u[i] * v[j], right = u[j] * v[i];
        // Each product is off by 3 roundings of 2^-53 and their difference by one more.
        if (fabs(left - right) > (fabs(left) + fabs(right)) * 0x1p-50) return false;
    }
    return has_no_area_exactly(corner);
}

// --- what there is -------------------------------------------------------------------------------

// The corners of a triangle in an order that does not depend on how they were given; never -0.
typedef struct triangle_key {
    float at[3][3];
} triangle_key;

static bool comes_before(const float *a, const float *b)
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k];
    return false;
}

static void swap_if_later(float *a, float *b)
{
    if (!comes_before(b, a)) return;
    float kept[3];
    memcpy(kept, a, sizeof kept);
    memcpy(a, b, sizeof kept);
    memcpy(b, kept, sizeof kept);
}

static triangle_key key_of(const occ_soup *soup, uint32_t triangle)
{
    triangle_key key;
    const float *corner[3];
    occ_soup_corners(soup, triangle, corner);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            key.at[c][k] = corner[c][k] + 0.0f;
    swap_if_later(key.at[0], key.at[1]);
    swap_if_later(key.at[1], key.at[2]);
    swap_if_later(key.at[0], key.at[1]);
    return key;
}

static bool same_key(const triangle_key *a, const triangle_key *b)
{
    for (int i = 0; i < 9; i++)
        if (a->at[i / 3][i % 3] != b->at[i / 3][i % 3]) return false;
    return true;
}

static size_t scatter(const triangle_key *key)
{
    uint32_t word[9];
    uint64_t hash = 0;
    memcpy(word, key, sizeof word);
    for (int i = 0; i < 9; i++) {
        hash = (hash ^ word[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return (size_t)hash;
}

// Triangles by their corners, with open addressing.
typedef struct triangle_table {
    uint32_t *place; // a triangle and 1, or 0
    size_t places;   // a power of two
} triangle_table;

// Whether an earlier triangle has the same corners. If not, this one is remembered.
static bool seen_before(triangle_table *table, const occ_soup *soup, uint32_t triangle)
{
    triangle_key key = key_of(soup, triangle);
    size_t i = scatter(&key) & (table->places - 1);
    for (; table->place[i]; i = (i + 1) & (table->places - 1)) {
        triangle_key other = key_of(soup, table->place[i] - 1);
        if (same_key(&key, &other)) return true;
    }
    table->place[i] = triangle + 1;
    return false;
}

static occ_result count_triangles(const occ_soup *soup, const occ_soup_work *work, occ_hooks *hooks,
                                  occ_soup_counts *counts)
{
    occ_result result = OCC_SUCCESS;
    triangle_table table = {NULL, 16};
    while (table.places / 2 < soup->triangle_count)
        table.places *= 2;
    size_t bytes = table.places * sizeof *table.place;
    table.place = occ_alloc(hooks, bytes);
    if (!table.place) return OCC_ERROR_OUT_OF_MEMORY;
    memset(table.place, 0, bytes);
    for (uint32_t t = 0; t < soup->triangle_count && !result; t++) {
        const float *corner[3];
        occ_soup_corners(soup, t, corner);
        if (occ_triangle_is_degenerate(corner)) {
            counts->degenerate++;
        } else if (seen_before(&table, soup, t)) {
            counts->duplicate++;
        }
        if (t % 65536 == 65535)
            result = occ_soup_progress(work, hooks, (double)t / (double)soup->triangle_count);
    }
    counts->triangles = soup->triangle_count - counts->degenerate - counts->duplicate;
    occ_free(hooks, table.place, bytes);
    return result;
}

static occ_result count_vertices(const occ_soup *soup, occ_hooks *hooks, occ_soup_counts *counts)
{
    size_t bytes = ((size_t)soup->vertex_count + 7) / 8;
    unsigned char *named = occ_alloc(hooks, bytes);
    if (!named) return OCC_ERROR_OUT_OF_MEMORY;
    memset(named, 0, bytes);
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        for (int c = 0; c < 3; c++) {
            uint32_t v = occ_soup_index(soup, t, c);
            unsigned char bit = (unsigned char)(1u << (v % 8));
            if (!(named[v / 8] & bit)) counts->vertices++;
            named[v / 8] |= bit;
        }
    }
    occ_free(hooks, named, bytes);
    return OCC_SUCCESS;
}

occ_result occ_soup_check(const occ_soup *soup, const occ_soup_work *work, occ_soup_counts *counts)
{
    occ_hooks hooks;
    occ_soup_counts found = {0};
    occ_result result = occ_soup_hooks(work, &hooks);
    if (!result) result = occ_soup_validate(soup, &hooks);
    if (result || !counts) return result;
    result = count_vertices(soup, &hooks, &found);
    if (!result) result = count_triangles(soup, work, &hooks, &found);
    if (result == OCC_ERROR_OUT_OF_MEMORY)
        return occ_fail(&hooks, result, "no memory to count triangles in");
    if (!result) *counts = found;
    return result;
}
