// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "vis.h"

#include <occlude/occlude.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Everything that lives while a frame is decided.
typedef struct decider {
    picture_facts *facts;
    occ_scene *scene;
    occ_view *view;
    occ_camera_desc camera;
    double eye[3];
    occ_object *objects;
    occ_occluder *occluders; // handles, in the file's order
} decider;

static bool succeeded(occ_result result, const char *what)
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

static bool add_occluders(decider *d)
{
    const obs_scene *file = d->facts->scene;
    size_t count = (size_t)file->occluder_count;
    occ_box *boxes = malloc((count + 1) * sizeof *boxes);
    occ_object *owners = malloc((count + 1) * sizeof *owners);
    bool good = boxes && owners;
    for (size_t i = 0; good && i < count; i++) {
        boxes[i] = file->occluders[i].box;
        owners[i] = d->objects[file->occluders[i].owner];
    }
    good = good ? succeeded(occ_scene_add_occluders(d->scene, boxes, owners, count, d->occluders),
                            "adding the occluders")
                : out_of_memory();
    free(boxes);
    free(owners);
    return good;
}

static bool build(decider *d)
{
    const obs_scene *file = d->facts->scene;
    const occ_scene_desc desc = {.object_count = file->object_count,
                                 .occluder_count = file->occluder_count};
    d->objects = calloc((size_t)file->object_count + 1, sizeof *d->objects);
    d->occluders = calloc((size_t)file->occluder_count + 1, sizeof *d->occluders);
    if (!d->objects || !d->occluders) return out_of_memory();
    return succeeded(occ_scene_create(&desc, &d->scene), "making the scene") &&
           succeeded(occ_scene_add_many(d->scene, file->objects, file->object_count, d->objects),
                     "adding the objects") &&
           add_occluders(d) && succeeded(occ_scene_commit(d->scene), "committing the scene") &&
           succeeded(occ_view_create(NULL, &d->view), "making a view");
}

static bool cull(decider *d, occ_method method)
{
    const occ_cull_desc knobs = {.method = method};
    return succeeded(occ_cull(d->view, d->scene, &d->camera, &knobs), "culling");
}

// Objects that the latest result shows rise from one verdict to another.
static void raise_visible(decider *d, picture_verdict from, picture_verdict to)
{
    for (uint32_t i = 0; i < d->facts->scene->object_count; i++)
        if (d->facts->verdicts[i] == from && occ_view_is_visible(d->view, d->objects[i]))
            d->facts->verdicts[i] = (uint8_t)to;
}

// Which place in the file each handle's index stands for.
static uint32_t *invert_occluders(const decider *d)
{
    uint32_t count = d->facts->scene->occluder_count, most = 0;
    for (uint32_t i = 0; i < count; i++)
        if (d->occluders[i].index > most) most = d->occluders[i].index;
    uint32_t *places = calloc((size_t)most + 1, sizeof *places);
    for (uint32_t i = 0; places && i < count; i++)
        places[d->occluders[i].index] = i;
    return places;
}

static bool read_used(decider *d)
{
    picture_facts *facts = d->facts;
    size_t capacity = facts->scene->occluder_count;
    occ_occluder *used = malloc((capacity + 1) * sizeof *used);
    uint32_t *places = invert_occluders(d);
    facts->used = malloc((capacity + 1) * sizeof *facts->used);
    bool good = used && places && facts->used;
    if (good)
        good = succeeded(occ_view_read_occluders(d->view, used, capacity, &facts->used_count),
                         "reading the occluders");
    else
        out_of_memory();
    for (size_t i = 0; good && i < facts->used_count; i++)
        facts->used[i] = places[used[i].index];
    facts->used_known = good;
    free(used);
    free(places);
    return good;
}

// Tells apart what several occluders hide together, and finds what is outside after all.
static bool tell_together(decider *d)
{
    uint8_t *verdicts = d->facts->verdicts;
    for (uint32_t i = 0; i < d->facts->scene->object_count; i++) {
        occ_fate fate;
        size_t count;
        if (verdicts[i] != PICTURE_HIDDEN) continue;
        occ_result result =
            occ_view_explain(d->view, d->scene, d->objects[i], &fate, NULL, 0, &count);
        if (result != OCC_ERROR_BUFFER_TOO_SMALL && !succeeded(result, "explaining an object"))
            return false;
        if (fate == OCC_FATE_OUTSIDE) verdicts[i] = PICTURE_OUTSIDE;
        if (count > 1) verdicts[i] = PICTURE_TOGETHER;
    }
    return true;
}

static bool explain(decider *d, uint32_t object)
{
    picture_facts *facts = d->facts;
    size_t capacity = facts->scene->occluder_count;
    occ_occluder *culprits = malloc((capacity + 1) * sizeof *culprits);
    uint32_t *places = invert_occluders(d);
    facts->culprits = malloc((capacity + 1) * sizeof *facts->culprits);
    bool good = culprits && places && facts->culprits;
    occ_fate fate = OCC_FATE_VISIBLE;
    if (good)
        good = succeeded(occ_view_explain(d->view, d->scene, d->objects[object], &fate, culprits,
                                          capacity, &facts->culprit_count),
                         "explaining the object");
    else
        out_of_memory();
    for (size_t i = 0; good && i < facts->culprit_count; i++)
        facts->culprits[i] = places[culprits[i].index];
    if (fate == OCC_FATE_OUTSIDE) facts->verdicts[object] = PICTURE_OUTSIDE;
    facts->explained = good;
    facts->object = object;
    free(culprits);
    free(places);
    return good;
}

static bool read_verdicts(decider *d, uint32_t frame, const char *path)
{
    vis_result file;
    const obs_scene *scene = d->facts->scene;
    if (!vis_read(path, &file)) return false;
    bool good = file.object_count == scene->object_count && frame < file.frame_count;
    if (!good)
        fprintf(stderr,
                "occlude-bench: %s: %u objects and %u frames, expected %u objects and a frame %u\n",
                path, file.object_count, file.frame_count, scene->object_count, frame);
    for (uint32_t i = 0; good && i < scene->object_count; i++)
        if (vis_is_visible(&file, frame, i)) d->facts->verdicts[i] = PICTURE_VISIBLE;
    vis_free(&file);
    return good;
}

static bool decide(decider *d, const picture_wish *wish)
{
    if (!build(d) || !cull(d, OCC_METHOD_FRUSTUM)) return false;
    raise_visible(d, PICTURE_OUTSIDE, PICTURE_HIDDEN);
    if (wish->vis_path) return read_verdicts(d, wish->frame, wish->vis_path);
    if (!cull(d, wish->fused ? OCC_METHOD_FUSED : OCC_METHOD_SINGLE)) return false;
    raise_visible(d, PICTURE_HIDDEN, PICTURE_VISIBLE);
    d->facts->fused = wish->fused;
    if (wish->fused && !tell_together(d)) return false;
    return read_used(d) && (!wish->explain || explain(d, wish->object));
}

bool picture_decide(const obs_scene *scene, const picture_wish *wish, picture_facts *facts)
{
    *facts = (picture_facts){.scene = scene, .frame = &scene->frames[wish->frame]};
    facts->verdicts = calloc((size_t)scene->object_count + 1, sizeof *facts->verdicts);
    decider d = {.facts = facts};
    for (int k = 0; k < 3; k++)
        d.eye[k] = (double)facts->frame->eye[k];
    d.camera.eye = d.eye;
    obs_view_projection(facts->frame, d.camera.view_projection);
    bool good = facts->verdicts ? decide(&d, wish) : out_of_memory();
    for (uint32_t i = 0; good && i < scene->object_count; i++)
        facts->counts[facts->verdicts[i]]++;
    occ_view_destroy(d.view);
    occ_scene_destroy(d.scene);
    free(d.objects);
    free(d.occluders);
    if (!good) picture_facts_free(facts);
    return good;
}

void picture_facts_free(picture_facts *facts)
{
    free(facts->verdicts);
    free(facts->used);
    free(facts->culprits);
    *facts = (picture_facts){0};
}
