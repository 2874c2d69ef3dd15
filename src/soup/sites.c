// SPDX-License-Identifier: Apache-2.0
#include "soup/search.h"

#include "log.h"

#include <math.h>
#include <stdlib.h>

#define MOST_SITES    256u       // parts that are looked at: the largest
#define MOST_CLUSTERS 64u        // and clusters
#define SMALL_CLUSTER 0.25       // of the area of its part's bounds, for grids of its own
#define NEAR_CLUSTER  0.5f       // of its longest extent: beyond that no box of it can get
#define SITE_CELLS    (1u << 15) // of a small part, where the caller allows as many

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
    occ_triangles all = {&s->mesh, s->parts.triangle + part->first, part->count};
    *site = (occ_site){.own = all, .near = all, .part = all, .pictures = s->sites.count - 1};
    site->most_cells = cells < SITE_CELLS ? SITE_CELLS : (uint32_t)cells;
    if (site->most_cells > s->desc->max_cells) site->most_cells = s->desc->max_cells;
    site->has_closed = has_closed(&s->closed, &site->own);
    occ_result result =
        occ_silhouette_make(s->hooks, &site->own, part->min, part->max, side,
                            s->desc->outside_solid ? OCC_LAYERS : 1, team, &site->silhouette);
    s->stats.silhouette += (float)site->silhouette.area;
    return result;
}

// --- clusters ------------------------------------------------------------------------------------

// A cluster within the part of a site.
typedef struct small_cluster {
    uint32_t cluster, site, triangles;
    float min[3], max[3];
    double area;
} small_cluster;

static int by_cluster_area(const void *a, const void *b)
{
    const small_cluster *p = a, *q = b;
    if (p->area != q->area) return p->area > q->area ? -1 : 1;
    return p->cluster < q->cluster ? -1 : 1;
}

static uint32_t cluster_of(const occ_closed *closed, uint32_t triangle)
{
    uint32_t patch = closed->patch[triangle];
    return patch == OCC_OPEN ? UINT32_MAX : closed->cluster_of[patch];
}

// Bounds and numbers of triangles of all clusters in the sites.
static void bound_clusters(const occ_search *s, small_cluster *clusters)
{
    const occ_site *sites = s->sites.data;
    for (uint32_t i = 0; i < s->closed.clusters.count; i++)
        clusters[i] = (small_cluster){.cluster = i,
                                      .min = {INFINITY, INFINITY, INFINITY},
                                      .max = {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < s->sites.count; i++)
        for (uint32_t k = 0; k < sites[i].part.count; k++) {
            uint32_t t = occ_triangle_at(&sites[i].part, k), own = cluster_of(&s->closed, t);
            if (own == UINT32_MAX) continue;
            clusters[own].site = i;
            clusters[own].triangles++;
            for (int c = 0; c < 9; c++) {
                float at = occ_mesh_corner(&s->mesh, t, c / 3)[c % 3];
                if (at < clusters[own].min[c % 3]) clusters[own].min[c % 3] = at;
                if (at > clusters[own].max[c % 3]) clusters[own].max[c % 3] = at;
            }
        }
}

// Keeps clusters that are small in their parts, the largest of these.
static uint32_t choose_clusters(const occ_search *s, const double *part_area,
                                small_cluster *clusters)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->closed.clusters.count; i++) {
        small_cluster c = clusters[i];
        if (c.triangles < 4) continue; // the fewest that hold a volume
        occ_part bounds = {.min = {c.min[0], c.min[1], c.min[2]},
                           .max = {c.max[0], c.max[1], c.max[2]}};
        c.area = area_of(&bounds);
        if (c.area <= SMALL_CLUSTER * part_area[c.site]) clusters[kept++] = c;
    }
    if (kept) qsort(clusters, kept, sizeof *clusters, by_cluster_area);
    return kept < MOST_CLUSTERS ? kept : MOST_CLUSTERS;
}

static bool is_near(const occ_mesh *mesh, uint32_t triangle, const small_cluster *c)
{
    float reach = 0.0f;
    for (int k = 0; k < 3; k++)
        reach = fmaxf(reach, NEAR_CLUSTER * (c->max[k] - c->min[k]));
    for (int k = 0; k < 3; k++) {
        bool below = true, above = true;
        for (int i = 0; i < 3; i++) {
            float at = occ_mesh_corner(mesh, triangle, i)[k];
            below = below && at < c->min[k] - reach;
            above = above && at > c->max[k] + reach;
        }
        if (below || above) return false;
    }
    return true;
}

static occ_result add_cluster(occ_search *s, const small_cluster *c)
{
    const occ_site *parent = (const occ_site *)s->sites.data + c->site;
    const occ_triangles *all = &parent->part;
    occ_site site = {.part = *all, .pictures = c->site, .has_closed = true};
    uint32_t near = 0, own = 0;
    for (uint32_t i = 0; i < all->count; i++)
        near += is_near(&s->mesh, occ_triangle_at(all, i), c);
    site.room = near + c->triangles;
    site.list = occ_alloc(s->hooks, site.room * sizeof *site.list);
    if (!site.list) return OCC_ERROR_OUT_OF_MEMORY;
    site.own = (occ_triangles){&s->mesh, site.list, c->triangles};
    site.near = (occ_triangles){&s->mesh, site.list + c->triangles, near};
    near = c->triangles;
    for (uint32_t i = 0; i < all->count; i++) {
        uint32_t t = occ_triangle_at(all, i);
        if (is_near(&s->mesh, t, c)) site.list[near++] = t;
        if (cluster_of(&s->closed, t) == c->cluster) site.list[own++] = t;
    }
    site.most_cells = parent->most_cells / 16;
    if (site.most_cells < SITE_CELLS) site.most_cells = SITE_CELLS;
    if (site.most_cells > s->desc->max_cells) site.most_cells = s->desc->max_cells;
    occ_site *place = occ_array_push(s->hooks, &s->sites);
    if (place) {
        *place = site;
        return OCC_SUCCESS;
    }
    occ_free(s->hooks, site.list, site.room * sizeof *site.list);
    return OCC_ERROR_OUT_OF_MEMORY;
}

static occ_result add_clusters(occ_search *s, const double *part_area)
{
    uint32_t room = s->closed.clusters.count;
    if (!room) return OCC_SUCCESS;
    small_cluster *clusters = occ_alloc(s->hooks, room * sizeof *clusters);
    occ_result result = clusters ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
    if (clusters) bound_clusters(s, clusters);
    uint32_t count = clusters ? choose_clusters(s, part_area, clusters) : 0;
    for (uint32_t i = 0; !result && i < count; i++)
        result = add_cluster(s, &clusters[i]);
    occ_free(s->hooks, clusters, room * sizeof *clusters);
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
    double area = 0.0, areas[MOST_SITES];
    for (uint32_t i = 0; i < taken; i++) {
        areas[i] = order[i].area;
        area += areas[i];
    }
    for (uint32_t i = 0; !result && i < taken; i++) {
        double share = area > 0.0 ? order[i].area / area : 1.0;
        result = add_site(search, occ_parts_at(&search->parts, order[i].part), share,
                          picture_side(taken), team);
    }
    if (!result) result = add_clusters(search, areas);
    occ_free(search->hooks, order, room * sizeof *order);
    return result ? occ_fail(search->hooks, result, "no memory for the parts of a mesh") : result;
}
