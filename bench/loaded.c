// SPDX-License-Identifier: Apache-2.0
#include "loaded.h"

#include <stdio.h>
#include <stdlib.h>

bool loaded_succeeded(occ_result result, const char *what)
{
    if (result == OCC_SUCCESS) return true;
    fprintf(stderr, "occlude-bench: %s: %s (%s)\n", what, occ_result_message(result),
            occ_result_name(result));
    return false;
}

static bool out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

static bool add_boxes(loaded_scene *l)
{
    size_t count = l->file->occluder_count;
    occ_box *boxes = malloc((count + 1) * sizeof *boxes);
    occ_object *owners = malloc((count + 1) * sizeof *owners);
    bool good = boxes && owners;
    for (size_t i = 0; good && i < count; i++) {
        boxes[i] = l->file->occluders[i].box;
        uint32_t owner = l->file->occluders[i].owner;
        owners[i] = owner == OBS_NO_OWNER ? (occ_object){0} : l->objects[owner];
    }
    good = good ? loaded_succeeded(
                      occ_scene_add_occluders(l->scene, boxes, owners, count, l->occluders),
                      "adding the occluders")
                : out_of_memory();
    free(boxes);
    free(owners);
    return good;
}

static bool add_sheets(loaded_scene *l)
{
    size_t count = l->file->sheet_count;
    occ_sheet *sheets = malloc((count + 1) * sizeof *sheets);
    occ_object *owners = malloc((count + 1) * sizeof *owners);
    bool good = sheets && owners;
    for (size_t i = 0; good && i < count; i++) {
        sheets[i] = l->file->sheets[i].sheet;
        uint32_t owner = l->file->sheets[i].owner;
        owners[i] = owner == OBS_NO_OWNER ? (occ_object){0} : l->objects[owner];
    }
    good = good ? loaded_succeeded(occ_scene_add_sheets(l->scene, sheets, owners, count,
                                                        l->occluders + l->file->occluder_count),
                                   "adding the sheets")
                : out_of_memory();
    free(sheets);
    free(owners);
    return good;
}

static bool invert_occluders(loaded_scene *l)
{
    uint32_t count = obs_occluder_total(l->file), most = 0;
    for (uint32_t i = 0; i < count; i++)
        if (l->occluders[i].index > most) most = l->occluders[i].index;
    l->places = calloc((size_t)most + 1, sizeof *l->places);
    if (!l->places) return out_of_memory();
    for (uint32_t i = 0; i < count; i++)
        l->places[l->occluders[i].index] = i;
    return true;
}

static bool fill(loaded_scene *l)
{
    const obs_scene *file = l->file;
    const occ_scene_desc desc = {.object_count = file->object_count,
                                 .occluder_count = obs_occluder_total(file)};
    l->objects = calloc((size_t)file->object_count + 1, sizeof *l->objects);
    l->occluders = calloc((size_t)obs_occluder_total(file) + 1, sizeof *l->occluders);
    if (!l->objects || !l->occluders) return out_of_memory();
    return loaded_succeeded(occ_scene_create(&desc, &l->scene), "making the scene") &&
           loaded_succeeded(
               occ_scene_add_many(l->scene, file->objects, file->object_count, l->objects),
               "adding the objects") &&
           add_boxes(l) && add_sheets(l) && invert_occluders(l) &&
           loaded_succeeded(occ_scene_commit(l->scene), "committing the scene");
}

bool loaded_build(const obs_scene *file, loaded_scene *out)
{
    *out = (loaded_scene){.file = file};
    bool good = fill(out);
    if (!good) loaded_free(out);
    return good;
}

bool loaded_explain(const loaded_scene *loaded, const occ_view *view, uint32_t object,
                    occ_fate *fate, uint32_t *places, size_t *count)
{
    size_t capacity = obs_occluder_total(loaded->file);
    occ_occluder *culprits = malloc((capacity + 1) * sizeof *culprits);
    *count = 0;
    if (!culprits) return out_of_memory();
    bool good = loaded_succeeded(occ_view_explain(view, loaded->scene, loaded->objects[object],
                                                  fate, culprits, capacity, count),
                                 "explaining an object");
    for (size_t i = 0; good && i < *count; i++)
        places[i] = loaded->places[culprits[i].index];
    free(culprits);
    return good;
}

void loaded_free(loaded_scene *loaded)
{
    occ_scene_destroy(loaded->scene);
    free(loaded->objects);
    free(loaded->occluders);
    free(loaded->places);
    *loaded = (loaded_scene){0};
}
