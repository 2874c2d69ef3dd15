// SPDX-License-Identifier: Apache-2.0
#include "solids.h"

#include "library.h"
#include "progress.h"

#include <math.h>
#include <occlude/instances.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct solids_search {
    const model *m;
    const solids_wish *wish;
    obs_scene *scene;
    solids_report *report;
    float (*eyes)[3];
    occ_inner_box *boxes, *carried; // room for as many as one search may find
    uint32_t (*corners)[3];         // room for all triangles
} solids_search;

static occ_inner_desc describe(const solids_search *s)
{
    return (occ_inner_desc){.work = library_work(),
                            .max_cells = s->wish->max_cells,
                            .coverage = (float)s->wish->coverage,
                            .free_points = s->scene->frame_count ? s->eyes[0] : NULL,
                            .free_count = s->scene->frame_count};
}

static bool add_boxes(const solids_search *s, const occ_inner_box *boxes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (obs_add_occluder(s->scene, &boxes[i].box, OBS_NO_OWNER) == UINT32_MAX)
            return library_out_of_memory();
    return true;
}

// The opaque triangles of [first, first + count).
static uint32_t take_opaque(const solids_search *s, uint32_t first, uint32_t count)
{
    uint32_t taken = 0;
    for (uint32_t t = first; t < first + count; t++)
        if (!s->m->see_through[t])
            memcpy(s->corners[taken++], s->m->corners[t], sizeof *s->corners);
    return taken;
}

static bool search_whole(solids_search *s)
{
    size_t found = 0;
    occ_inner_stats stats;
    uint32_t opaque = take_opaque(s, 0, s->m->triangle_count);
    if (!s->wish->most || !opaque) return true;
    occ_soup soup = library_soup(s->m, (const uint32_t(*)[3])s->corners, opaque);
    occ_inner_desc desc = describe(s);
    desc.max_hole = (float)s->wish->max_hole;
    desc.outside_solid = s->wish->within && desc.free_count;
    progress_begin("finding inner boxes, per mille", LIBRARY_STEPS);
    bool good =
        library_succeeded(occ_inner_find(&soup, &desc, s->boxes, s->wish->most, &found, &stats),
                          "finding inner boxes");
    progress_end();
    s->report->boxes = (uint32_t)found;
    s->report->coverage = (double)stats.coverage;
    for (size_t i = 0; i < found; i++) {
        s->report->closed += s->boxes[i].closed;
        if (!s->boxes[i].closed)
            s->report->largest_hole = fmax(s->report->largest_hole, (double)s->boxes[i].grid.hole);
    }
    return good && add_boxes(s, s->boxes, found);
}

// --- meshes that have several places -------------------------------------------------------------

// In a mesh's own coordinates no eye is known: whether one is within a box is asked at each place.
static bool search_mesh(solids_search *s, const model_mesh *mesh, size_t *found)
{
    occ_soup soup = library_mesh_soup(mesh);
    occ_inner_desc desc = describe(s);
    desc.free_points = NULL;
    desc.free_count = 0;
    progress_begin("finding a mesh's inner boxes, per mille", LIBRARY_STEPS);
    bool good =
        library_succeeded(occ_inner_find(&soup, &desc, s->boxes, s->wish->most_placed, found, NULL),
                          "finding a mesh's inner boxes");
    progress_end();
    s->report->of_meshes += (uint32_t)*found;
    return good;
}

static bool place_boxes(solids_search *s, const model_part *part, size_t found)
{
    size_t carried;
    uint32_t opaque = take_opaque(s, part->first, part->count);
    if (opaque < part->count || !found) return true; // a mesh is opaque or not, as a whole
    occ_soup placed = library_soup(s->m, (const uint32_t(*)[3])s->corners, opaque);
    occ_inner_desc desc = describe(s);
    desc.work.progress = NULL;
    desc.threads = 1;
    if (!library_succeeded(occ_inner_of_instance(&placed, part->matrix, s->boxes, found, &desc,
                                                 s->carried, &carried),
                           "placing a mesh's inner boxes")) {
        return false;
    }
    s->report->carried += (uint32_t)carried;
    return add_boxes(s, s->carried, carried);
}

static bool search_meshes(solids_search *s)
{
    const model *m = s->m;
    if (!s->wish->most_placed) return true;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        size_t found = 0;
        if (m->meshes[i].places < 2 || !m->meshes[i].triangle_count) continue;
        if (!search_mesh(s, &m->meshes[i], &found)) return false;
        for (uint32_t p = 0; p < m->part_count; p++)
            if (m->parts[p].mesh == i && !place_boxes(s, &m->parts[p], found)) return false;
    }
    return true;
}

bool solids_find(const model *m, const solids_wish *wish, obs_scene *scene, solids_report *report)
{
    *report = (solids_report){0};
    size_t room = wish->most > wish->most_placed ? wish->most : wish->most_placed;
    solids_search s = {.m = m,
                       .wish = wish,
                       .scene = scene,
                       .report = report,
                       .eyes = malloc(((size_t)scene->frame_count + 1) * sizeof *s.eyes),
                       .boxes = malloc((room + 1) * sizeof *s.boxes),
                       .carried = malloc((room + 1) * sizeof *s.carried),
                       .corners = malloc(((size_t)m->triangle_count + 1) * sizeof *s.corners)};
    bool good = (s.eyes && s.boxes && s.carried && s.corners) || library_out_of_memory();
    for (uint32_t i = 0; good && i < scene->frame_count; i++)
        memcpy(s.eyes[i], scene->frames[i].eye, sizeof *s.eyes);
    good = good && search_whole(&s) && search_meshes(&s);
    free(s.eyes);
    free(s.boxes);
    free(s.carried);
    free(s.corners);
    return good;
}
