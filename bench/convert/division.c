// SPDX-License-Identifier: Apache-2.0
#include "division.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

division_options division_defaults(void)
{
    return (division_options){.most = 32};
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
    if (options->most < 2) return "--triangles is 2 at least: a sheet's triangles stay together";
    if (!split_patterns(options)) return "too many patterns after --see-through";
    if (!options->up) return NULL;
    if (strcmp(options->up, "y") != 0 && strcmp(options->up, "z") != 0)
        return "expected y or z after --up";
    options->model.up = *options->up == 'y' ? MODEL_UP_Y : MODEL_UP_Z;
    return NULL;
}

// One object's bounds. The points are copied together for the library's own function.
static bool bound_object(const model *m, const cluster_list *objects, uint32_t object,
                         float (*points)[3], occ_box *box)
{
    size_t count = 0;
    for (uint32_t i = objects->first[object]; i < objects->first[object + 1]; i++)
        for (int c = 0; c < 3; c++)
            memcpy(points[count++], m->positions[m->corners[objects->triangles[i]][c]],
                   3 * sizeof(float));
    occ_result result = occ_box_from_points(points[0], count, 0, box);
    if (result == OCC_SUCCESS) return true;
    fprintf(stderr, "occlude-bench: bounds of object %u: %s\n", object, occ_result_message(result));
    return false;
}

static bool out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

static bool bound_objects(const model *m, division *d)
{
    const cluster_list *objects = &d->objects;
    uint32_t most = 0;
    for (uint32_t o = 0; o < objects->count; o++) {
        uint32_t count = objects->first[o + 1] - objects->first[o];
        if (count > most) most = count;
    }
    float(*points)[3] = malloc(((size_t)most * 3 + 1) * sizeof *points);
    d->boxes = malloc(((size_t)objects->count + 1) * sizeof *d->boxes);
    bool good = (points && d->boxes) || out_of_memory();
    for (uint32_t o = 0; good && o < objects->count; o++)
        good = bound_object(m, objects, o, points, &d->boxes[o]);
    free(points);
    return good;
}

bool division_make(const model *m, uint32_t most, division *out)
{
    *out = (division){0};
    bool good = sheets_find(m, &out->sheets) || out_of_memory();
    good = good && (clusters_build(m, &out->sheets, most, &out->objects) || out_of_memory());
    good = good && bound_objects(m, out);
    if (!good) division_free(out);
    return good;
}

void division_free(division *d)
{
    sheets_free(&d->sheets);
    clusters_free(&d->objects);
    free(d->boxes);
    *d = (division){0};
}
