// SPDX-License-Identifier: Apache-2.0
#include "soup/sheet_cover.h"

#include <string.h>

enum { PIECE_CORNERS = 12 }; // a piece with more is parted

// --- regions -------------------------------------------------------------------------------------

double occ_region_area(const occ_region *r)
{
    double sum = 0.0;
    for (uint32_t i = 2; i < r->count; i++) {
        double u[2] = {r->at[i - 1][0] - r->at[0][0], r->at[i - 1][1] - r->at[0][1]};
        double v[2] = {r->at[i][0] - r->at[0][0], r->at[i][1] - r->at[0][1]};
        sum += u[0] * v[1] - u[1] * v[0];
    }
    return 0.5 * sum;
}

void occ_region_cut(occ_region *region, const double a[2], const double b[2])
{
    double height[OCC_REGION_CORNERS] = {0.0};
    occ_region in = *region;
    uint32_t count = 0;
    for (uint32_t i = 0; i < in.count; i++)
        height[i] = (b[0] - a[0]) * (in.at[i][1] - a[1]) - (b[1] - a[1]) * (in.at[i][0] - a[0]);
    for (uint32_t i = 0; i < in.count && count + 1 < OCC_REGION_CORNERS; i++) {
        uint32_t j = (i + 1) % in.count;
        if (height[i] >= 0.0) memcpy(region->at[count++], in.at[i], sizeof in.at[i]);
        if ((height[i] > 0.0 && height[j] < 0.0) || (height[i] < 0.0 && height[j] > 0.0)) {
            double t = height[i] / (height[i] - height[j]);
            for (int k = 0; k < 2; k++)
                region->at[count][k] = in.at[i][k] + t * (in.at[j][k] - in.at[i][k]);
            count++;
        }
    }
    region->count = count < 3 ? 0 : count;
}

// --- the cover -----------------------------------------------------------------------------------

static void region_of_triangle(const occ_cover *c, uint32_t triangle, occ_region *out)
{
    float p[3][2];
    for (int i = 0; i < 3; i++)
        occ_sheet_flatten(c->plane, occ_mesh_corner(&c->surface->mesh, triangle, i), p[i]);
    *out = (occ_region){.count = 3};
    for (int i = 0; i < 3; i++) {
        out->at[i][0] = (double)p[i][0];
        out->at[i][1] = (double)p[i][1];
    }
    if (occ_region_area(out) >= 0.0) return;
    double held[2];
    memcpy(held, out->at[1], sizeof held);
    memcpy(out->at[1], out->at[2], sizeof held);
    memcpy(out->at[2], held, sizeof held);
}

void occ_cover_init(occ_cover *cover, occ_hooks *hooks, const occ_surface *surface,
                    const bool *used)
{
    *cover = (occ_cover){.hooks = hooks,
                         .surface = surface,
                         .used = used,
                         .whole = OCC_ARRAY(uint32_t),
                         .pieces = OCC_ARRAY(occ_cover_piece)};
}

occ_result occ_cover_start(occ_cover *cover, const occ_sheet_plane *plane)
{
    cover->plane = plane;
    cover->whole.count = cover->pieces.count = 0;
    cover->area = 0.0;
    uint32_t *at = occ_array_extend(cover->hooks, &cover->whole, plane->count);
    if (!at) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < plane->count; i++) {
        occ_region r;
        uint32_t t = cover->surface->triangle[plane->first + i];
        region_of_triangle(cover, t, &r);
        cover->area += occ_region_area(&r);
        if (!cover->used[t]) at[cover->whole.count++] = t;
    }
    cover->floor = 1e-3 * cover->area / (double)plane->count;
    return OCC_SUCCESS;
}

bool occ_cover_largest(occ_cover *cover, occ_cover_piece *piece)
{
    const uint32_t *whole = cover->whole.data;
    const occ_cover_piece *pieces = cover->pieces.data, *best = NULL;
    double most = 0.0;
    cover->work += cover->pieces.count + (uint64_t)cover->whole.count;
    for (uint32_t i = 0; i < cover->pieces.count; i++) {
        if (pieces[i].area <= most) continue;
        best = &pieces[i];
        most = best->area;
        cover->largest = cover->whole.count + i;
    }
    if (best) *piece = *best;
    for (uint32_t i = 0; i < cover->whole.count; i++) {
        occ_cover_piece one = {.triangle = whole[i]};
        region_of_triangle(cover, whole[i], &one.region);
        one.area = occ_region_area(&one.region);
        if (one.area <= most) continue;
        most = one.area;
        *piece = one;
        cover->largest = i;
    }
    return most > cover->floor;
}

void occ_cover_drop(occ_cover *cover)
{
    uint32_t *whole = cover->whole.data, wholes = cover->whole.count;
    occ_cover_piece *pieces = cover->pieces.data;
    if (cover->largest < wholes) {
        whole[cover->largest] = whole[--cover->whole.count];
    } else {
        pieces[cover->largest - wholes] = pieces[--cover->pieces.count];
    }
}

// Whether the bounds of two regions have an area in common.
static bool bounds_meet(const occ_region *a, const occ_region *b)
{
    for (int k = 0; k < 2; k++) {
        double low[2] = {a->at[0][k], b->at[0][k]}, high[2] = {a->at[0][k], b->at[0][k]};
        for (uint32_t i = 1; i < a->count; i++) {
            low[0] = a->at[i][k] < low[0] ? a->at[i][k] : low[0];
            high[0] = a->at[i][k] > high[0] ? a->at[i][k] : high[0];
        }
        for (uint32_t i = 1; i < b->count; i++) {
            low[1] = b->at[i][k] < low[1] ? b->at[i][k] : low[1];
            high[1] = b->at[i][k] > high[1] ? b->at[i][k] : high[1];
        }
        if (high[0] <= low[1] || high[1] <= low[0]) return false;
    }
    return true;
}

static bool add_piece(occ_cover *c, const occ_region *region, uint32_t triangle)
{
    double area = occ_region_area(region);
    if (area <= c->floor) return true;
    if (region->count > PIECE_CORNERS) { // in two
        occ_region half = {.count = region->count / 2 + 1};
        memcpy(half.at, region->at, half.count * sizeof half.at[0]);
        if (!add_piece(c, &half, triangle)) return false;
        half.count = region->count - region->count / 2 + 1;
        memcpy(half.at, region->at + region->count / 2, (half.count - 1) * sizeof half.at[0]);
        memcpy(half.at[half.count - 1], region->at[0], sizeof half.at[0]);
        return add_piece(c, &half, triangle);
    }
    occ_cover_piece *piece = occ_array_push(c->hooks, &c->pieces);
    if (piece) *piece = (occ_cover_piece){*region, triangle, area};
    return piece != NULL;
}

static double inside_area(const occ_region *part, const occ_region *region)
{
    occ_region inside = *part;
    for (uint32_t i = 0; i < region->count && inside.count; i++)
        occ_region_cut(&inside, region->at[i], region->at[(i + 1) % region->count]);
    return occ_region_area(&inside);
}

// Adds what of a part lies outside a region: what is beyond its first edge, of the rest what is
// beyond the second, and so on.
static bool add_outside(occ_cover *c, const occ_region *part, uint32_t triangle,
                        const occ_region *region)
{
    occ_region rest = *part;
    for (uint32_t i = 0; i < region->count && rest.count; i++) {
        const double *a = region->at[i], *b = region->at[(i + 1) % region->count];
        occ_region out = rest;
        occ_region_cut(&out, b, a);
        if (out.count && !add_piece(c, &out, triangle)) return false;
        occ_region_cut(&rest, a, b);
    }
    return true;
}

// Takes the region out of a part, if it has any of it. `*kept`: the part is as it was.
static double take_from(occ_cover *c, const occ_region *part, uint32_t triangle,
                        const occ_region *region, bool *kept, occ_result *result)
{
    *kept = true;
    if (!bounds_meet(part, region)) return 0.0;
    double area = inside_area(part, region);
    if (area <= 0.0) return 0.0;
    *kept = false;
    if (!add_outside(c, part, triangle, region)) *result = OCC_ERROR_OUT_OF_MEMORY;
    return area;
}

double occ_cover_gain(occ_cover *c, const occ_region *region, bool take, occ_result *result)
{
    double gain = 0.0;
    uint32_t kept = 0, count = c->pieces.count;
    c->work += count + (uint64_t)c->whole.count;
    for (uint32_t i = 0; i < c->whole.count; i++) {
        uint32_t *whole = c->whole.data;
        occ_region part;
        bool keep = true;
        region_of_triangle(c, whole[i], &part);
        if (!take) {
            if (bounds_meet(&part, region)) gain += inside_area(&part, region);
        } else {
            gain += take_from(c, &part, whole[i], region, &keep, result);
        }
        if (keep) whole[kept++] = whole[i];
    }
    c->whole.count = kept;
    kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        occ_cover_piece piece = ((occ_cover_piece *)c->pieces.data)[i];
        bool keep = true;
        if (!take) {
            if (bounds_meet(&piece.region, region)) gain += inside_area(&piece.region, region);
            continue;
        }
        gain += take_from(c, &piece.region, piece.triangle, region, &keep, result);
        if (keep) ((occ_cover_piece *)c->pieces.data)[kept++] = piece;
    }
    if (!take) return gain;
    // What was added follows what was kept.
    occ_cover_piece *pieces = c->pieces.data;
    uint32_t added = c->pieces.count - count;
    if (added) memmove(pieces + kept, pieces + count, added * sizeof *pieces);
    c->pieces.count = kept + added;
    return gain;
}

void occ_cover_free(occ_cover *cover)
{
    occ_array_free(cover->hooks, &cover->whole);
    occ_array_free(cover->hooks, &cover->pieces);
}
