// SPDX-License-Identifier: Apache-2.0
#include "soup/search.h"

#include "log.h"

#include <math.h>
#include <stdlib.h>

#define MOST_SITES 256u       // parts that are looked at: the largest
#define SITE_CELLS (1u << 15) // of a small part, where the caller allows as many

// A part and the area of its bounds.
typedef struct sized_part {
    uint32_t part;
    double area;
} sized_part;

static int by_area(const void *a, const void *b)
{
    const sized_part *p = a, *q = b;
    if (p->area != q->area) return p->area > q->area ? -1 : 1;
    return p->part < q->part ? -1 : 1;
}

static double area_of(const occ_part *p)
{
    double edge[3];
    for (int k = 0; k < 3; k++)
        edge[k] = (double)p->max[k] - (double)p->min[k];
    return edge[0] * edge[1] + edge[1] * edge[2] + edge[2] * edge[0];
}

// Parts that have triangles, larger ones first.
static uint32_t order_parts(const occ_parts *parts, sized_part *order)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < parts->part.count; i++) {
        const occ_part *p = occ_parts_at(parts, i);
        if (p->count) order[count++] = (sized_part){i, area_of(p)};
    }
    qsort(order, count, sizeof *order, by_area);
    return count;
}

static bool has_closed(const occ_closed *closed, const occ_triangles *t)
{
    for (uint32_t i = 0; i < t->count; i++)
        if (closed->patch[occ_triangle_at(t, i)] != OCC_OPEN) return true;
    return false;
}

static uint32_t picture_side(uint32_t sites)
{
    double side = 256.0 / sqrt((double)sites);
    return side < 64.0 ? 64 : (uint32_t)side;
}

static occ_result add_site(occ_search *s, const occ_part *part, double share, uint32_t side,
                           occ_team *team)
{
    occ_site *site = occ_array_push(s->hooks, &s->sites);
    if (!site) return OCC_ERROR_OUT_OF_MEMORY;
    double cells = share * (double)s->desc->max_cells;
    *site = (occ_site){.triangles = {&s->mesh, s->parts.triangle + part->first, part->count}};
    site->most_cells = cells < SITE_CELLS ? SITE_CELLS : (uint32_t)cells;
    if (site->most_cells > s->desc->max_cells) site->most_cells = s->desc->max_cells;
    site->has_closed = has_closed(&s->closed, &site->triangles);
    occ_result result = occ_silhouette_make(s->hooks, &site->triangles, part->min, part->max, side,
                                            team, &site->silhouette);
    s->stats.silhouette += (float)site->silhouette.area;
    return result;
}

occ_result occ_search_sites(occ_search *search, occ_team *team)
{
    uint32_t room = search->parts.part.count;
    sized_part *order = occ_alloc(search->hooks, room * sizeof *order);
    occ_result result = order ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
    uint32_t count = order ? order_parts(&search->parts, order) : 0, taken = count;
    if (taken > MOST_SITES) taken = MOST_SITES;
    search->stats.parts = count;
    search->stats.parts_left_out = count - taken;
    double area = 0.0;
    for (uint32_t i = 0; i < taken; i++)
        area += order[i].area;
    for (uint32_t i = 0; !result && i < taken; i++) {
        double share = area > 0.0 ? order[i].area / area : 1.0;
        result = add_site(search, occ_parts_at(&search->parts, order[i].part), share,
                          picture_side(taken), team);
    }
    occ_free(search->hooks, order, room * sizeof *order);
    return result ? occ_fail(search->hooks, result, "no memory for the silhouettes") : result;
}
