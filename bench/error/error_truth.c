// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "error_truth.h"

#include "error_scene.h"
#include "progress.h"
#include "truth_sample.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 3, EVERY = 20 };

static uint32_t frame_count(const obs_scene *scene)
{
    uint32_t count = (scene->frame_count + EVERY - 1) / EVERY;
    return count < FRAMES ? count : FRAMES;
}

static bool sample(const error_truths *truths, const char *name, const obs_scene *scene,
                   truth_result *truth)
{
    const char *complaint = NULL;
    if (!truth_create(truth, scene->object_count, frame_count(scene)))
        complaint = "not enough memory";
    truth->width = truths->width;
    truth->height = truths->height;
    progress_begin("truth", truth->frame_count);
    for (uint32_t row = 0; row < truth->frame_count && !complaint; row++) {
        truth->frames[row] = row * EVERY;
        complaint = truth_sample(scene, row * EVERY, truths->width, truths->height,
                                 truth->verdicts + (size_t)row * scene->object_count);
        progress_step(row + 1);
    }
    progress_end();
    if (!complaint) return true;
    fprintf(stderr, "occlude-bench: %s: no truth: %s\n", name, complaint);
    truth_free(truth);
    return false;
}

static bool fits(const error_truths *truths, const truth_result *truth, const obs_scene *scene)
{
    if (truth->width != truths->width || truth->height != truths->height ||
        truth->object_count != scene->object_count || truth->frame_count != frame_count(scene))
        return false;
    for (uint32_t row = 0; row < truth->frame_count; row++)
        if (truth->frames[row] != row * EVERY) return false;
    return true;
}

static bool read_or_sample(const error_truths *truths, const char *path, const char *name,
                           const obs_scene *scene, truth_result *truth)
{
    if (access(path, F_OK) == 0 && truth_read(path, truth)) {
        if (fits(truths, truth, scene)) return true;
        truth_free(truth);
    }
    if (!sample(truths, name, scene, truth)) return false;
    if (truth_write(path, truth)) return true;
    truth_free(truth);
    return false;
}

bool error_truth(const error_truths *truths, const char *name, const obs_scene *scene,
                 truth_result *truth)
{
    *truth = (truth_result){0};
    size_t size = strlen(truths->folder) + strlen(name) + 32;
    char *path = malloc(size);
    if (!path) return false;
    snprintf(path, size, "%s/%s-%016" PRIx64 ".tru", truths->folder, name,
             error_scene_identity(scene));
    bool good = read_or_sample(truths, path, name, scene, truth);
    free(path);
    return good;
}

bool error_truth_cut(const truth_result *truth, truth_result *part)
{
    *part = *truth;
    part->frames = calloc((size_t)truth->frame_count + 1, sizeof *part->frames);
    if (!part->frames) return false;
    for (uint32_t row = 0; row < truth->frame_count; row++)
        part->frames[row] = row;
    return true;
}
