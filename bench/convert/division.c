// SPDX-License-Identifier: Apache-2.0
#include "division.h"

#include "library.h"
#include "progress.h"

#include <occlude/clusters.h>
#include <occlude/instances.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

division_options division_defaults(void)
{
    return (division_options){.most = 32, .split = "light"};
}

// Cuts the list at its commas, in place.
static bool split_patterns(division_options *options)
{
    char *next = options->see_through;
    while (next && *next) {
        if (options->model.see_through_count == DIVISION_PATTERNS) return false;
        options->patterns[options->model.see_through_count++] = next;
        next = strchr(next, ',');
        if (next) *next++ = '\0';
    }
    options->model.see_through = options->patterns;
    return true;
}

const char *division_complete(division_options *options)
{
    static const char *const apart[] = {"light", "material", "mesh"};
    if (options->most < 1) return "--triangles is 1 at least";
    if (!split_patterns(options)) return "too many patterns after --see-through";
    int which = 0;
    while (which < 3 && strcmp(options->split, apart[which]) != 0)
        which++;
    if (which == 3) return "expected light, material or mesh after --split";
    options->apart = (division_apart)which;
    if (!options->up) return NULL;
    if (strcmp(options->up, "y") != 0 && strcmp(options->up, "z") != 0)
        return "expected y or z after --up";
    options->model.up = *options->up == 'y' ? MODEL_UP_Y : MODEL_UP_Z;
    return NULL;
}

// Clusters of some soup, as the library gives them.
typedef struct clusters {
    uint32_t *order, *first, count;
    occ_box *boxes;
} clusters;

static void free_clusters(clusters *c)
{
    free(c->order);
    free(c->first);
    free(c->boxes);
    *c = (clusters){0};
}

static bool find_clusters(const occ_soup *soup, uint32_t most, const uint32_t *labels, clusters *c)
{
    size_t room = (size_t)soup->triangle_count + 1;
    occ_clusters_desc desc = {.work = library_work(), .max_triangles = most, .labels = labels};
    *c = (clusters){malloc(room * sizeof *c->order), malloc(room * sizeof *c->first), 0, NULL};
    if (!c->order || !c->first) return library_out_of_memory();
    progress_begin("splitting into objects, per mille", LIBRARY_STEPS);
    bool good = library_succeeded(occ_clusters_find(soup, &desc, c->order, c->first, &c->count),
                                  "splitting");
    progress_end();
    c->boxes = good ? malloc(((size_t)c->count + 1) * sizeof *c->boxes) : NULL;
    if (!c->boxes) return good && library_out_of_memory();
    progress_begin("bounding objects, per mille", LIBRARY_STEPS);
    good = library_succeeded(
        occ_clusters_bounds(soup, c->order, c->first, c->count, &desc.work, c->boxes), "bounding");
    progress_end();
    return good;
}

static bool is_turned(const occ_box *box)
{
    int along = 0;
    for (int k = 0; k < 3; k++) {
        int beside = 0;
        for (int j = 0; j < 3; j++)
            beside += box->axis[k][j] != 0.0f;
        along += beside <= 1;
    }
    return along < 3;
}

// Whoever adds an object has put its triangles in place.
static void add_object(division *d, uint32_t count, const occ_box *box)
{
    uint32_t first = d->first[d->count], end = first + count;
    for (uint32_t i = first; i < end; i++)
        d->object_of[d->triangles[i]] = d->count;
    d->turned += is_turned(box);
    d->boxes[d->count] = *box;
    d->first[++d->count] = end;
}

// --- what stands in one place --------------------------------------------------------------------

// Some triangles of the model, and what keeps them apart.
typedef struct subset {
    uint32_t (*corners)[3];
    uint32_t *triangles, *labels;
    uint32_t count;
} subset;

static void free_subset(subset *s)
{
    free(s->corners);
    free(s->triangles);
    free(s->labels);
    *s = (subset){0};
}

static uint32_t label_of(const model *m, const model_part *part, uint32_t triangle,
                         division_apart apart)
{
    if (apart == DIVISION_APART_LIGHT || !part) return m->see_through[triangle];
    return apart == DIVISION_APART_MESH ? part->mesh : m->meshes[part->mesh].material;
}

static bool take_single(const model *m, division_apart apart, subset *s)
{
    size_t room = (size_t)m->triangle_count + 1;
    *s = (subset){malloc(room * sizeof *s->corners), malloc(room * sizeof *s->triangles),
                  malloc(room * sizeof *s->labels), 0};
    if (!s->corners || !s->triangles || !s->labels) return library_out_of_memory();
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        const model_part *part = model_part_of(m, t);
        if (model_is_instance(m, part)) continue;
        memcpy(s->corners[s->count], m->corners[t], sizeof *s->corners);
        s->labels[s->count] = label_of(m, part, t, apart);
        s->triangles[s->count++] = t;
    }
    return true;
}

static bool divide_single(const model *m, const division_options *options, division *d)
{
    subset s;
    clusters c = {0};
    bool good = take_single(m, options->apart, &s);
    if (good && s.count) {
        occ_soup soup = library_soup(m, (const uint32_t(*)[3])s.corners, s.count);
        good = find_clusters(&soup, options->most, s.labels, &c);
    }
    for (uint32_t i = 0; good && i < c.count; i++) {
        uint32_t place = d->first[d->count];
        for (uint32_t k = c.first[i]; k < c.first[i + 1]; k++)
            d->triangles[place++] = s.triangles[c.order[k]];
        add_object(d, c.first[i + 1] - c.first[i], &c.boxes[i]);
    }
    free_clusters(&c);
    free_subset(&s);
    return good;
}

// --- instances -----------------------------------------------------------------------------------

// One cluster of a mesh, at one of its places. `corners` has room for it.
static bool place_cluster(const model *m, const model_part *part, const clusters *c, uint32_t which,
                          uint32_t (*corners)[3], division *d)
{
    occ_box box;
    uint32_t count = c->first[which + 1] - c->first[which], place = d->first[d->count];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t triangle = part->first + c->order[c->first[which] + i];
        d->triangles[place + i] = triangle;
        memcpy(corners[i], m->corners[triangle], sizeof *corners);
    }
    occ_soup placed = library_soup(m, (const uint32_t(*)[3])corners, count);
    if (!library_succeeded(
            occ_bounds_of_instance(&placed, part->matrix, &c->boxes[which], NULL, &box),
            "bounding an instance")) {
        return false;
    }
    add_object(d, count, &box);
    d->instanced++;
    return true;
}

static bool place_part(const model *m, const model_part *part, const clusters *c, division *d)
{
    uint32_t(*corners)[3] = malloc(((size_t)part->count + 1) * sizeof *corners);
    bool good = corners || library_out_of_memory();
    for (uint32_t i = 0; good && i < c->count; i++)
        good = place_cluster(m, part, c, i, corners, d);
    free(corners);
    return good;
}

// Splits each mesh that has several places once.
static bool divide_instances(const model *m, const division_options *options, division *d)
{
    clusters *of_mesh = calloc((size_t)m->mesh_count + 1, sizeof *of_mesh);
    bool good = of_mesh || library_out_of_memory();
    for (uint32_t p = 0; good && p < m->part_count; p++) {
        const model_part *part = &m->parts[p];
        if (!model_is_instance(m, part)) continue;
        clusters *c = &of_mesh[part->mesh];
        if (!c->count) {
            occ_soup soup = library_mesh_soup(&m->meshes[part->mesh]);
            good = find_clusters(&soup, options->most, NULL, c);
        }
        good = good && place_part(m, part, c, d);
    }
    for (uint32_t i = 0; of_mesh && i < m->mesh_count; i++)
        free_clusters(&of_mesh[i]);
    free(of_mesh);
    return good;
}

// --- all of it -----------------------------------------------------------------------------------

bool division_make(const model *m, const division_options *options, division *out)
{
    size_t room = (size_t)m->triangle_count + 1;
    *out = (division){.first = calloc(room, sizeof *out->first),
                      .triangles = malloc(room * sizeof *out->triangles),
                      .object_of = malloc(room * sizeof *out->object_of),
                      .boxes = malloc(room * sizeof *out->boxes)};
    bool good =
        (out->first && out->triangles && out->object_of && out->boxes) || library_out_of_memory();
    good = good && divide_single(m, options, out) && divide_instances(m, options, out);
    occ_box *fitting =
        good ? realloc(out->boxes, ((size_t)out->count + 1) * sizeof *fitting) : NULL;
    if (fitting) out->boxes = fitting;
    if (!good) division_free(out);
    return good;
}

void division_free(division *d)
{
    free(d->first);
    free(d->triangles);
    free(d->object_of);
    free(d->boxes);
    *d = (division){0};
}
