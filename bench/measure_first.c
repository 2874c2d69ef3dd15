// SPDX-License-Identifier: Apache-2.0
#include "measure_first.h"

#include "measure_build.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>

// What a first frame is handed over into: as in every other measurement, not part of the time.
typedef struct first_output {
    uint32_t *mask, *list;
    size_t objects;
} first_output;

static occ_result cull_first(occ_view *view, const occ_scene *scene, const obs_frame *frame,
                             const occ_cull_desc *knobs, const first_output *output, double *ms)
{
    size_t count, words = OCC_MASK_WORDS(output->objects);
    double start = timing_now();
    occ_result result = measure_cull(view, scene, frame, knobs);
    if (result == OCC_SUCCESS) result = occ_view_read_mask(view, output->mask, words, &count);
    if (result == OCC_SUCCESS)
        result = occ_view_read_visible(view, output->list, output->objects, &count);
    *ms = timing_now() - start;
    return result;
}

static occ_result build_and_cull(const measure_settings *settings, const obs_scene *file,
                                 const first_output *output, double *ms)
{
    occ_cull_desc knobs = settings->knobs;
    occ_view_desc desc = {.threads = settings->threads};
    if (!measure_method(settings->method, &knobs.method) ||
        !measure_backend(settings->backend, &desc.backend))
        return OCC_ERROR_INVALID_ARGUMENT;
    const occ_scene_desc scene_desc = {.threads = settings->threads};
    measure_build build;
    occ_view *view = NULL;
    occ_result result = measure_building(file, &scene_desc, 1, &build);
    if (result == OCC_SUCCESS) result = occ_view_create(&desc, &view);
    if (result == OCC_SUCCESS)
        result = cull_first(view, build.scene, &file->frames[0], &knobs, output, ms);
    occ_view_destroy(view);
    occ_scene_destroy(build.scene);
    return result;
}

bool measure_first_frame(const measure_settings *settings, const obs_scene *file, uint32_t scenes,
                         double *ms)
{
    first_output output = {calloc(OCC_MASK_WORDS(file->object_count) + 1, sizeof *output.mask),
                           calloc((size_t)file->object_count + 1, sizeof *output.list),
                           file->object_count};
    double *times = calloc((size_t)scenes + 1, sizeof *times);
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    *ms = 0;
    if (output.mask && output.list && times) {
        result = OCC_SUCCESS;
        for (uint32_t i = 0; result == OCC_SUCCESS && file->frame_count > 0 && i < scenes; i++)
            result = build_and_cull(settings, file, &output, &times[i]);
        if (file->frame_count > 0) *ms = timing_median(times, scenes);
    }
    free(output.mask);
    free(output.list);
    free(times);
    if (result == OCC_SUCCESS) return true;
    fprintf(stderr, "occlude-bench: the first frame: %s (%s)\n", occ_result_message(result),
            occ_result_name(result));
    return false;
}
