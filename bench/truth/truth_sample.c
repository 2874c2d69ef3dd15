// SPDX-License-Identifier: Apache-2.0
#include "truth_sample.h"

#include "truth_buffer.h"
#include "truth_rays.h"

#include <stdlib.h>

// Everything that lives while a frame is sampled.
typedef struct sampler {
    const obs_scene *scene;
    truth_view view;
    truth_set objects, occluders;
    truth_tree tree;
    uint32_t *samples;
    truth_verdict *verdicts;
} sampler;

static bool add(truth_set *set, const truth_solid *solid)
{
    if (set->count == set->capacity) {
        uint32_t wanted = set->capacity < 1024 ? 1024 : 2 * set->capacity;
        truth_solid *larger = realloc(set->solids, wanted * sizeof *larger);
        if (!larger) return false;
        set->solids = larger;
        set->capacity = wanted;
    }
    set->solids[set->count++] = *solid;
    return true;
}

static bool add_box(const truth_view *view, truth_set *set, const occ_box *box,
                    const truth_outline *outline, uint32_t owner)
{
    truth_solid solids[TRUTH_MAX_SOLIDS];
    int count = truth_solids_of(view, box, solids);
    for (int i = 0; i < count; i++) {
        solids[i].owner = owner;
        solids[i].outline = *outline;
        if (!add(set, &solids[i])) return false;
    }
    return true;
}

static bool add_sheet(const truth_view *view, truth_set *set, const obs_sheet *from)
{
    for (uint32_t t = 0; t + 2 < from->sheet.corner_count; t++) {
        truth_solid solid = {.owner = from->owner};
        if (truth_triangle_of(view, &from->sheet, t, &solid) &&
            truth_outline_triangle(view, solid.corner, &solid.outline) && !add(set, &solid))
            return false;
    }
    return true;
}

static int compare_depth(const void *a, const void *b)
{
    const truth_solid *x = a, *y = b;
    return (x->outline.depth > y->outline.depth) - (x->outline.depth < y->outline.depth);
}

// A point in the frustum is hidden by what is in the frustum alone, for both are convex.
static bool gather(sampler *s)
{
    truth_outline outline;
    for (uint32_t i = 0; i < s->scene->occluder_count; i++) {
        const obs_occluder *occluder = &s->scene->occluders[i];
        if (truth_outline_box(&s->view, &occluder->box, &outline) &&
            !add_box(&s->view, &s->occluders, &occluder->box, &outline, occluder->owner))
            return false;
    }
    for (uint32_t i = 0; i < s->scene->sheet_count; i++)
        if (!add_sheet(&s->view, &s->occluders, &s->scene->sheets[i])) return false;
    for (uint32_t i = 0; i < s->scene->object_count; i++) {
        const occ_box *box = &s->scene->objects[i];
        bool is_inside = truth_outline_box(&s->view, box, &outline);
        s->verdicts[i] = (truth_verdict){.flags = is_inside ? TRUTH_IN_FRUSTUM : 0};
        if (is_inside && !add_box(&s->view, &s->objects, box, &outline, i)) return false;
    }
    if (s->occluders.count > 0)
        qsort(s->occluders.solids, s->occluders.count, sizeof(truth_solid), compare_depth);
    if (s->objects.count > 0)
        qsort(s->objects.solids, s->objects.count, sizeof(truth_solid), compare_depth);
    return true;
}

static void send_rays(sampler *s)
{
    enum { RUN = 64 };
    uint32_t count = s->scene->object_count, runs = count / RUN + 1;
#ifdef _OPENMP
#pragma omp parallel for default(none) shared(s, count, runs) schedule(dynamic, 1)
#endif
    for (uint32_t r = 0; r < runs; r++) {
        uint32_t hint = TRUTH_NONE;
        for (uint32_t i = r * RUN; i < count && i < (r + 1) * RUN; i++) {
            truth_verdict *verdict = &s->verdicts[i];
            verdict->samples = s->samples[i];
            if (verdict->flags == 0 || verdict->samples > 0) continue;
            verdict->rays = truth_count_rays(&s->view, &s->tree, &s->scene->objects[i], i, &hint);
        }
    }
}

static bool run(sampler *s)
{
    s->samples = calloc((size_t)s->scene->object_count + 1, sizeof *s->samples);
    if (!s->samples || !gather(s) ||
        !truth_count_samples(&s->view, &s->occluders, &s->objects, s->samples) ||
        !truth_tree_make(&s->tree, s->occluders.solids, s->occluders.count))
        return false;
    send_rays(s);
    return true;
}

const char *truth_sample(const obs_scene *scene, uint32_t frame, uint32_t width, uint32_t height,
                         truth_verdict *verdicts)
{
    sampler s = {.scene = scene, .verdicts = verdicts};
    if (!truth_view_make(&s.view, &scene->frames[frame], (int)width, (int)height))
        return "its camera has no eye or no direction of view";
    bool good = run(&s);
    truth_tree_free(&s.tree);
    free(s.objects.solids);
    free(s.occluders.solids);
    free(s.samples);
    return good ? NULL : "not enough memory";
}
