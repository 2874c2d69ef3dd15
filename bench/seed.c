// SPDX-License-Identifier: Apache-2.0
// The experiment of a 2019 master's thesis on octrees and CUDA: how do the time of a frame and the
// number of objects left depend on the number of objects? Its figures are from its own timing
// sheet (Intel i7-7700HQ, NVIDIA GTX 1050).
#include "commands.h"

#include "build_info.h"
#include "measure.h"
#include "options.h"
#include "outfile.h"
#include "plot.h"
#include "scenes.h"
#include "timing.h"

#include <stdio.h>
#include <string.h>

enum { MAX_ROWS = 64, MAX_SCENES = 100 };

typedef struct seed_row {
    uint32_t objects;
    double in_frustum, after_octree, after_occlusion, ms;
    double thesis_ms; // 0: not published
    uint64_t bytes;   // the most that scene and view held
} seed_row;

typedef struct seed_arguments {
    const char *counts, *csv, *plot;
    measure_settings settings;
    uint32_t scenes;
    char driver[256]; // of the last measurement
} seed_arguments;

static const char seed_default_counts[] =
    "1,10,100,501,1001,5001,10001,20001,50000,100000,200000,500000,1000000";

static const char seed_usage[] =
    "usage: occlude-bench seed [options]\n"
    "\n"
    "The 2019 thesis's experiment: cubes around random spheres in a box of 100 units, seen from a\n"
    "corner, in growing numbers. Prints a table with the thesis's own times (octree and CUDA, "
    "Intel\n"
    "i7-7700HQ, NVIDIA GTX 1050) where it published one.\n"
    "\n"
    "  --counts LIST  numbers of objects, parted by commas\n"
    "                 (default 1,10,100,501,1001,5001,... 1000000)\n"
    "  --scenes S     scenes for each number, seeds 1 to S; counts are means and times medians\n"
    "                 over them (default 5)\n"
    "  --method M     fused (default) or single\n"
    "  --backend B    openmp (default), plain or opencl\n"
    "  --threads T    threads of the openmp backend (default: 1)\n"
    "  --repeat R     timed culls of each scene (default 21)\n"
    "  --csv F.csv    write the table as CSV\n"
    "  --plot P.png   draw both curves (needs gnuplot)\n"
    "\n"
    "Example: occlude-bench seed --plot seed.png --csv seed.csv\n";

static double published_ms(uint32_t objects)
{
    static const struct {
        uint32_t objects;
        double ms;
    } sheet[] = {{501, 6.97}, {1001, 14.46}, {5001, 97.5}, {10001, 287}, {20001, 1015}};
    for (size_t i = 0; i < sizeof sheet / sizeof *sheet; i++)
        if (objects == sheet[i].objects) return sheet[i].ms;
    return 0;
}

// Returns the number of rows, 0 when the list is not one.
static size_t parse_counts(const char *list, seed_row *rows)
{
    size_t count = 0;
    char number[16];
    while (count < MAX_ROWS) {
        size_t length = strcspn(list, ",");
        uint64_t objects;
        if (length >= sizeof number) return 0;
        memcpy(number, list, length);
        number[length] = '\0';
        if (!options_number(number, 1, SCENES_MAX_COUNT, &objects)) return 0;
        rows[count++] =
            (seed_row){.objects = (uint32_t)objects, .thesis_ms = published_ms((uint32_t)objects)};
        if (list[length] == '\0') return count;
        list += length + 1;
    }
    return 0;
}

static bool measure_scene(seed_arguments *arguments, seed_row *row, uint32_t seed, double *ms)
{
    obs_scene scene;
    if (!scenes_make("seedscene", row->objects, seed, &scene)) {
        fputs("occlude-bench: not enough memory for the scene\n", stderr);
        return false;
    }
    measure_result result;
    bool good = measure_run(&arguments->settings, &scene, &result);
    obs_free(&scene);
    if (!good) return false;
    const measure_frame *frame = &result.frames[0];
    row->in_frustum += (double)frame->in_frustum / arguments->scenes;
    row->after_octree += (double)frame->stats.tested / arguments->scenes;
    row->after_occlusion += (double)frame->stats.visible / arguments->scenes;
    *ms = frame->ms;
    uint64_t bytes = result.held_bytes + result.device_bytes;
    if (bytes > row->bytes) row->bytes = bytes;
    memcpy(arguments->driver, result.driver, sizeof arguments->driver);
    measure_free(&result);
    return true;
}

static bool measure_row(seed_arguments *arguments, seed_row *row)
{
    double times[MAX_SCENES];
    for (uint32_t i = 0; i < arguments->scenes; i++)
        if (!measure_scene(arguments, row, i + 1, &times[i])) return false;
    row->ms = timing_median(times, arguments->scenes);
    return true;
}

static void print_row(const seed_row *row)
{
    printf("%9u %12.1f %14.1f %16.1f %10.4f %12.0f %10.1f", row->objects, row->in_frustum,
           row->after_octree, row->after_occlusion, row->ms, 1000 / row->ms,
           (double)row->bytes / 1e6);
    if (row->thesis_ms > 0)
        printf(" %12.2f\n", row->thesis_ms);
    else
        printf(" %12s\n", "-");
    fflush(stdout);
}

static void write_table(FILE *stream, const seed_arguments *arguments, const seed_row *rows,
                        size_t count)
{
    const measure_settings *settings = &arguments->settings;
    build_info_write(stream, arguments->driver);
    fprintf(stream, "# method=%s\n# backend=%s\n# threads=%u\n# repeats=%u\n# scenes=%u\n",
            settings->method, settings->backend, settings->threads, settings->repeats,
            arguments->scenes);
    fputs("objects,in_frustum_objects,after_octree_objects,after_occlusion_objects,time_ms,"
          "ceiling_fps,thesis_time_ms,memory_bytes\n",
          stream);
    for (size_t i = 0; i < count; i++) {
        fprintf(stream, "%u,%.1f,%.1f,%.1f,%.6f,%.1f,", rows[i].objects, rows[i].in_frustum,
                rows[i].after_octree, rows[i].after_occlusion, rows[i].ms, 1000 / rows[i].ms);
        if (rows[i].thesis_ms > 0) fprintf(stream, "%.2f", rows[i].thesis_ms);
        fprintf(stream, ",%llu\n", (unsigned long long)rows[i].bytes);
    }
}

static bool write_csv(const seed_arguments *arguments, const seed_row *rows, size_t count)
{
    outfile table;
    if (!outfile_open(&table, arguments->csv)) return false;
    write_table(table.stream, arguments, rows, count);
    return outfile_commit(&table);
}

static void draw(const seed_arguments *arguments, const seed_row *rows, size_t count)
{
    double x[MAX_ROWS], ours[MAX_ROWS], theirs[MAX_ROWS];
    char title[64];
    snprintf(title, sizeof title, "occlude, method %s, this machine", arguments->settings.method);
    for (size_t i = 0; i < count; i++) {
        x[i] = rows[i].objects;
        ours[i] = rows[i].ms;
        theirs[i] = rows[i].thesis_ms;
    }
    const plot_curve curves[] = {{title, x, ours, count},
                                 {"thesis of 2019, i7-7700HQ and GTX 1050", x, theirs, count}};
    if (plot_logarithmic(arguments->plot, "Time of a frame against the number of objects",
                         "objects", "milliseconds a frame", curves, 2))
        printf("plot: %s\n", arguments->plot);
}

static int run_seed(seed_arguments *arguments, seed_row *rows, size_t count)
{
    printf("%9s %12s %14s %16s %10s %12s %10s %12s\n", "objects", "in frustum", "after octree",
           "after occlusion", "ms", "fps ceiling", "memory MB", "thesis ms");
    for (size_t i = 0; i < count; i++) {
        if (!measure_row(arguments, &rows[i])) return 1;
        print_row(&rows[i]);
    }
    printf(
        "method %s, backend %s; counts are means and times medians over %u scenes. after octree: "
        "left by\n"
        "the walk (frustum and hidden nodes), handed to the test of single objects. The thesis's\n"
        "times are another machine's, and it hides what its tolerance happens to take in.\n",
        arguments->settings.method, arguments->settings.backend, arguments->scenes);
    if (arguments->csv && !write_csv(arguments, rows, count)) return 1;
    if (arguments->plot) draw(arguments, rows, count);
    return 0;
}

int bench_seed(int argc, char **argv)
{
    seed_arguments arguments = {.counts = seed_default_counts, .scenes = 5};
    arguments.settings = measure_defaults();
    arguments.settings.method = "fused";
    arguments.settings.repeats = 21;
    arguments.settings.backend = "openmp";
    arguments.settings.threads = 1;
    const options_entry entries[] = {{"--counts", OPTIONS_TEXT, &arguments.counts},
                                     {"--scenes", OPTIONS_COUNT, &arguments.scenes},
                                     {"--method", OPTIONS_TEXT, &arguments.settings.method},
                                     {"--backend", OPTIONS_TEXT, &arguments.settings.backend},
                                     {"--threads", OPTIONS_COUNT, &arguments.settings.threads},
                                     {"--repeat", OPTIONS_COUNT, &arguments.settings.repeats},
                                     {"--csv", OPTIONS_TEXT, &arguments.csv},
                                     {"--plot", OPTIONS_TEXT, &arguments.plot},
                                     {NULL, OPTIONS_FLAG, NULL}};
    int status = options_parse(argc, argv, entries, NULL, 0);
    if (status == OPTIONS_HELP) return fputs(seed_usage, stdout) < 0;
    if (status == OPTIONS_BAD) return 2;
    occ_method method;
    if (!measure_method(arguments.settings.method, &method) || method == OCC_METHOD_FRUSTUM ||
        method == OCC_METHOD_PAIRWISE)
        return options_complain(argv[0], "expected fused or single after --method");
    const char *complaint = measure_complete(&arguments.settings);
    if (complaint) return options_complain(argv[0], complaint);
    if (arguments.scenes > MAX_SCENES || arguments.settings.repeats > 1000)
        return options_complain(argv[0], "at most 100 scenes and 1000 repeats");
    seed_row rows[MAX_ROWS];
    size_t count = parse_counts(arguments.counts, rows);
    if (count == 0)
        return options_complain(argv[0], "expected numbers from 1 to 20000000, parted by commas");
    return run_seed(&arguments, rows, count);
}
