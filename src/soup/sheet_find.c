// SPDX-License-Identifier: Apache-2.0
#include "log.h"
#include "soup/sheet_cover.h"
#include "soup/sheet_desc.h"
#include "soup/sheet_proof.h"
#include "soup/tally.h"
#include "soup/triangles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct find_call {
    occ_hooks *hooks;
    const occ_sheets_desc *desc;
    occ_surface surface;
    occ_cover cover;
    occ_array local; // occ_found_sheet: of the plane at hand
    occ_array found; // occ_found_sheet
    occ_sheets_stats stats;
} find_call;

// --- one plane -----------------------------------------------------------------------------------

static void region_of_sheet(const occ_sheet_plane *plane, const occ_sheet *sheet, occ_region *out)
{
    out->count = sheet->corner_count;
    for (uint32_t i = 0; i < out->count; i++) {
        out->at[i][0] = (double)sheet->corner[i][plane->u];
        out->at[i][1] = (double)sheet->corner[i][plane->v];
    }
    if (occ_region_area(out) >= 0.0) return;
    for (uint32_t i = 0; i < out->count / 2; i++) {
        double held[2];
        memcpy(held, out->at[i], sizeof held);
        memcpy(out->at[i], out->at[out->count - 1 - i], sizeof held);
        memcpy(out->at[out->count - 1 - i], held, sizeof held);
    }
}

static double sheet_area(const occ_sheet *sheet)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 2; i < sheet->corner_count; i++)
        for (int k = 0; k < 3; k++) {
            int m = (k + 1) % 3, n = (k + 2) % 3;
            double u[2] = {(double)sheet->corner[i - 1][m] - (double)sheet->corner[0][m],
                           (double)sheet->corner[i - 1][n] - (double)sheet->corner[0][n]};
            double v[2] = {(double)sheet->corner[i][m] - (double)sheet->corner[0][m],
                           (double)sheet->corner[i][n] - (double)sheet->corner[0][n]};
            sum[k] += u[0] * v[1] - u[1] * v[0];
        }
    return 0.5 * sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

// A triangle is a sheet.
static void sheet_of_triangle(const find_call *call, uint32_t triangle, occ_found_sheet *out)
{
    *out = (occ_found_sheet){.sheet = {.corner_count = 3, .sides = call->desc->sides},
                             .triangle = call->surface.mesh.source[triangle],
                             .triangle_count = 1};
    out->label = call->desc->labels ? call->desc->labels[out->triangle] : 0;
    for (int c = 0; c < 3; c++)
        memcpy(out->sheet.corner[c], occ_mesh_corner(&call->surface.mesh, triangle, c),
               sizeof out->sheet.corner[c]);
}

static void make_sheet(find_call *call, const occ_cover_piece *seed, occ_found_sheet *out)
{
    sheet_of_triangle(call, seed->triangle, out);
}

static occ_result cover_plane(find_call *call, const occ_sheet_plane *plane)
{
    occ_cover_piece seed;
    occ_result result = occ_cover_start(&call->cover, plane);
    while (!result && occ_cover_largest(&call->cover, &seed)) {
        occ_found_sheet made;
        occ_region region;
        make_sheet(call, &seed, &made);
        region_of_sheet(plane, &made.sheet, &region);
        double area = sheet_area(&made.sheet), flat = occ_region_area(&region);
        double gain = occ_cover_gain(&call->cover, &region, true, &result);
        if (result) break;
        made.area = (float)area;
        made.gain = flat > 0.0 ? (float)(gain * area / flat) : 0.0f;
        occ_found_sheet *out = occ_array_push(call->hooks, &call->found);
        if (!out) return OCC_ERROR_OUT_OF_MEMORY;
        *out = made;
    }
    return result;
}

// --- all planes ----------------------------------------------------------------------------------

static int by_gain(const void *a, const void *b)
{
    const occ_found_sheet *p = a, *q = b;
    if (p->gain != q->gain) return p->gain > q->gain ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static occ_result cover_planes(find_call *call)
{
    const occ_sheet_plane *planes = call->surface.planes.data;
    uint32_t count = call->surface.planes.count, asked = 0;
    uint64_t next = 0;
    for (uint32_t p = 0; p < count; p++) {
        if (call->cover.work >= next) {
            double done = 0.4 + 0.55 * (double)p / (double)count;
            occ_result result = occ_soup_progress(&call->desc->work, call->hooks, done);
            if (result) return result;
            next = call->cover.work + (1u << 22);
            asked++;
        }
        occ_result result = cover_plane(call, &planes[p]);
        if (result) return result;
    }
    return OCC_SUCCESS;
}

static double triangle_area(const occ_mesh *mesh, uint32_t triangle)
{
    occ_sheet sheet = {.corner_count = 3};
    for (int c = 0; c < 3; c++)
        memcpy(sheet.corner[c], occ_mesh_corner(mesh, triangle, c), sizeof sheet.corner[c]);
    return sheet_area(&sheet);
}

static void sum_up(find_call *call)
{
    const occ_found_sheet *found = call->found.data;
    call->stats.see_through = call->surface.see_through;
    call->stats.planes = call->surface.planes.count;
    call->stats.found = call->found.count;
    for (uint32_t t = 0; t < call->surface.mesh.triangles; t++)
        call->stats.area += triangle_area(&call->surface.mesh, t);
    for (uint32_t i = 0; i < call->found.count; i++)
        call->stats.covered += (double)found[i].gain;
}

static occ_result search(find_call *call, const occ_soup *soup)
{
    occ_result result = occ_surface_build(call->hooks, soup, call->desc, &call->surface);
    if (!result) result = cover_planes(call);
    if (result == OCC_ERROR_OUT_OF_MEMORY)
        return occ_fail(call->hooks, result, "no memory for the sheets of %u triangles",
                        (unsigned)soup->triangle_count);
    if (result) return result;
    if (call->found.count)
        qsort(call->found.data, call->found.count, sizeof(occ_found_sheet), by_gain);
    sum_up(call);
    return occ_soup_progress(&call->desc->work, call->hooks, 1.0);
}

static occ_result find(occ_hooks *hooks, const occ_soup *soup, const occ_sheets_desc *desc,
                       occ_found_sheet *sheets, size_t capacity, size_t *count,
                       occ_sheets_stats *stats)
{
    occ_tally tally;
    occ_tally_start(&tally, hooks);
    find_call call = {.hooks = hooks,
                      .desc = desc,
                      .local = OCC_ARRAY(occ_found_sheet),
                      .found = OCC_ARRAY(occ_found_sheet)};
    call.cover = OCC_COVER(hooks, &call.surface);
    occ_result result = search(&call, soup);
    if (!result) {
        *count = call.found.count < capacity ? call.found.count : capacity;
        if (*count) memcpy(sheets, call.found.data, *count * sizeof *sheets);
    }
    occ_array_free(hooks, &call.found);
    occ_array_free(hooks, &call.local);
    occ_cover_free(&call.cover);
    occ_surface_free(hooks, &call.surface);
    if (stats && !result) {
        call.stats.counts = stats->counts;
        call.stats.peak_bytes = tally.peak;
        *stats = call.stats;
    }
    return result;
}

// --- the call ------------------------------------------------------------------------------------

occ_result occ_sheets_take_desc(const occ_hooks *hooks, const occ_sheets_desc *desc)
{
    const char *complaint = NULL;
    if (desc->sides != OCC_SIDES_BOTH && desc->sides != OCC_SIDES_FRONT)
        complaint = "sides is none of the enumerators";
    if (!(desc->min_area >= 0.0f && isfinite(desc->min_area)))
        complaint = "min_area is negative or no number";
    if (!complaint) return OCC_SUCCESS;
    return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "%s", complaint);
}

occ_result occ_sheets_find(const occ_soup *soup, const occ_sheets_desc *desc,
                           occ_found_sheet *sheets, size_t capacity, size_t *count,
                           occ_sheets_stats *stats)
{
    occ_hooks hooks;
    occ_sheets_desc taken = {0};
    if (desc) taken = *desc;
    if (count) *count = 0;
    if (stats) *stats = (occ_sheets_stats){0};
    occ_result result = occ_soup_hooks(&taken.work, &hooks);
    if (result) return result;
    if (!count || (capacity && !sheets))
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "count or sheets is NULL");
    result = occ_sheets_take_desc(&hooks, &taken);
    if (!result) result = occ_soup_validate(soup, &hooks);
    if (!result && stats) result = occ_soup_check(soup, &taken.work, &stats->counts);
    if (!result) result = occ_soup_progress(&taken.work, &hooks, 0.0);
    return result ? result : find(&hooks, soup, &taken, sheets, capacity, count, stats);
}
