// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "options.h"
#include "progress.h"
#include "timing.h"
#include "truth_sample.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char truth_usage[] =
    "usage: occlude-bench truth F.obs --out T.tru [options]\n"
    "\n"
    "Finds out which objects can truly be seen, without the library: a ray in double through the\n"
    "middle of every pixel of a large viewport, and more rays to every object that none of them\n"
    "shows. docs/truth.md says what the answer is worth.\n"
    "\n"
    "  --out T.tru    where to write it, for `occlude-bench compare`\n"
    "  --frames LIST  which frames, as 0,20,40 (default: these, as far as the scene has them)\n"
    "  --size WxH     the viewport (default 4096x2304)\n"
    "\n"
    "Example: occlude-bench truth city.obs --frames 0,20,40 --out city.tru\n";

typedef struct truth_arguments {
    const char *scene, *out, *frames, *size;
    options_extent extent;
} truth_arguments;

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_truth(int argc, char **argv, truth_arguments *arguments)
{
    *arguments = (truth_arguments){.size = "4096x2304"};
    const options_entry entries[] = {{"--out", OPTIONS_TEXT, &arguments->out},
                                     {"--frames", OPTIONS_TEXT, &arguments->frames},
                                     {"--size", OPTIONS_TEXT, &arguments->size},
                                     {NULL, OPTIONS_FLAG, NULL}};
    int status = options_parse_scene(argc, argv, entries, &arguments->scene);
    if (status) return status;
    if (!arguments->out) return options_complain(argv[0], "expected --out T.tru");
    const options_extent least = {1, 1};
    if (!options_size(arguments->size, least, TRUTH_MAX_SIDE, &arguments->extent))
        return options_complain(argv[0], "expected --size as 4096x2304, 16384x16384 at most");
    return 0;
}

static const char *choose_frames(const truth_arguments *arguments, uint32_t frame_count,
                                 uint32_t *list, uint32_t *count)
{
    if (arguments->frames)
        return options_ascending(arguments->frames, frame_count, list, count)
                   ? NULL
                   : "expected --frames as 0,20,40: ascending, and in the scene";
    for (*count = 0; *count < 3 && 20 * *count < frame_count; (*count)++)
        list[*count] = 20 * *count;
    return *count > 0 ? NULL : "the scene has no frames";
}

static bool sample_frames(const truth_arguments *arguments, const obs_scene *scene,
                          truth_result *result)
{
    progress_begin("truth", result->frame_count);
    const char *complaint = NULL;
    uint32_t row = 0;
    for (; row < result->frame_count && !complaint; row++) {
        complaint = truth_sample(scene, result->frames[row], result->width, result->height,
                                 result->verdicts + (size_t)row * scene->object_count);
        progress_step(row + 1);
    }
    progress_end();
    if (complaint)
        fprintf(stderr, "occlude-bench: %s: frame %u: %s\n", arguments->scene,
                result->frames[row - 1], complaint);
    return !complaint;
}

static void print_truth(const truth_result *result, double seconds)
{
    uint64_t in_frustum = 0, visible = 0, by_rays = 0;
    for (size_t i = 0; i < (size_t)result->object_count * result->frame_count; i++) {
        const truth_verdict *verdict = &result->verdicts[i];
        in_frustum += verdict->flags & TRUTH_IN_FRUSTUM;
        visible += truth_is_visible(verdict);
        by_rays += verdict->rays > 0;
    }
    double frames = result->frame_count;
    printf("frames=%u objects=%u in_frustum=%.1f visible=%.1f by_rays=%.1f seconds=%.2f\n",
           result->frame_count, result->object_count, (double)in_frustum / frames,
           (double)visible / frames, (double)by_rays / frames, seconds);
}

// Samples and writes; `list` holds the frames. Returns the exit status.
static int make_truth(const truth_arguments *arguments, const obs_scene *scene,
                      const uint32_t *list, uint32_t count)
{
    truth_result result;
    if (!truth_create(&result, scene->object_count, count)) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return 1;
    }
    result.width = arguments->extent.width;
    result.height = arguments->extent.height;
    memcpy(result.frames, list, count * sizeof *list);
    double begin = timing_now();
    bool good = sample_frames(arguments, scene, &result) && truth_write(arguments->out, &result);
    if (good) print_truth(&result, (timing_now() - begin) / 1e3);
    truth_free(&result);
    return good ? 0 : 1;
}

int bench_truth(int argc, char **argv)
{
    truth_arguments arguments;
    int status = parse_truth(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(truth_usage, stdout) < 0;
    if (status != 0) return status;
    obs_scene scene;
    if (!obs_read(arguments.scene, &scene)) return 1;
    uint32_t count, *list = malloc(((size_t)scene.frame_count + 1) * sizeof *list);
    const char *complaint = "not enough memory";
    if (list) complaint = choose_frames(&arguments, scene.frame_count, list, &count);
    if (complaint) {
        fprintf(stderr, "occlude-bench: %s: %s\n", arguments.scene, complaint);
        status = 1;
    } else {
        status = make_truth(&arguments, &scene, list, count);
    }
    free(list);
    obs_free(&scene);
    return status;
}
