// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "image_report.h"
#include "measure.h"
#include "options.h"
#include "outfile.h"

#include <stdlib.h>
#include <string.h>

// 64 million pixels take two gigabytes, OpenGL's own included.
enum { IMAGE_MOST_SIDE = 8192 };

typedef struct image_arguments {
    const char *scene, *model, *frames, *size, *against, *csv, *pictures;
    const char *method, *backend, *preset;
    division_options division;
    image_wish wish;
    uint32_t every;
    double tolerance;
} image_arguments;

static const char image_usage[] =
    "usage: occlude-bench image F.obs --model MODEL [options]\n"
    "\n"
    "Draws the triangles of a converted model with OpenGL, all of them and those of the objects\n"
    "that culling leaves, and compares the pictures pixel by pixel. Where they differ the object\n"
    "that is missing and the occluders that hid it are named, and both pictures are written.\n"
    "docs/image.md says why the comparison can be trusted.\n"
    "\n"
    "  --model MODEL      what F.obs was converted from\n"
    "  --triangles N, --split W, --up A, --see-through LIST\n"
    "                     as they were given to convert\n"
    "  --frames LIST      which frames, as 0,20,40 (default: all)\n"
    "  --every N          only each N-th frame (default 1)\n"
    "  --size WxH         of the pictures (default 1920x1080)\n"
    "  --method M         fused (default), single, pairwise or frustum\n"
    "  --against W        all (default): compare with all objects drawn; frustum: with those in\n"
    "                     the frustum, so that only what occlusion saves is counted\n"
    "  --backend B        openmp (default), plain, opencl\n"
    "  --threads T        of the openmp backend (default: one to a processor)\n"
    "  --preset P         fast, balanced (default) or thorough\n"
    "  --tolerance T      radians, 0.1 at most: may hide what is visible, and shows how much\n"
    "  --one-sided        leave out triangles seen from behind\n"
    "  --pictures P       names of pictures that differ begin with this (default: F)\n"
    "  --csv F.csv        write a row for each frame\n"
    "\n"
    "Ends with status 3 if a pixel differs. Counts in the last line are sums over the frames,\n"
    "milliseconds are medians; cpu_ms_saved and whole_ms_saved are less the time of culling.\n"
    "\n"
    "Example: occlude-bench image hall.obs --model hall.obj --every 10\n";

// Returns a complaint, or NULL.
static const char *complete_culling(image_arguments *arguments)
{
    image_wish *wish = &arguments->wish;
    if (!measure_method(arguments->method, &wish->knobs.method))
        return "expected frustum, pairwise, single or fused after --method";
    if (!measure_backend(arguments->backend, &wish->backend))
        return "expected plain, openmp or opencl after --backend";
    if (arguments->preset && !measure_preset(arguments->preset, &wish->knobs.preset))
        return "expected fast, balanced or thorough after --preset";
    if (arguments->tolerance > 0.1) return "--tolerance is 0.1 at most";
    wish->knobs.tolerance = (float)arguments->tolerance;
    return NULL;
}

// Returns a complaint, or NULL.
static const char *complete_arguments(image_arguments *arguments)
{
    const options_extent least = {1, 1};
    options_extent extent;
    if (!arguments->model) return "expected --model MODEL";
    if (!options_size(arguments->size, least, IMAGE_MOST_SIDE, &extent))
        return "expected --size as 1920x1080, 8192x8192 at most";
    arguments->wish.gl.width = extent.width;
    arguments->wish.gl.height = extent.height;
    if (strcmp(arguments->against, "all") != 0 && strcmp(arguments->against, "frustum") != 0)
        return "expected all or frustum after --against";
    arguments->wish.against_frustum = strcmp(arguments->against, "frustum") == 0;
    const char *complaint = division_complete(&arguments->division);
    return complaint ? complaint : complete_culling(arguments);
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_image(int argc, char **argv, image_arguments *arguments)
{
    *arguments = (image_arguments){.size = "1920x1080",
                                   .against = "all",
                                   .method = "fused",
                                   .backend = "openmp",
                                   .every = 1,
                                   .division = division_defaults()};
    image_wish *wish = &arguments->wish;
    const options_entry entries[] = {
        {"--model", OPTIONS_TEXT, &arguments->model},
        {"--triangles", OPTIONS_COUNT, &arguments->division.most},
        {"--split", OPTIONS_TEXT, &arguments->division.split},
        {"--up", OPTIONS_TEXT, &arguments->division.up},
        {"--see-through", OPTIONS_TEXT, &arguments->division.see_through},
        {"--frames", OPTIONS_TEXT, &arguments->frames},
        {"--every", OPTIONS_COUNT, &arguments->every},
        {"--size", OPTIONS_TEXT, &arguments->size},
        {"--method", OPTIONS_TEXT, &arguments->method},
        {"--against", OPTIONS_TEXT, &arguments->against},
        {"--backend", OPTIONS_TEXT, &arguments->backend},
        {"--threads", OPTIONS_COUNT, &wish->threads},
        {"--preset", OPTIONS_TEXT, &arguments->preset},
        {"--tolerance", OPTIONS_REAL, &arguments->tolerance},
        {"--one-sided", OPTIONS_FLAG, &wish->gl.one_sided},
        {"--pictures", OPTIONS_TEXT, &arguments->pictures},
        {"--csv", OPTIONS_TEXT, &arguments->csv},
        {NULL, OPTIONS_FLAG, NULL}};
    int status = options_parse_scene(argc, argv, entries, &arguments->scene);
    if (status) return status;
    const char *complaint = complete_arguments(arguments);
    return complaint ? options_complain(argv[0], complaint) : 0;
}

static bool fail(const char *file, const char *why)
{
    fprintf(stderr, "occlude-bench: %s%s%s\n", file ? file : "", file ? ": " : "", why);
    return false;
}

// Fills `frames`, which has room for all of the scene's.
static bool choose_frames(image_arguments *arguments, uint32_t available, uint32_t *frames)
{
    image_wish *wish = &arguments->wish;
    uint32_t count = available, kept = 0;
    for (uint32_t i = 0; i < available; i++)
        frames[i] = i;
    if (arguments->frames && !options_ascending(arguments->frames, available, frames, &count))
        return fail(arguments->scene, "expected --frames as 0,20,40: ascending, and in the scene");
    for (uint32_t i = 0; i < count; i += arguments->every) {
        frames[kept++] = frames[i];
        if (count - i <= arguments->every) break;
    }
    wish->frames = frames;
    wish->frame_count = kept;
    return kept > 0 || fail(arguments->scene, "the scene has no frames");
}

// The scene's path without its folder's and its last extension; to free().
static char *stem_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    char *stem = malloc(strlen(name) + 1);
    if (!stem) return NULL;
    memcpy(stem, name, strlen(name) + 1);
    char *dot = strrchr(stem, '.');
    if (dot && dot != stem) *dot = '\0';
    return stem;
}

// The table's file is opened first, so that a wrong path does not cost the pictures.
static bool draw_and_report(const image_arguments *arguments, const obs_scene *scene,
                            const image_parts *parts, uint64_t *differing)
{
    const image_names names = {arguments->method, arguments->backend, obs_occluder_total(scene)};
    outfile table = {0};
    image_result result;
    if (arguments->csv && !outfile_open(&table, arguments->csv)) return false;
    if (!image_run(&arguments->wish, scene, parts, &result)) {
        outfile_abandon(&table);
        return false;
    }
    bool good = true;
    if (arguments->csv) {
        image_write_rows(table.stream, &names, &arguments->wish, &result);
        good = outfile_commit(&table);
    }
    good = good && image_print(&names, &arguments->wish, parts, &result, differing);
    image_result_free(&result);
    return good;
}

static bool image_of_model(image_arguments *arguments, const obs_scene *scene, const model *m,
                           uint64_t *differing)
{
    division d;
    image_parts parts = {0};
    uint32_t *frames = malloc(((size_t)scene->frame_count + 1) * sizeof *frames);
    char *stem = stem_of(arguments->scene);
    bool good = (frames && stem) || fail(NULL, "not enough memory");
    arguments->wish.pictures = arguments->pictures ? arguments->pictures : stem;
    good = good && choose_frames(arguments, scene->frame_count, frames);
    if (good && (good = division_make(m, &arguments->division, &d))) {
        good = image_parts_agree(&d, scene, arguments->scene, arguments->model) &&
               (image_parts_make(m, &d, &parts) || fail(NULL, "not enough memory"));
        division_free(&d);
    }
    good = good && draw_and_report(arguments, scene, &parts, differing);
    image_parts_free(&parts);
    free(frames);
    free(stem);
    return good;
}

int bench_image(int argc, char **argv)
{
    image_arguments arguments;
    obs_scene scene;
    model m;
    uint64_t differing = 0;
    int status = parse_image(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(image_usage, stdout) < 0;
    if (status != 0) return status;
    if (!obs_read(arguments.scene, &scene)) return 1;
    bool good = model_read(arguments.model, &arguments.division.model, &m);
    if (good) {
        good = image_of_model(&arguments, &scene, &m, &differing);
        model_free(&m);
    }
    obs_free(&scene);
    if (!good) return 1;
    return differing > 0 ? 3 : 0;
}
