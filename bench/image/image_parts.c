// SPDX-License-Identifier: Apache-2.0
#include "image_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// -0 is another box than 0.
static bool same_bits(const occ_box *a, const occ_box *b)
{
    uint32_t bits[2][12];
    _Static_assert(sizeof bits[0] == sizeof *a, "a box is 12 floats");
    memcpy(bits[0], a, sizeof bits[0]);
    memcpy(bits[1], b, sizeof bits[1]);
    return memcmp(bits[0], bits[1], sizeof bits[0]) == 0;
}

bool image_parts_agree(const division *d, const obs_scene *scene, const char *scene_name,
                       const char *model_name)
{
    static const char advice[] =
        "give --triangles, --split, --up and --see-through as they were given to convert";
    if (d->count != scene->object_count) {
        fprintf(stderr, "occlude-bench: %s: %u objects, but %s divides into %u: %s\n", scene_name,
                scene->object_count, model_name, d->count, advice);
        return false;
    }
    for (uint32_t i = 0; i < scene->object_count; i++) {
        if (same_bits(&d->boxes[i], &scene->objects[i])) continue;
        fprintf(stderr, "occlude-bench: %s: object %u has another box than %s gives it: %s\n",
                scene_name, i, model_name, advice);
        return false;
    }
    return true;
}

// One object's triangles of one kind, in the model's order of the division.
static uint32_t place_some(const model *m, const division *d, uint32_t object, bool see_through,
                           uint32_t place, image_parts *out)
{
    for (uint32_t i = d->first[object]; i < d->first[object + 1]; i++) {
        uint32_t triangle = d->triangles[i];
        if (m->see_through[triangle] != see_through) continue;
        out->triangles[place] = triangle;
        memcpy(out->corners[place++], m->corners[triangle], sizeof *out->corners);
    }
    return place;
}

bool image_parts_make(const model *m, const division *d, image_parts *out)
{
    size_t objects = d->count, triangles = m->triangle_count;
    *out = (image_parts){.object_count = d->count,
                         .triangle_count = m->triangle_count,
                         .vertex_count = m->vertex_count,
                         .positions = (const float(*)[3])m->positions};
    out->corners = malloc((triangles + 1) * sizeof *out->corners);
    out->triangles = malloc((triangles + 1) * sizeof *out->triangles);
    out->first = malloc((objects + 1) * sizeof *out->first);
    out->see_through = malloc((objects + 1) * sizeof *out->see_through);
    if (!out->corners || !out->triangles || !out->first || !out->see_through) {
        image_parts_free(out);
        return false;
    }
    uint32_t place = 0;
    for (uint32_t i = 0; i < d->count; i++) {
        out->first[i] = place;
        out->see_through[i] = place_some(m, d, i, false, place, out);
        place = place_some(m, d, i, true, out->see_through[i], out);
        out->see_through_count += place - out->see_through[i];
    }
    out->first[objects] = place;
    return true;
}

uint32_t image_parts_object(const image_parts *parts, uint32_t place)
{
    uint32_t low = 0, high = parts->object_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (parts->first[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void image_parts_free(image_parts *parts)
{
    free(parts->corners);
    free(parts->triangles);
    free(parts->first);
    free(parts->see_through);
    *parts = (image_parts){0};
}
