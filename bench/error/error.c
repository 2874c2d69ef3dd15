// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "commands.h"

#include "error_hard.h"
#include "error_measure.h"
#include "error_report.h"
#include "error_scene.h"
#include "error_target.h"
#include "options.h"
#include "timing.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char error_usage[] =
    "usage: occlude-bench error [options]\n"
    "\n"
    "Speed against error: every method, backend and setting on every named scene, judged by what\n"
    "can truly be seen. Writes into one folder a CSV with a row for each run, its tables in\n"
    "Markdown, and a plot for each scene. docs/error.md says how to read them.\n"
    "\n"
    "  --out DIR      where to (default error); truths are kept in DIR/truth\n"
    "  --scenes DIR   take NAME.obs from here where it is there; else the generators make it\n"
    "  --scene NAME   this scene alone; may be given up to 32 times (default: all, and the hard\n"
    "                 families)\n"
    "  --hard         the hard families too where scenes are named\n"
    "  --quick        scenes of at most 10,000 objects, fewer settings and worlds\n"
    "  --targets      instead: the default method alone, on one thread and two, on the scenes "
    "with\n"
    "                 goals and on two other seeds of each (NAME_seed11, NAME_seed12); writes\n"
    "                 targets.md and targets.csv. With --quick small scenes and their own seeds\n"
    "  --settle N     objects of a result that are put to the exact judge where it and sampling "
    "do\n"
    "                 not agree, at most (default 3000; needs a build with GMP)\n"
    "  --hidden N     objects of a result, hidden for it and for sampling, that the judge looks "
    "at\n"
    "                 too, at most (default 300)\n"
    "  --size WxH     samples of truths (default 4096x2304)\n"
    "  --repeat R     timed culls of each frame (default 3; with --targets 5, in each of three\n"
    "                 rounds, and 20 times that where the scene has a single frame)\n"
    "\n"
    "Exit status 3 if a method that promises not to hides a visible object (with a tolerance it\n"
    "makes no such promise), or if backends\n"
    "disagree about an object.\n"
    "\n"
    "Examples: occlude-bench error --quick --out error\n"
    "          occlude-bench error --targets --scenes build/scenes --out build/targets\n";

enum { MAX_SCENES = 32, SETTLED_DEFAULT = 3000, HIDDEN_DEFAULT = 300, STATUS_FALSE_HIDDEN = 3 };

typedef struct error_arguments {
    const char *out, *folder, *size;
    options_extent extent;          // of truths
    const char *scenes[MAX_SCENES]; // none: all
    int scene_count;
    bool wants_hard; // though scenes are named
    bool wants_targets;
    error_options options;
} error_arguments;

// Takes the options `--scene NAME` out of argv, which may have many of them. Returns the new argc.
static int take_scenes(int argc, char **argv, error_arguments *arguments)
{
    int kept = 1;
    for (int i = 1; i < argc; i++) {
        bool is_scene = strcmp(argv[i], "--scene") == 0 && i + 1 < argc;
        if (is_scene && arguments->scene_count < MAX_SCENES)
            arguments->scenes[arguments->scene_count++] = argv[++i];
        else
            argv[kept++] = argv[i];
    }
    return kept;
}

// A name becomes part of paths.
static bool is_name(const char *text)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    size_t length = strlen(text);
    return length > 0 && length < sizeof((error_row *)0)->scene && strspn(text, letters) == length;
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_error(int argc, char **argv, error_arguments *arguments)
{
    *arguments =
        (error_arguments){.out = "error",
                          .size = "4096x2304",
                          .options = {.settle = SETTLED_DEFAULT, .hidden = HIDDEN_DEFAULT}};
    const options_entry entries[] = {{"--out", OPTIONS_TEXT, &arguments->out},
                                     {"--scenes", OPTIONS_TEXT, &arguments->folder},
                                     {"--size", OPTIONS_TEXT, &arguments->size},
                                     {"--hard", OPTIONS_FLAG, &arguments->wants_hard},
                                     {"--quick", OPTIONS_FLAG, &arguments->options.is_quick},
                                     {"--targets", OPTIONS_FLAG, &arguments->wants_targets},
                                     {"--settle", OPTIONS_COUNT, &arguments->options.settle},
                                     {"--hidden", OPTIONS_COUNT, &arguments->options.hidden},
                                     {"--repeat", OPTIONS_COUNT, &arguments->options.repeats},
                                     {NULL, OPTIONS_FLAG, NULL}};
    char *words[1];
    argc = take_scenes(argc, argv, arguments);
    int count = options_parse(argc, argv, entries, words, 0);
    if (count == OPTIONS_HELP) return OPTIONS_HELP;
    if (count == OPTIONS_BAD) return 2;
    if (arguments->options.repeats == 0)
        arguments->options.repeats = arguments->wants_targets ? 5 : 3;
    if (arguments->wants_targets && arguments->wants_hard)
        return options_complain(argv[0], "--targets has no hard families: leave out --hard");
    const options_extent least = {1, 1};
    if (!options_size(arguments->size, least, TRUTH_MAX_SIDE, &arguments->extent))
        return options_complain(argv[0], "expected --size as 4096x2304, 16384x16384 at most");
    if (arguments->options.repeats > 1000)
        return options_complain(argv[0], "--repeat is 1000 at most");
    for (int i = 0; i < arguments->scene_count; i++)
        if (!is_name(arguments->scenes[i]))
            return options_complain(argv[0], "expected a scene's name after --scene, as city_1000");
    return 0;
}

static bool make_folder(const char *path)
{
    if (mkdir(path, 0777) == 0 || errno == EEXIST) return true;
    fprintf(stderr, "occlude-bench: cannot make the folder %s: %s\n", path, strerror(errno));
    return false;
}

static error_status run_scene(const error_arguments *arguments, const error_truths *truths,
                              const char *name, error_table *table)
{
    obs_scene scene;
    double start = timing_now();
    size_t before = table->count;
    switch (error_scene_load(arguments->folder, name, &scene)) {
    case ERROR_LOADED:
        break;
    case ERROR_ABSENT:
        fprintf(arguments->scene_count > 0 ? stderr : stdout,
                "%s: skipped: there is no file %s.obs and no generator makes it\n", name, name);
        return arguments->scene_count > 0 ? ERROR_UNUSABLE : ERROR_GOOD;
    case ERROR_FAILED:
        return ERROR_UNUSABLE;
    }
    error_options options = arguments->options;
    options.has_tolerance = error_scene_has_tolerance(name);
    error_status status = error_measure_scene(&options, truths, name, &scene, table);
    obs_free(&scene);
    if (status == ERROR_UNUSABLE) return status;
    printf("%s: %zu runs in %.1f s\n", name, table->count - before, (timing_now() - start) / 1000);
    fflush(stdout);
    return status;
}

// Goes on where backends differ, so that the report shows where.
static error_status run_scenes(const error_arguments *arguments, const error_truths *truths,
                               error_table *table)
{
    error_status worst = ERROR_GOOD;
    for (int i = 0; i < arguments->scene_count && worst != ERROR_UNUSABLE; i++) {
        error_status status = run_scene(arguments, truths, arguments->scenes[i], table);
        if (status != ERROR_GOOD) worst = status;
    }
    if (arguments->scene_count > 0) return worst;
    for (const error_source *source = error_sources; source->name; source++) {
        if (arguments->options.is_quick && !source->is_quick) continue;
        error_status status = run_scene(arguments, truths, source->name, table);
        if (status == ERROR_UNUSABLE) return status;
        if (status != ERROR_GOOD) worst = status;
    }
    return worst;
}

static int report(const char *folder, const error_findings *findings, error_status status)
{
    if (!error_report(folder, findings)) return 1;
    error_print_summary(stdout, findings);
    uint64_t broken = error_table_broken_promises(&findings->scenes) +
                      error_table_broken_promises(&findings->hard);
    if (broken > 0)
        fprintf(stderr,
                "occlude-bench: %llu visible objects are reported hidden by methods that "
                "promise not to\n",
                (unsigned long long)broken);
    return broken > 0 || status == ERROR_DIFFERENT ? STATUS_FALSE_HIDDEN : 0;
}

static error_status run_hard(error_findings *findings)
{
    double start = timing_now();
    error_status status = error_hard(&findings->options, &findings->hard);
    if (findings->hard.count > 0)
        printf("hard families: %zu runs in %.1f s\n", findings->hard.count,
               (timing_now() - start) / 1000);
    return status;
}

static int run_targets(const error_arguments *arguments, const error_truths *truths)
{
    const error_options *options = &arguments->options;
    const error_target_options wanted = {.folder = arguments->folder,
                                         .scenes = arguments->scenes,
                                         .scene_count = arguments->scene_count,
                                         .is_quick = options->is_quick,
                                         .repeats = options->repeats,
                                         .limits = {options->settle, options->hidden},
                                         .truths = *truths};
    error_targets targets = {0};
    bool good = error_targets_run(&wanted, &targets) &&
                error_targets_report(arguments->out, &wanted, &targets);
    if (good) error_targets_totals(stdout, &targets);
    error_target_faults faults = error_targets_faults(&targets);
    error_targets_free(&targets);
    if (!good) return 1;
    return faults.false_hidden > 0 || faults.different > 0 ? STATUS_FALSE_HIDDEN : 0;
}

static int run(const error_arguments *arguments, const error_truths *truths,
               error_findings *findings)
{
    if (!make_folder(arguments->out) || !make_folder(truths->folder)) return 1;
    if (arguments->wants_targets) return run_targets(arguments, truths);
    error_status status = run_scenes(arguments, truths, &findings->scenes);
    if (status == ERROR_UNUSABLE) return 1;
    bool wants_hard = arguments->scene_count == 0 || arguments->wants_hard;
    if (wants_hard) {
        error_status end = run_hard(findings);
        if (end == ERROR_UNUSABLE) return 1;
        if (end != ERROR_GOOD) status = end;
    }
    return report(arguments->out, findings, status);
}

int bench_error(int argc, char **argv)
{
    error_arguments arguments;
    int status = parse_error(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(error_usage, stdout) < 0;
    if (status != 0) return status;
    size_t size = strlen(arguments.out) + sizeof "/truth";
    char *truth_folder = malloc(size);
    if (!truth_folder) return 1;
    snprintf(truth_folder, size, "%s/truth", arguments.out);
    arguments.options.has_opencl = !arguments.wants_targets && error_has_opencl();
    if (!arguments.wants_targets && !arguments.options.has_opencl)
        puts("no OpenCL device: the opencl backend is left out");
    error_findings findings = {.options = arguments.options,
                               .scenes = {.driver = "none", .peer = "none"}};
    const error_truths truths = {truth_folder, arguments.extent.width, arguments.extent.height};
    status = run(&arguments, &truths, &findings);
    error_table_free(&findings.scenes);
    error_table_free(&findings.hard);
    free(truth_folder);
    return status;
}
