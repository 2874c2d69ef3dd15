// SPDX-License-Identifier: Apache-2.0
#include "log.h"
#include "soup/sheet_cover.h"
#include "soup/sheet_desc.h"
#include "soup/sheet_grow.h"
#include "soup/sheet_patch.h"
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
    occ_grower grower;
    uint64_t work_before; // this plane
    bool *used;           // triangles of patches
    occ_array local;      // occ_found_sheet: of the plane at hand
    occ_array found;      // occ_found_sheet
    occ_sheets_stats stats;
} find_call;

// A sheet that adds less of itself than this to those before it is left out.
#define LEAST_GAIN 1e-4

static uint64_t work_of(const find_call *call)
{
    return call->cover.work + call->grower.work;
}

// Work is bounded by the number of triangles: beyond that they become sheets as they are. So is the
// number of pieces: triangles that cover each other may be cut into any number of them.
static bool is_too_much(const find_call *call)
{
    uint64_t count = call->cover.plane->count, few = count < 4096 ? count : 4096;
    return work_of(call) - call->work_before > (1u << 18) + 4000 * few + 200 * count ||
           call->cover.pieces.count > 2048 + 16 * count;
}

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

// A sheet around a seed, and its region. One that has less than half of the seed is no match for
// the seed's triangle; where even that has not, reckoning has lost its way among slivers: `*made`
// is false.
static occ_result make_sheet(find_call *call, const occ_cover_piece *seed, occ_found_sheet *out,
                             occ_region *region, bool *made)
{
    bool grown;
    *made = true;
    occ_sheet_basis basis;
    occ_result result = occ_grower_grow(&call->grower, &seed->region, &out->sheet, &basis, &grown);
    if (grown) {
        region_of_sheet(call->cover.plane, &out->sheet, region);
        out->triangle = basis.triangle;
        out->triangle_count = basis.count;
        out->label = basis.label;
        grown = occ_cover_gain(&call->cover, region, false, &result) > 0.5 * seed->area;
    }
    if (grown) return result;
    sheet_of_triangle(call, seed->triangle, out);
    region_of_sheet(call->cover.plane, &out->sheet, region);
    *made = occ_cover_gain(&call->cover, region, false, &result) > 0.5 * seed->area;
    return result;
}

// Makes sheets around what is not covered, the largest piece first, until all is or too much work
// is done.
static occ_result make_sheets(find_call *call)
{
    occ_cover_piece seed;
    occ_result result = OCC_SUCCESS;
    while (!result && !is_too_much(call) && occ_cover_largest(&call->cover, &seed)) {
        occ_found_sheet *out = occ_array_push(call->hooks, &call->local);
        occ_region region;
        if (!out) return OCC_ERROR_OUT_OF_MEMORY;
        bool made;
        result = make_sheet(call, &seed, out, &region, &made);
        if (result) break;
        if (!made) {
            call->local.count--;
            occ_cover_drop(&call->cover);
            continue;
        }
        double gain = occ_cover_gain(&call->cover, &region, true, &result);
        out->gain = (float)occ_least(1.0, gain / occ_region_area(&region));
    }
    return result;
}

static occ_result keep(find_call *call, const occ_found_sheet *sheet, double share)
{
    occ_found_sheet *out = occ_array_push(call->hooks, &call->found);
    if (!out) return OCC_ERROR_OUT_OF_MEMORY;
    double area = sheet_area(&sheet->sheet);
    *out = *sheet;
    out->area = (float)area;
    out->gain = (float)(share * area);
    return OCC_SUCCESS;
}

// What is left becomes sheets as it is, and all are kept, with the share of each that it adds.
static occ_result take_rest(find_call *call)
{
    const occ_cover_piece *pieces = call->cover.pieces.data;
    const uint32_t *whole = call->cover.whole.data;
    const occ_found_sheet *local = call->local.data;
    occ_found_sheet one;
    occ_region region;
    occ_result result = OCC_SUCCESS;
    for (uint32_t i = 0; !result && i < call->local.count; i++)
        result = keep(call, &local[i], (double)local[i].gain);
    for (uint32_t i = 0; !result && i < call->cover.whole.count; i++) {
        sheet_of_triangle(call, whole[i], &one);
        result = keep(call, &one, 1.0);
    }
    for (uint32_t i = 0, end; !result && i < call->cover.pieces.count; i = end) {
        double left = 0.0;
        for (end = i; end < call->cover.pieces.count && pieces[end].triangle == pieces[i].triangle;
             end++)
            left += pieces[end].area;
        sheet_of_triangle(call, pieces[i].triangle, &one);
        region_of_sheet(call->cover.plane, &one.sheet, &region);
        result = keep(call, &one, occ_least(1.0, left / occ_region_area(&region)));
    }
    return result;
}

// The sheet with the most to gain. Gains only fall while others are kept, so that one whose gain
// was just looked up is the first of all if it is still before what the others had.
static uint32_t choose(find_call *call, double *gains, occ_region *region, occ_result *result)
{
    const occ_found_sheet *local = call->local.data;
    for (uint32_t looked = UINT32_MAX;;) {
        uint32_t best = 0;
        for (uint32_t i = 1; i < call->local.count; i++)
            if (gains[i] > gains[best]) best = i;
        call->cover.work += call->local.count;
        region_of_sheet(call->cover.plane, &local[best].sheet, region);
        if (best == looked) return best;
        gains[best] = occ_cover_gain(&call->cover, region, false, result);
        looked = best;
    }
}

// Keeps the sheets at hand in the order of what each adds to those before it, and those that add
// something; few of them if that is too much work.
static occ_result keep_by_gain(find_call *call)
{
    occ_region region;
    const occ_found_sheet *local = call->local.data;
    size_t bytes = call->local.count * sizeof(double);
    double *gains = occ_alloc(call->hooks, bytes);
    occ_result result =
        gains ? occ_cover_start(&call->cover, call->cover.plane) : OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; !result && i < call->local.count; i++) {
        region_of_sheet(call->cover.plane, &local[i].sheet, &region);
        gains[i] = occ_region_area(&region) * (1.0 + 1e-9);
    }
    call->work_before = work_of(call);
    while (!result && !is_too_much(call)) {
        uint32_t best = choose(call, gains, &region, &result);
        double area = occ_region_area(&region);
        if (result || gains[best] <= LEAST_GAIN * area) break;
        result = keep(call, &local[best], occ_least(1.0, gains[best] / area));
        if (!result) (void)occ_cover_gain(&call->cover, &region, true, &result);
        gains[best] = 0.0;
    }
    occ_free(call->hooks, gains, bytes);
    return result;
}

static occ_result cover_plane(find_call *call, const occ_sheet_plane *plane)
{
    occ_result result = occ_cover_start(&call->cover, plane);
    if (result) return result;
    call->local.count = 0;
    call->work_before = work_of(call);
    if (plane->count > 1) {
        result = occ_grower_start(&call->grower, plane);
        if (!result) result = make_sheets(call);
    }
    if (result) return result;
    if (plane->count == 1 || is_too_much(call)) return take_rest(call);
    return call->local.count ? keep_by_gain(call) : OCC_SUCCESS;
}

// --- all planes ----------------------------------------------------------------------------------

static int by_gain(const void *a, const void *b)
{
    const occ_found_sheet *p = a, *q = b;
    if (p->gain != q->gain) return p->gain > q->gain ? -1 : 1;
    if (p->triangle != q->triangle) return p->triangle < q->triangle ? -1 : 1;
    for (uint32_t i = 0; i < 3 * OCC_SHEET_CORNERS; i++) {
        float at = p->sheet.corner[i / 3][i % 3], other = q->sheet.corner[i / 3][i % 3];
        if (at != other) return at < other ? -1 : 1;
    }
    return 0;
}

static occ_result cover_planes(find_call *call)
{
    const occ_sheet_plane *planes = call->surface.planes.data;
    uint32_t count = call->surface.planes.count;
    uint64_t next = 0;
    for (uint32_t p = 0; p < count; p++) {
        if (work_of(call) >= next) {
            double done = 0.4 + 0.55 * (double)p / (double)count;
            occ_result result = occ_soup_progress(&call->desc->work, call->hooks, done);
            if (result) return result;
            next = work_of(call) + (1u << 22);
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

static occ_result find_patches(find_call *call)
{
    occ_result result =
        occ_patches_find(call->hooks, &call->surface, call->desc, call->used, &call->found);
    occ_found_sheet *found = call->found.data;
    for (uint32_t i = 0; !result && i < call->found.count; i++)
        found[i].area = found[i].gain = (float)sheet_area(&found[i].sheet);
    return result;
}

static occ_result find_sheets(find_call *call)
{
    size_t count = call->surface.mesh.triangles;
    if (!count) return OCC_SUCCESS;
    call->used = occ_alloc(call->hooks, count * sizeof *call->used);
    if (!call->used) return OCC_ERROR_OUT_OF_MEMORY;
    memset(call->used, 0, count * sizeof *call->used);
    occ_cover_init(&call->cover, call->hooks, &call->surface, call->used);
    occ_grower_init(&call->grower, call->hooks, &call->surface, call->desc);
    occ_result result = occ_soup_progress(&call->desc->work, call->hooks, 0.3);
    if (!result) result = find_patches(call);
    if (!result) result = cover_planes(call);
    occ_grower_free(&call->grower);
    occ_cover_free(&call->cover);
    occ_free(call->hooks, call->used, count * sizeof *call->used);
    return result;
}

// Larger gains first, and what is too small left out.
static void sort_found(find_call *call)
{
    occ_found_sheet *found = call->found.data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < call->found.count; i++)
        if (found[i].area >= call->desc->min_area) found[kept++] = found[i];
    call->found.count = kept;
    if (kept) qsort(found, kept, sizeof *found, by_gain);
}

static occ_result search(find_call *call, const occ_soup *soup)
{
    occ_result result = occ_surface_build(call->hooks, soup, call->desc, &call->surface);
    if (result) return result; // it was logged
    result = find_sheets(call);
    if (result == OCC_ERROR_OUT_OF_MEMORY)
        return occ_fail(call->hooks, result, "no memory for the sheets of %u triangles",
                        (unsigned)soup->triangle_count);
    if (result) return result;
    sort_found(call);
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
    occ_result result = search(&call, soup);
    if (!result) {
        *count = call.found.count < capacity ? call.found.count : capacity;
        if (*count) memcpy(sheets, call.found.data, *count * sizeof *sheets);
    }
    occ_array_free(hooks, &call.found);
    occ_array_free(hooks, &call.local);
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
