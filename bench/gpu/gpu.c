// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "build_info.h"
#include "gpu.h"
#include "measure.h"
#include "options.h"
#include "scenes.h"

#include <inttypes.h>
#include <stdio.h>

static const char gpu_usage[] =
    "usage: occlude-bench gpu F.obs [options]\n"
    "       occlude-bench gpu NAME COUNT SEED [options]\n"
    "\n"
    "Culls every frame of a scene, or of a named scene made in memory, with a table on an OpenCL\n"
    "device: every object is tested there, without an octree. The last line printed sums it up.\n"
    "\n"
    "  --repeat R         timed culls of each frame (default 20)\n"
    "  --every N          only each N-th frame (default 1)\n"
    "  --arrange          order the objects along an octree's curve first\n"
    "  --move             send all boxes from pinned memory in every frame\n"
    "  --devices N        spread the table over N sub-devices (default 1: the whole device)\n"
    "  --strips N         of the picture, for choosing occluders by as many threads (default 1)\n"
    "  --preset P         fast, balanced (default) or thorough\n"
    "  --method M         fused (default), single or frustum\n"
    "  --min-area A       smallest solid angle at which an occluder is used\n"
    "  --max-occluders N  most occluders used in a frame, 1024 at most\n"
    "  --out R.vis        write the verdicts of every frame\n"
    "\n"
    "A frame's time is from the call until the mask is on the host. Kernels are timed by events;\n"
    "copy_gbs and pinned_gbs are plain copies in the same process.\n"
    "\n"
    "Example: occlude-bench gpu city 1000000 2 --every 6\n";

typedef struct gpu_arguments {
    gpu_settings settings;
    const char *words[3];
    int count;
    const char *preset, *method, *out;
    double min_area;
} gpu_arguments;

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_gpu(int argc, char **argv, gpu_arguments *arguments)
{
    gpu_settings *settings = &arguments->settings;
    settings->repeats = 20;
    settings->every = settings->devices = 1;
    const options_entry entries[] = {
        {"--repeat", OPTIONS_COUNT, &settings->repeats},
        {"--every", OPTIONS_COUNT, &settings->every},
        {"--arrange", OPTIONS_FLAG, &settings->arrange},
        {"--move", OPTIONS_FLAG, &settings->move},
        {"--devices", OPTIONS_COUNT, &settings->devices},
        {"--strips", OPTIONS_COUNT, &settings->strips},
        {"--preset", OPTIONS_TEXT, &arguments->preset},
        {"--method", OPTIONS_TEXT, &arguments->method},
        {"--min-area", OPTIONS_REAL, &arguments->min_area},
        {"--max-occluders", OPTIONS_COUNT, &settings->knobs.max_occluders},
        {"--out", OPTIONS_TEXT, &arguments->out},
        {NULL, OPTIONS_FLAG, NULL}};
    char *words[3];
    int count = options_parse(argc, argv, entries, words, 3);
    if (count == OPTIONS_HELP) return OPTIONS_HELP;
    if (count == OPTIONS_BAD) return 2;
    if (count != 1 && count != 3)
        return options_complain(argv[0], "expected a scene file, or a scene's NAME COUNT SEED");
    for (int i = 0; i < count; i++)
        arguments->words[i] = words[i];
    arguments->count = count;
    settings->knobs.min_area = (float)arguments->min_area;
    if (settings->repeats > 1000) return options_complain(argv[0], "--repeat is 1000 at most");
    if (settings->devices > 16) return options_complain(argv[0], "--devices is 16 at most");
    if (arguments->preset && !measure_preset(arguments->preset, &settings->knobs.preset))
        return options_complain(argv[0], "expected fast, balanced or thorough after --preset");
    if (arguments->method && !measure_method(arguments->method, &settings->knobs.method))
        return options_complain(argv[0], "expected fused, single or frustum after --method");
    if (arguments->out && settings->every != 1)
        return options_complain(argv[0], "--out needs every frame: leave out --every");
    return 0;
}

// Larger scenes than `scene` writes: these need no file.
static bool make_scene(const gpu_arguments *arguments, obs_scene *scene)
{
    *scene = (obs_scene){.object_count = 0};
    if (arguments->count == 1) return obs_read(arguments->words[0], scene);
    const scenes_kind *kind = scenes_find(arguments->words[0]);
    uint64_t count, seed;
    if (!kind || !options_number(arguments->words[1], 1, 200000000, &count) ||
        !options_number(arguments->words[2], 0, UINT64_MAX, &seed)) {
        fputs("occlude-bench gpu: expected a scene's name, COUNT from 1 to 200000000 and SEED\n",
              stderr);
        return false;
    }
    kind->make(scene, (uint32_t)count, seed);
    if (scene->out_of_memory) fputs("occlude-bench gpu: not enough memory\n", stderr);
    return !scene->out_of_memory;
}

static void print_result(const gpu_arguments *arguments, const obs_scene *scene,
                         const gpu_result *result)
{
    build_info_write(stdout, result->device);
    printf("fill_ms=%.1f device_bytes=%" PRIu64 " copy_gbs=%.1f pinned_gbs=%.2f occluders=%.1f\n",
           result->fill_ms, result->device_bytes, result->copy_gbs, result->pinned_gbs,
           result->occluders);
    printf("scene=%s objects=%u frames=%u repeats=%u visible=%.1f mask=%016" PRIx64
           " frame_ms=%.4f p99_ms=%.4f walk_ms=%.4f enqueue_ms=%.4f blocks_ms=%.4f "
           "objects_ms=%.4f fusion_ms=%.4f move_gbs=%.2f\n",
           arguments->words[0], scene->object_count, result->frames, arguments->settings.repeats,
           result->visible, result->hash, result->frame_ms, result->p99_ms, result->walk_ms,
           result->enqueue_ms, result->blocks_ms, result->objects_ms, result->fusion_ms,
           result->move_gbs);
}

int bench_gpu(int argc, char **argv)
{
    gpu_arguments arguments = {.count = 0};
    int status = parse_gpu(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(gpu_usage, stdout) < 0;
    if (status != 0) return status;
    obs_scene scene;
    gpu_result result;
    vis_result masks = {.frame_count = 0};
    bool good = make_scene(&arguments, &scene);
    if (good && arguments.out) good = vis_create(&masks, scene.object_count, scene.frame_count);
    if (good)
        good = gpu_measure(&scene, &arguments.settings, &result, arguments.out ? &masks : NULL);
    if (good && arguments.out) good = vis_write(arguments.out, &masks);
    if (good) print_result(&arguments, &scene, &result);
    vis_free(&masks);
    obs_free(&scene);
    return good ? 0 : 1;
}
