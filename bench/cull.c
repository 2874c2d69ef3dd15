// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "build_info.h"
#include "measure.h"
#include "options.h"
#include "outfile.h"
#include "peer.h"

#include <stdio.h>
#include <string.h>

typedef struct cull_arguments {
    measure_settings settings;
    const char *scene, *out, *csv, *rays;
    const char *preset;
    double min_area, tolerance;
    bool force;
} cull_arguments;

static const char cull_usage[] =
    "usage: occlude-bench cull F.obs [options]\n"
    "\n"
    "Culls every frame of a scene file, and measures it. The last line printed sums it up.\n"
    "\n"
    "  --method M         fused (default): octree, chosen occluders, and what they hide, one\n"
    "                     alone or several together\n"
    "                     single: the same, but one occluder must hide all of an object\n"
    "                     frustum: nothing is hidden\n"
    "                     pairwise: every object against every occluder, exact test\n"
    "                     thesis: the 2019 thesis's test as published; it hides visible objects\n"
    "                     embree-depth: a small depth buffer traced by Embree, as Godot 4 does\n"
    "                     embree-rays: rays to the eight corners, by Embree\n"
    "                     (these three on --backend plain unless said otherwise; not "
    "conservative)\n"
    "  --backend B        openmp (default), plain (one thread of C), opencl\n"
    "  --threads T        threads of the openmp backend and of building the scene (default: one "
    "to\n"
    "                     a processor; on other backends one builds)\n"
    "  --repeat R         timed culls of each frame (default 5)\n"
    "  --every N          only each N-th frame, for slow methods (default 1)\n"
    "  --builds N         build the scene N times and print the median (default 1)\n"
    "  --out R.vis        write the verdicts of every frame\n"
    "  --csv F.csv        write a row for each frame\n"
    "  --preset P         fast, balanced (default) or thorough: what stands for knobs not given\n"
    "  --min-area A       smallest solid angle at which an occluder is used (balanced: 3e-4)\n"
    "  --grain N          most objects in a node that is tested as it is (balanced: 64)\n"
    "  --max-occluders N  most occluders used in a frame (balanced: 1024)\n"
    "  --max-splits N     most subtractions for an object in fused (balanced: 48)\n"
    "  --tolerance T      radians, 0.1 at most: gaps between occluders that look narrower are\n"
    "                     closed, and visible objects may be hidden (default 0)\n"
    "  --rays WxH         size of embree-depth's buffer (default 85x48)\n"
    "  --force            run a quadratic method on a large scene too\n"
    "\n"
    "A frame's time is that of culling, of copying the mask and of copying the list of visible\n"
    "objects: what an engine waits for. All frames are culled once before anything is timed. A\n"
    "frame's time is the median of its repeats, one after the other; median_ms, p99_ms, max_ms,\n"
    "walk_ms and test_ms run over the frames. moved_ms is the median of frames that follow "
    "another\n"
    "one. in_frustum and visible are means over the frames.\n"
    "\n"
    "Example: occlude-bench cull city.obs --method fused --backend openmp --csv city.csv\n";

static bool parse_rays(const char *text, measure_settings *settings)
{
    char width[16];
    size_t length = strcspn(text, "x");
    uint64_t numbers[2];
    if (length >= sizeof width || text[length] != 'x') return false;
    memcpy(width, text, length);
    width[length] = '\0';
    if (!options_number(width, 1, PEER_MOST_RAYS, &numbers[0]) ||
        !options_number(text + length + 1, 1, PEER_MOST_RAYS, &numbers[1]))
        return false;
    settings->rays_width = (uint32_t)numbers[0];
    settings->rays_height = (uint32_t)numbers[1];
    return true;
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_cull(int argc, char **argv, cull_arguments *arguments)
{
    measure_settings *settings = &arguments->settings;
    *settings = measure_defaults();
    const options_entry entries[] = {
        {"--method", OPTIONS_TEXT, &settings->method},
        {"--backend", OPTIONS_TEXT, &settings->backend},
        {"--threads", OPTIONS_COUNT, &settings->threads},
        {"--repeat", OPTIONS_COUNT, &settings->repeats},
        {"--every", OPTIONS_COUNT, &settings->every},
        {"--builds", OPTIONS_COUNT, &settings->builds},
        {"--out", OPTIONS_TEXT, &arguments->out},
        {"--csv", OPTIONS_TEXT, &arguments->csv},
        {"--preset", OPTIONS_TEXT, &arguments->preset},
        {"--tolerance", OPTIONS_REAL, &arguments->tolerance},
        {"--max-splits", OPTIONS_COUNT, &settings->knobs.max_splits},
        {"--min-area", OPTIONS_REAL, &arguments->min_area},
        {"--grain", OPTIONS_COUNT, &settings->knobs.grain},
        {"--max-occluders", OPTIONS_COUNT, &settings->knobs.max_occluders},
        {"--rays", OPTIONS_TEXT, &arguments->rays},
        {"--force", OPTIONS_FLAG, &arguments->force},
        {NULL, OPTIONS_FLAG, NULL}};
    int status = options_parse_scene(argc, argv, entries, &arguments->scene);
    if (status) return status;
    settings->knobs.min_area = (float)arguments->min_area;
    settings->knobs.tolerance = (float)arguments->tolerance;
    if (settings->knobs.tolerance > OCC_MAX_TOLERANCE)
        return options_complain(argv[0], "--tolerance is 0.1 at most");
    if (arguments->preset && !measure_preset(arguments->preset, &settings->knobs.preset))
        return options_complain(argv[0], "expected fast, balanced or thorough after --preset");
    if (arguments->rays && !parse_rays(arguments->rays, settings))
        return options_complain(argv[0], "expected --rays as 85x48, 4096x4096 at most");
    const char *complaint = measure_complete(settings);
    if (complaint) return options_complain(argv[0], complaint);
    if (settings->builds > 1000) return options_complain(argv[0], "--builds is 1000 at most");
    if (settings->repeats > 1000) return options_complain(argv[0], "--repeat is 1000 at most");
    if (arguments->out && settings->every != 1)
        return options_complain(argv[0], "--out needs every frame: leave out --every");
    return 0;
}

static void write_rows(FILE *stream, const cull_arguments *arguments, const obs_scene *scene,
                       const measure_result *result)
{
    const measure_settings *settings = &arguments->settings;
    build_info_write(stream, result->driver);
    fprintf(stream,
            "# scene=%s\n# method=%s\n# backend=%s\n# threads=%u\n# repeats=%u\n# objects=%u\n"
            "# occluders=%u\n",
            arguments->scene, settings->method, settings->backend, result->threads,
            settings->repeats, scene->object_count, obs_occluder_total(scene));
    fputs("frame_index,eye_x_world,eye_y_world,eye_z_world,time_ms,walk_ms,test_ms,"
          "in_frustum_objects,visible_objects,occluders_used,occluders_tested,nodes_tested,"
          "tested_objects,walk_outside_objects,walk_hidden_objects,test_outside_objects,"
          "test_hidden_objects,ranges\n",
          stream);
    for (uint32_t i = 0; i < result->frame_count; i++) {
        const measure_frame *row = &result->frames[i];
        const float *eye = scene->frames[row->index].eye;
        const occ_view_stats *stats = &row->stats;
        fprintf(stream, "%u,%.9g,%.9g,%.9g,%.6f,%.6f,%.6f,%u,%u,%u,%u,%u,%u,%u,%u,%u,%u,%u\n",
                row->index, (double)eye[0], (double)eye[1], (double)eye[2], row->ms, row->walk_ms,
                row->test_ms, row->in_frustum, stats->visible, stats->occluders_used,
                stats->occluders_tested, stats->nodes_tested, stats->tested, stats->walk_outside,
                stats->walk_hidden, stats->test_outside, stats->test_hidden, stats->ranges);
    }
}

// The file's name without its folder and its last extension.
static void base_name(const char *path, char *name, size_t size)
{
    const char *slash = strrchr(path, '/');
    snprintf(name, size, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(name, '.');
    if (dot && dot != name) *dot = '\0';
}

static void print_memory(const obs_scene *scene, const measure_result *result)
{
    double objects = scene->object_count ? scene->object_count : 1;
    printf("build_ms=%.2f commit_ms=%.2f (%u objects, %u occluders, all trees)\n", result->build_ms,
           result->commit_ms, scene->object_count, obs_occluder_total(scene));
    printf("memory %llu bytes (scene %llu, view %llu), %.1f bytes per object\n",
           (unsigned long long)result->held_bytes, (unsigned long long)result->scene_bytes,
           (unsigned long long)result->view_bytes, (double)result->held_bytes / objects);
    if (result->device_bytes > 0)
        printf("device memory %llu bytes on %s\n", (unsigned long long)result->device_bytes,
               result->driver);
    printf("allocations in timed frames: %llu\n", (unsigned long long)result->timed_allocations);
}

static bool print_summary(const cull_arguments *arguments, const obs_scene *scene,
                          const measure_result *result)
{
    char name[256];
    measure_summary sum;
    base_name(arguments->scene, name, sizeof name);
    if (!measure_summarize(result, &sum)) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    print_memory(scene, result);
    printf("scene=%s method=%s backend=%s threads=%u frames=%u objects=%u in_frustum=%.1f "
           "visible=%.1f median_ms=%.4f p99_ms=%.4f max_ms=%.4f walk_ms=%.4f test_ms=%.4f "
           "moved_ms=%.4f\n",
           name, arguments->settings.method, arguments->settings.backend, result->threads,
           result->frame_count, scene->object_count, sum.in_frustum, sum.visible, sum.median_ms,
           sum.p99_ms, sum.max_ms, sum.walk_ms, sum.test_ms, sum.moved_ms);
    return true;
}

// The table's file is opened first, so that a wrong path does not cost a measurement.
static bool measure_and_write(const cull_arguments *arguments, const obs_scene *scene)
{
    outfile table = {0};
    if (arguments->csv && !outfile_open(&table, arguments->csv)) return false;
    measure_result result;
    if (!measure_run(&arguments->settings, scene, &result)) {
        outfile_abandon(&table);
        return false;
    }
    bool good = true;
    if (arguments->csv) {
        write_rows(table.stream, arguments, scene, &result);
        good = outfile_commit(&table);
    }
    if (good && arguments->out) good = vis_write(arguments->out, &result.verdicts);
    good = good && print_summary(arguments, scene, &result);
    measure_free(&result);
    return good;
}

int bench_cull(int argc, char **argv)
{
    cull_arguments arguments = {0};
    int status = parse_cull(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(cull_usage, stdout) < 0;
    if (status != 0) return status;
    obs_scene scene;
    if (!obs_read(arguments.scene, &scene)) return 1;
    const char *warning = arguments.force ? NULL : measure_warning(&arguments.settings, &scene);
    if (warning) fprintf(stderr, "occlude-bench: %s: %s\n", arguments.scene, warning);
    bool good = !warning && measure_and_write(&arguments, &scene);
    obs_free(&scene);
    return good ? 0 : 1;
}
