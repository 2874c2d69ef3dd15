// SPDX-License-Identifier: Apache-2.0
#include "soup/search.h"

#include "log.h"
#include "soup/grow.h"
#include "soup/turned.h"

#define SEEDS_IN_ALL 2048u // for the grids of one turn
#define LEAST_SEEDS  48u   // for a grid

typedef struct group_judge {
    occ_search *search;
    const occ_site *site;
    occ_mark mark;
} group_judge;

// A group of solid cells is kept if a point of it is in solid space: no triangle parts its cells.
static occ_result judge_group(void *context, const occ_voxels *voxels, uint32_t cell, bool *kept)
{
    group_judge *j = context;
    occ_search *s = j->search;
    uint32_t place[3];
    double middle[3], world[3];
    occ_cell_place(voxels, cell, place);
    for (int k = 0; k < 3; k++)
        middle[k] = place[k] + 0.5;
    occ_voxels_lead_back(voxels, middle, world);
    float point[3] = {(float)world[0], (float)world[1], (float)world[2]};
    occ_result result = occ_mark_point(s->hooks, &s->closed, j->site->part.list,
                                       j->site->part.count, point, &j->mark);
    *kept = !result && (occ_is_closed_off(&s->space, &j->mark, NULL) ||
                        occ_is_dry_enough(&s->space, &j->mark, voxels->grid.hole));
    return result;
}

static occ_result find_solid(occ_search *s, const occ_site *site, occ_voxels *v, occ_team *team)
{
    const occ_inner_desc *d = s->desc;
    occ_result result = occ_voxels_reserve(s->hooks, v);
    if (result) return result;
    occ_voxels_mark(v, &site->near, team);
    bool walled = d->outside_solid && occ_solid_encloses(v, &s->mesh);
    occ_solid_flood(v, &site->near, walled, d->free_points, d->free_points ? d->free_count : 0);
    group_judge judge = {s, site, OCC_MARK};
    result = occ_solid_settle(s->hooks, v, judge_group, &judge);
    occ_mark_free(s->hooks, &judge.mark);
    s->stats.grids++;
    s->stats.cells += v->count;
    if (!result) s->stats.solid_cells += occ_solid_sum(v);
    return result;
}

static occ_result add_candidates(occ_search *s, const occ_voxels *v, uint32_t laid, uint32_t seeds,
                                 occ_team *team)
{
    occ_array cuboids = OCC_ARRAY(occ_cuboid);
    occ_result result = occ_cuboids_find(s->hooks, v, seeds, team, &cuboids);
    const occ_cuboid *at = cuboids.data;
    for (uint32_t i = 0; !result && i < cuboids.count; i++) {
        occ_candidate c = {.cells = at[i], .laid = laid};
        if (!occ_grow_start(v, &at[i], &c.box)) continue;
        occ_candidate *place = occ_array_push(s->hooks, &s->candidates);
        if (place) *place = c;
        if (!place) result = OCC_ERROR_OUT_OF_MEMORY;
    }
    occ_array_free(s->hooks, &cuboids);
    return result;
}

static occ_result lay_grids(occ_search *s, uint32_t index, occ_voxels *v, occ_team *team)
{
    const occ_site *site = (const occ_site *)s->sites.data + index;
    float axes[OCC_MOST_TURNS][3][3];
    uint32_t turns = occ_turned_axes(&site->own, axes);
    uint32_t seeds = SEEDS_IN_ALL / s->sites.count;
    if (s->desc->aligned_only) turns = 1;
    if (seeds < LEAST_SEEDS) seeds = LEAST_SEEDS;
    for (uint32_t turn = 0; turn < turns; turn++) {
        occ_inner_grid grid;
        if (!occ_grid_plan(&site->own, (const float(*)[3])axes[turn], site->most_cells,
                           s->desc->max_hole, &grid))
            continue;
        occ_laid_grid *laid = occ_array_push(s->hooks, &s->laid);
        if (!laid) return OCC_ERROR_OUT_OF_MEMORY;
        *laid = (occ_laid_grid){grid, index};
        if (!occ_voxels_set(v, &grid)) continue;
        occ_result result = find_solid(s, site, v, team);
        if (!result) result = add_candidates(s, v, s->laid.count - 1, seeds, team);
        if (result) return result;
    }
    return OCC_SUCCESS;
}

// --- what they are worth -------------------------------------------------------------------------

typedef struct gain_job {
    const occ_search *search;
    occ_candidate *at;
    uint32_t count;
} gain_job;

static void look_at_some(void *context, uint32_t part)
{
    const gain_job *job = context;
    const occ_laid_grid *laid = job->search->laid.data;
    occ_site *sites = job->search->sites.data;
    uint32_t end = occ_part_first(job->count, OCC_MOST_PARTS, part + 1);
    for (uint32_t i = occ_part_first(job->count, OCC_MOST_PARTS, part); i < end; i++) {
        occ_candidate *c = &job->at[i];
        c->gain = occ_silhouette_gain(occ_site_pictures(sites, laid[c->laid].site), &c->box);
    }
}

occ_result occ_search_candidates(occ_search *search, occ_team *team)
{
    occ_voxels voxels = {0};
    occ_result result = OCC_SUCCESS;
    const occ_site *sites = search->sites.data;
    for (uint32_t i = 0; !result && i < search->sites.count; i++) {
        result = occ_soup_progress(&search->desc->work, search->hooks,
                                   0.1 + 0.6 * i / search->sites.count);
        if (result || (!sites[i].has_closed && !(search->desc->max_hole > 0.0f))) continue;
        result = lay_grids(search, i, &voxels, team);
        if (result) (void)occ_fail(search->hooks, result, "no memory for a grid");
    }
    occ_voxels_free(search->hooks, &voxels);
    if (result) return result;
    search->stats.candidates = search->candidates.count;
    gain_job job = {search, search->candidates.data, search->candidates.count};
    occ_do_parts(team, OCC_MOST_PARTS, look_at_some, &job);
    return OCC_SUCCESS;
}
