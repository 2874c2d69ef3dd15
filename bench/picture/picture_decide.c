// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "loaded.h"
#include "vis.h"

#include <occlude/occlude.h>
#include <stdio.h>
#include <stdlib.h>

// Everything that lives while a frame is decided.
typedef struct decider {
    picture_facts *facts;
    loaded_scene loaded;
    occ_view *view;
    occ_camera_desc camera;
    double eye[3];
} decider;

static bool out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

static bool build(decider *d)
{
    return loaded_build(d->facts->scene, &d->loaded) &&
           loaded_succeeded(occ_view_create(NULL, &d->view), "making a view");
}

static bool cull(decider *d, occ_method method)
{
    const occ_cull_desc knobs = {.method = method};
    return loaded_succeeded(occ_cull(d->view, d->loaded.scene, &d->camera, &knobs), "culling");
}

// Objects that the latest result shows rise from one verdict to another.
static void raise_visible(decider *d, picture_verdict from, picture_verdict to)
{
    for (uint32_t i = 0; i < d->facts->scene->object_count; i++)
        if (d->facts->verdicts[i] == from && occ_view_is_visible(d->view, d->loaded.objects[i]))
            d->facts->verdicts[i] = (uint8_t)to;
}

static bool read_used(decider *d)
{
    picture_facts *facts = d->facts;
    size_t capacity = obs_occluder_total(facts->scene);
    occ_occluder *used = malloc((capacity + 1) * sizeof *used);
    facts->used = malloc((capacity + 1) * sizeof *facts->used);
    bool good = used && facts->used;
    if (good)
        good =
            loaded_succeeded(occ_view_read_occluders(d->view, used, capacity, &facts->used_count),
                             "reading the occluders");
    else
        out_of_memory();
    for (size_t i = 0; good && i < facts->used_count; i++)
        facts->used[i] = d->loaded.places[used[i].index];
    facts->used_known = good;
    free(used);
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
        occ_result result = occ_view_explain(d->view, d->loaded.scene, d->loaded.objects[i], &fate,
                                             NULL, 0, &count);
        if (result != OCC_ERROR_BUFFER_TOO_SMALL &&
            !loaded_succeeded(result, "explaining an object"))
            return false;
        if (fate == OCC_FATE_OUTSIDE) verdicts[i] = PICTURE_OUTSIDE;
        if (count > 1) verdicts[i] = PICTURE_TOGETHER;
    }
    return true;
}

static bool explain(decider *d, uint32_t object)
{
    picture_facts *facts = d->facts;
    occ_fate fate;
    facts->culprits =
        malloc(((size_t)obs_occluder_total(facts->scene) + 1) * sizeof *facts->culprits);
    if (!facts->culprits) return out_of_memory();
    if (!loaded_explain(&d->loaded, d->view, object, &fate, facts->culprits, &facts->culprit_count))
        return false;
    if (fate == OCC_FATE_OUTSIDE) facts->verdicts[object] = PICTURE_OUTSIDE;
    facts->explained = true;
    facts->object = object;
    return true;
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
    loaded_free(&d.loaded);
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
