// SPDX-License-Identifier: Apache-2.0
#include "meta.h"

#include "judge.h"
#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *get_memory(size_t count, size_t size)
{
    void *memory = calloc(count + 1, size);
    KIT_CHECK(memory, "out of memory");
    return memory;
}

// --- scenes --------------------------------------------------------------------------------------

static double quantized(double x)
{
    return rint(x * 256.0) / 256.0;
}

static void quantize(occ_box *box)
{
    for (int j = 0; j < 3; j++)
        box->center[j] = (float)quantized((double)box->center[j]);
}

static meta_camera camera_of(const obs_frame *frame)
{
    meta_camera camera = {.eye = {0}};
    obs_frame there = *frame;
    for (int j = 0; j < 3; j++)
        camera.eye[j] = quantized((double)frame->eye[j]);
    for (int r = 0; r < 3; r++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++)
            sum += (double)frame->view[4 * j + r] * camera.eye[j];
        there.view[12 + r] = (float)-sum;
    }
    obs_view_projection(&there, camera.desc.view_projection);
    return camera;
}

static meta empty(uint32_t objects, uint32_t occluders)
{
    meta m = {.object_count = objects, .occluder_count = occluders};
    m.objects = get_memory(objects, sizeof *m.objects);
    m.occluders = get_memory(occluders, sizeof *m.occluders);
    return m;
}

meta meta_scene(const char *name, uint32_t count, uint64_t seed)
{
    obs_scene file;
    KIT_CHECK(scenes_make(name, count, seed, &file), "no scene %s", name);
    meta m = empty(file.object_count, file.occluder_count);
    for (uint32_t i = 0; i < m.object_count; i++) {
        m.objects[i] = file.objects[i];
        quantize(&m.objects[i]);
    }
    for (uint32_t k = 0; k < m.occluder_count; k++) {
        m.occluders[k] = (world_occluder){file.occluders[k].box, (int)file.occluders[k].owner};
        quantize(&m.occluders[k].box);
    }
    for (uint32_t c = 0; c < META_CAMERAS; c++)
        m.cameras[c] = camera_of(&file.frames[c * (file.frame_count / META_CAMERAS)]);
    obs_free(&file);
    return m;
}

meta meta_copy(const meta *m)
{
    meta copy = empty(m->object_count, m->occluder_count);
    memcpy(copy.objects, m->objects, m->object_count * sizeof *m->objects);
    memcpy(copy.occluders, m->occluders, m->occluder_count * sizeof *m->occluders);
    memcpy(copy.cameras, m->cameras, sizeof copy.cameras);
    return copy;
}

void meta_free(meta *m)
{
    free(m->objects);
    free(m->occluders);
    *m = (meta){.objects = NULL};
}

// --- in other words ------------------------------------------------------------------------------

const meta_map meta_identity = {{0, 1, 2}, {1, 1, 1}, 1, {0, 0, 0}, false};

static void map_vector(const meta_map *map, float v[3])
{
    const float old[3] = {v[0], v[1], v[2]};
    for (int j = 0; j < 3; j++)
        v[j] = map->factor * map->sign[j] * old[map->from[j]];
}

static void map_box(const meta_map *map, occ_box *box)
{
    map_vector(map, box->center);
    for (int k = 0; k < 3; k++)
        map_vector(map, box->axis[k]);
    for (int j = 0; j < 3; j++) {
        double there = (double)box->center[j] + map->shift[j];
        box->center[j] = (float)there;
        KIT_CHECK((double)box->center[j] == there, "the shift is not exact");
    }
}

static void map_camera(const meta_map *map, meta_camera *camera)
{
    const float *old = camera->desc.view_projection;
    float matrix[16];
    for (int r = 0; r < 4; r++) {
        double d = (double)old[12 + r];
        for (int j = 0; j < 3; j++) {
            float there = map->sign[j] * old[4 * map->from[j] + r] / map->factor;
            matrix[4 * j + r] = there;
            if (!map->by_origin) d -= (double)there * map->shift[j];
        }
        matrix[12 + r] = (float)d;
    }
    memcpy(camera->desc.view_projection, matrix, sizeof matrix);
    const double eye[3] = {camera->eye[0], camera->eye[1], camera->eye[2]};
    for (int j = 0; j < 3; j++) {
        camera->eye[j] =
            (double)map->factor * (double)map->sign[j] * eye[map->from[j]] + map->shift[j];
        camera->origin[j] = map->by_origin ? map->shift[j] : 0.0;
    }
}

meta meta_mapped(const meta *m, const meta_map *map)
{
    meta mapped = meta_copy(m);
    for (uint32_t i = 0; i < m->object_count; i++)
        map_box(map, &mapped.objects[i]);
    for (uint32_t k = 0; k < m->occluder_count; k++)
        map_box(map, &mapped.occluders[k].box);
    for (uint32_t c = 0; c < META_CAMERAS; c++)
        map_camera(map, &mapped.cameras[c]);
    return mapped;
}

uint32_t *meta_order(uint32_t count, uint64_t seed)
{
    kit_random random = {seed};
    uint32_t *order = get_memory(count, sizeof *order);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = kit_below(&random, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
    return order;
}

meta meta_objects_in_order(const meta *m, const uint32_t *order)
{
    meta other = meta_copy(m);
    uint32_t *place = get_memory(m->object_count, sizeof *place);
    for (uint32_t i = 0; i < m->object_count; i++) {
        other.objects[i] = m->objects[order[i]];
        place[order[i]] = i;
    }
    for (uint32_t k = 0; k < m->occluder_count; k++)
        if (m->occluders[k].owner >= 0)
            other.occluders[k].owner = (int)place[m->occluders[k].owner];
    free(place);
    return other;
}

meta meta_occluders_in_order(const meta *m, const uint32_t *order)
{
    meta other = meta_copy(m);
    for (uint32_t k = 0; k < m->occluder_count; k++)
        other.occluders[k] = m->occluders[order[k]];
    return other;
}

// --- answers -------------------------------------------------------------------------------------

occ_scene *meta_build(const meta *m)
{
    return world_scene(m->objects, m->object_count, m->occluders, m->occluder_count, 0);
}

static occ_camera_desc desc_of(const meta_camera *camera)
{
    occ_camera_desc desc = camera->desc;
    if (!camera->derived) desc.eye = camera->eye;
    desc.origin = camera->origin;
    return desc;
}

bool *meta_seen(occ_view *view, const occ_scene *scene, const meta *m, uint32_t c,
                const occ_cull_desc *knobs)
{
    occ_camera_desc desc = desc_of(&m->cameras[c]);
    kit_cull(view, scene, &desc, knobs);
    bool *seen = get_memory(m->object_count, sizeof *seen);
    for (uint32_t i = 0; i < m->object_count; i++)
        seen[i] = world_sees(view, i);
    return seen;
}

uint32_t meta_count(const bool *seen, uint32_t count)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += seen[i];
    return sum;
}

static judge *judge_of(const meta *m, uint32_t c)
{
    occ_camera_desc desc = desc_of(&m->cameras[c]);
    judge *j = judge_of_camera(&desc);
    KIT_CHECK(j, "no eye");
    occ_box *boxes = get_memory(m->occluder_count, sizeof *boxes);
    int *owners = get_memory(m->occluder_count, sizeof *owners);
    for (uint32_t k = 0; k < m->occluder_count; k++) {
        boxes[k] = m->occluders[k].box;
        owners[k] = m->occluders[k].owner;
    }
    judge_set_occluders(j, boxes, owners, m->occluder_count);
    free(boxes);
    free(owners);
    return j;
}

meta_difference meta_compare(const meta *m, uint32_t c, const bool *before, const bool *now,
                             uint32_t every)
{
    meta_difference d = {0, 0, 0};
    judge *j = NULL;
    uint32_t out = 0;
    for (uint32_t i = 0; i < m->object_count; i++) {
        d.gone += before[i] && !now[i];
        d.come += now[i] && !before[i];
        out += !now[i];
        bool differs = before[i] != now[i];
        if (!differs && (now[i] || !every || out % every != 0)) continue;
        if (!j) j = judge_of(m, c);
        d.judged++;
        KIT_CHECK(!judge_sees(j, &m->objects[i], (int)i), "camera %u: object %u is left out %s", c,
                  i, now[i] ? "before" : "now");
    }
    judge_free(j);
    return d;
}
