// SPDX-License-Identifier: Apache-2.0
#include "soup/inner.h"

#include "log.h"
#include "soup/tally.h"

#include <math.h>

// --- what the caller gave ------------------------------------------------------------------------

static occ_result check_points(const occ_inner_desc *d, const occ_hooks *hooks)
{
    if (!d->free_points && d->free_count)
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "free_points is NULL");
    for (size_t i = 0; i < 3 * (size_t)d->free_count; i++) {
        float at = d->free_points[i];
        if (fabsf(at) <= OCC_MAX_COORDINATE) continue;
        return occ_fail(hooks, isfinite(at) ? OCC_ERROR_OUT_OF_RANGE : OCC_ERROR_NOT_FINITE,
                        "free_points: a coordinate of point %zu is %g", i / 3, (double)at);
    }
    return OCC_SUCCESS;
}

occ_result occ_inner_take_desc(const occ_hooks *hooks, occ_inner_desc *desc)
{
    const char *complaint = NULL;
    occ_inner_desc *d = desc;
    if (!d->max_cells) d->max_cells = 1u << 22;
    if (d->max_cells < OCC_LEAST_CELLS || d->max_cells > OCC_MOST_CELLS)
        complaint = "max_cells is not from 4096 to 2^28";
    if (d->threads > OCC_MOST_THREADS) complaint = "threads is more than 1024";
    if (!(d->coverage >= 0.0f && d->coverage <= 1.0f)) complaint = "coverage is not from 0 to 1";
    if (!(d->max_hole >= 0.0f && d->max_hole <= OCC_MAX_COORDINATE))
        complaint = "max_hole is not from 0 to OCC_MAX_COORDINATE";
    if (d->facing != OCC_FACING_ANY && d->facing != OCC_FACING_OUT)
        complaint = "facing is none of the enumerators";
    if (d->outside_solid && !d->free_count)
        complaint = "outside_solid needs free_points: else all is solid";
    if (complaint) return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "%s", complaint);
    return check_points(d, hooks);
}

// --- the search ----------------------------------------------------------------------------------

typedef struct find_call {
    occ_search search;
    const occ_soup *soup;
    occ_inner_box *boxes;
    size_t capacity, count;
    occ_result result;
} find_call;

static occ_result read_soup(occ_search *s, const occ_soup *soup)
{
    occ_result result = occ_mesh_build(s->hooks, soup, &s->mesh);
    if (result || !s->mesh.triangles) return result;
    result = occ_closed_build(s->hooks, &s->mesh, &s->closed);
    if (!result) result = occ_parts_build(s->hooks, &s->mesh, s->desc->outside_solid, &s->parts);
    if (!result) result = occ_free_space_make(s->hooks, &s->closed, s->desc, &s->space);
    s->stats.open_triangles = s->closed.open_triangles;
    return result;
}

static void search_boxes(find_call *call, occ_team *team)
{
    occ_search *s = &call->search;
    call->result = read_soup(s, call->soup);
    if (call->result || !s->mesh.triangles) return;
    call->result = occ_soup_progress(&s->desc->work, s->hooks, 0.05);
    if (!call->result) call->result = occ_search_sites(s, team);
    if (!call->result) call->result = occ_search_candidates(s, team);
    if (!call->result)
        call->result = occ_search_choose(s, call->boxes, call->capacity, &call->count);
}

static void free_search(occ_search *s)
{
    occ_site *sites = s->sites.data;
    for (uint32_t i = 0; i < s->sites.count; i++) {
        occ_silhouette_free(s->hooks, &sites[i].silhouette);
        occ_free(s->hooks, sites[i].list, sites[i].room * sizeof *sites[i].list);
    }
    occ_array_free(s->hooks, &s->sites);
    occ_array_free(s->hooks, &s->laid);
    occ_array_free(s->hooks, &s->candidates);
    occ_free_space_free(s->hooks, &s->space);
    occ_parts_free(s->hooks, &s->parts);
    occ_closed_free(s->hooks, &s->closed);
    occ_mesh_free(s->hooks, &s->mesh);
}

static occ_result find(occ_hooks *hooks, const occ_soup *soup, const occ_inner_desc *desc,
                       occ_inner_box *boxes, size_t capacity, size_t *count, occ_inner_stats *stats)
{
    occ_tally counted;
    occ_team *team;
    occ_hooks plain = *hooks; // what threads take is no part of what is counted
    occ_result result = occ_team_create(&plain, occ_threads_offered(desc->threads), &team);
    if (result) return occ_fail(hooks, result, "no memory for threads");
    occ_tally_start(&counted, hooks);
    find_call call = {.search = {.hooks = hooks,
                                 .desc = desc,
                                 .sites = OCC_ARRAY(occ_site),
                                 .laid = OCC_ARRAY(occ_laid_grid),
                                 .candidates = OCC_ARRAY(occ_candidate)},
                      .soup = soup,
                      .boxes = boxes,
                      .capacity = capacity};
    occ_team_wake(team);
    search_boxes(&call, team);
    occ_team_rest(team);
    occ_team_destroy(&plain, team);
    free_search(&call.search);
    if (stats) {
        occ_soup_counts counts = stats->counts;
        *stats = call.search.stats;
        stats->counts = counts;
        stats->peak_bytes = counted.peak;
    }
    if (!call.result) *count = call.count;
    return call.result;
}

occ_result occ_inner_find(const occ_soup *soup, const occ_inner_desc *desc, occ_inner_box *boxes,
                          size_t capacity, size_t *count, occ_inner_stats *stats)
{
    occ_hooks hooks;
    occ_inner_desc taken = {0};
    if (desc) taken = *desc;
    if (count) *count = 0;
    if (stats) *stats = (occ_inner_stats){0};
    occ_result result = occ_soup_hooks(&taken.work, &hooks);
    if (result) return result;
    if (!count || (capacity && !boxes))
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "count or boxes is NULL");
    result = occ_inner_take_desc(&hooks, &taken);
    if (!result) result = occ_soup_validate(soup, &hooks);
    if (!result && stats) result = occ_soup_check(soup, &taken.work, &stats->counts);
    if (!result) result = occ_soup_progress(&taken.work, &hooks, 0.0);
    return result ? result : find(&hooks, soup, &taken, boxes, capacity, count, stats);
}
