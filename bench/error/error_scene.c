// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "error_scene.h"

#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const error_source error_sources[] = {{"seedscene_500", "seedscene", 1, 500, true, false},
                                      {"seedscene_1000", "seedscene", 1, 1000, true, false},
                                      {"seedscene_10000", "seedscene", 1, 10000, true, false},
                                      {"seedscene_100000", "seedscene", 1, 100000, false, false},
                                      {"city_1000", "city", 2, 1000, true, false},
                                      {"city_10000", "city", 2, 10000, true, true},
                                      {"city_100000", "city", 2, 100000, false, false},
                                      {"city_1000000", "city", 2, 1000000, false, false},
                                      {"forest_100000", "forest", 3, 100000, false, false},
                                      {"soup_100000", "soup", 4, 100000, false, true},
                                      {"interior_10000", "interior", 5, 10000, true, true},
                                      {"alphacorp", NULL, 0, 0, false, false},
                                      {"institute", NULL, 0, 0, false, false},
                                      {"sponza", NULL, 0, 0, false, true},
                                      {NULL, NULL, 0, 0, false, false}};

const error_source *error_source_find(const char *name)
{
    for (const error_source *source = error_sources; source->name; source++)
        if (strcmp(source->name, name) == 0) return source;
    return NULL;
}

bool error_scene_has_tolerance(const char *name)
{
    const error_source *source = error_source_find(name);
    return !source || source->has_tolerance;
}

static error_load make(const error_source *source, obs_scene *scene)
{
    if (!source->kind) return ERROR_ABSENT;
    if (scenes_make(source->kind, source->count, source->seed, scene)) return ERROR_LOADED;
    fprintf(stderr, "occlude-bench: not enough memory for the scene %s\n", source->name);
    return ERROR_FAILED;
}

error_load error_scene_load_source(const char *folder, const error_source *source, obs_scene *scene,
                                   bool *is_file)
{
    *scene = (obs_scene){0};
    *is_file = false;
    if (!folder) return make(source, scene);
    size_t size = strlen(folder) + strlen(source->name) + sizeof "/.obs";
    char *path = malloc(size);
    if (!path) return ERROR_FAILED;
    snprintf(path, size, "%s/%s.obs", folder, source->name);
    error_load load;
    *is_file = access(path, F_OK) == 0;
    if (*is_file)
        load = obs_read(path, scene) ? ERROR_LOADED : ERROR_FAILED;
    else
        load = make(source, scene);
    free(path);
    return load;
}

error_load error_scene_load(const char *folder, const char *name, obs_scene *scene)
{
    const error_source *source = error_source_find(name), unknown = {.name = name};
    bool is_file;
    return error_scene_load_source(folder, source ? source : &unknown, scene, &is_file);
}

static float scaled(float value, double factor)
{
    return (float)((double)value * factor);
}

static occ_box scale_box(const occ_box *box, double factor)
{
    occ_box result = *box;
    for (int k = 0; k < 3; k++) {
        result.center[k] = scaled(box->center[k], factor);
        for (int a = 0; a < 3; a++)
            result.axis[a][k] = scaled(box->axis[a][k], factor);
    }
    return result;
}

// A perspective projection's last column is made of lengths (near and far), the rest has no unit.
// Of an orthographic one the first three columns are one over a length.
static void scale_projection(float *projection, double factor)
{
    bool is_perspective = projection[11] != 0;
    for (int i = is_perspective ? 12 : 0; i < (is_perspective ? 16 : 12); i++)
        projection[i] = scaled(projection[i], is_perspective ? factor : 1 / factor);
}

static obs_frame scale_frame(const obs_frame *frame, double factor)
{
    obs_frame result = *frame;
    for (int k = 0; k < 3; k++) {
        result.eye[k] = scaled(frame->eye[k], factor);
        result.view[12 + k] = scaled(frame->view[12 + k], factor);
    }
    scale_projection(result.proj, factor);
    return result;
}

static occ_sheet scale_sheet(const occ_sheet *sheet, double factor)
{
    occ_sheet result = *sheet;
    for (uint32_t c = 0; c < sheet->corner_count; c++)
        for (int k = 0; k < 3; k++)
            result.corner[c][k] = scaled(sheet->corner[c][k], factor);
    return result;
}

bool error_scene_scale(const obs_scene *scene, double factor, obs_scene *result)
{
    *result = (obs_scene){0};
    for (uint32_t i = 0; i < scene->object_count; i++) {
        occ_box box = scale_box(&scene->objects[i], factor);
        obs_add_object(result, &box);
    }
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        occ_box box = scale_box(&scene->occluders[i].box, factor);
        obs_add_occluder(result, &box, scene->occluders[i].owner);
    }
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        occ_sheet sheet = scale_sheet(&scene->sheets[i].sheet, factor);
        obs_add_sheet(result, &sheet, scene->sheets[i].owner);
    }
    for (uint32_t i = 0; i < scene->frame_count; i++) {
        obs_frame frame = scale_frame(&scene->frames[i], factor);
        obs_add_frame(result, &frame);
    }
    if (!result->out_of_memory) return true;
    obs_free(result);
    return false;
}

bool error_scene_cut(const obs_scene *scene, const uint32_t *frames, uint32_t count,
                     obs_scene *part)
{
    *part = *scene;
    part->frames = calloc((size_t)count + 1, sizeof *part->frames);
    if (!part->frames) return false;
    part->frame_count = part->frame_capacity = count;
    for (uint32_t i = 0; i < count; i++)
        part->frames[i] = scene->frames[frames[i]];
    return true;
}

static uint64_t add_word(uint64_t hash, uint32_t word)
{
    for (int i = 0; i < 4; i++) {
        hash ^= word >> 8 * i & 0xff;
        hash *= UINT64_C(0x100000001b3);
    }
    return hash;
}

static uint64_t add_floats(uint64_t hash, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t word;
        memcpy(&word, &values[i], sizeof word);
        hash = add_word(hash, word);
    }
    return hash;
}

static uint64_t add_box(uint64_t hash, const occ_box *box)
{
    hash = add_floats(hash, box->center, 3);
    for (int k = 0; k < 3; k++)
        hash = add_floats(hash, box->axis[k], 3);
    return hash;
}

static uint64_t add_sheet(uint64_t hash, const obs_sheet *from)
{
    hash = add_word(add_word(hash, from->sheet.corner_count), (uint32_t)from->sheet.sides);
    return add_word(add_floats(hash, from->sheet.corner[0], 3u * from->sheet.corner_count),
                    from->owner);
}

uint64_t error_scene_identity(const obs_scene *scene)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    hash = add_word(hash, scene->object_count);
    hash = add_word(hash, scene->occluder_count);
    hash = add_word(hash, scene->frame_count);
    for (uint32_t i = 0; i < scene->object_count; i++)
        hash = add_box(hash, &scene->objects[i]);
    for (uint32_t i = 0; i < scene->occluder_count; i++)
        hash = add_word(add_box(hash, &scene->occluders[i].box), scene->occluders[i].owner);
    if (scene->sheet_count > 0) hash = add_word(hash, scene->sheet_count); // as before without
    for (uint32_t i = 0; i < scene->sheet_count; i++)
        hash = add_sheet(hash, &scene->sheets[i]);
    for (uint32_t i = 0; i < scene->frame_count; i++) {
        const obs_frame *frame = &scene->frames[i];
        hash = add_floats(add_floats(hash, frame->eye, 3), frame->dir, 3);
        hash = add_floats(add_floats(hash, frame->view, 16), frame->proj, 16);
    }
    return hash;
}
