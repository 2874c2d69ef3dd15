// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "build_info.h"
#include "hard_scene.h"
#include "options.h"
#include "outfile.h"
#include "progress.h"
#include "tour.h"

#include <stdio.h>
#include <string.h>

typedef struct hard_arguments {
    tour_settings tour;
    const char *family, *method, *backend, *seed, *out, *csv;
    uint32_t worlds;
    double min_area;
} hard_arguments;

enum { STATUS_FALSE_HIDDEN = 3 };

static const char hard_usage[] =
    "usage: occlude-bench hard [options]\n"
    "\n"
    "Makes worlds of every family of hard cases, asks the exact judge what can be seen in them,\n"
    "and holds the library's answers against it.\n"
    "\n"
    "  --family F         this family alone (--family list names them all)\n"
    "  --scale S          1e-6 to 1e6, instead of seven of them in turn\n"
    "  --offset O         0 to 1e7 units from the origin, instead of four of them in turn\n"
    "  --seed N           number of the first world (default 0)\n"
    "  --worlds N         worlds of each family (default 112: every place four times)\n"
    "  --method M         single (default), fused, pairwise, or frustum, which misses all that is\n"
    "                     hidden\n"
    "  --backend B        plain (default), openmp, opencl\n"
    "  --threads T        of the openmp backend; with the plain one, worlds at a time\n"
    "                     (default: one to a processor)\n"
    "  --min-area A       smallest solid angle at which an occluder is used (default: any)\n"
    "  --grain N          most objects in a node that is tested as it is (default 8)\n"
    "  --max-occluders N  most occluders used in a world (default: all)\n"
    "  --csv F.csv        write the table\n"
    "  --out F.obs        write the one world that --family and --seed name, and run it alone.\n"
    "                     Such a file has a camera in float: near the world's, not always it\n"
    "\n"
    "A verdict is one object's answer, judged exactly. Of these: outside (of the clip planes),\n"
    "hidden (by all occluders of others together), seen. false_hidden are seen but reported\n"
    "hidden, and must not be; missed are hidden but reported visible; generous are outside but\n"
    "reported visible; exact_pct is how many of the judge's signs needed exact integers. Exit\n"
    "status 3 if there is a false-hidden verdict.\n"
    "\n"
    "Example: occlude-bench hard --family needles --scale 1e-3 --method pairwise\n";

// --- arguments -----------------------------------------------------------------------------------

static bool pick(const char *name, const char *const *names, const int *values, int *value)
{
    for (int i = 0; names[i]; i++)
        if (strcmp(name, names[i]) == 0) {
            *value = values[i];
            return true;
        }
    return false;
}

// Returns a complaint, or NULL.
static const char *complete(hard_arguments *a)
{
    static const char *const methods[] = {"single", "pairwise", "frustum", "fused", NULL};
    static const int method_values[] = {OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE, OCC_METHOD_FRUSTUM,
                                        OCC_METHOD_FUSED};
    static const char *const backends[] = {"plain", "openmp", "opencl", NULL};
    static const int backend_values[] = {OCC_BACKEND_PLAIN, OCC_BACKEND_OPENMP, OCC_BACKEND_OPENCL};
    tour_settings *tour = &a->tour;
    int method, backend;
    if (!pick(a->method, methods, method_values, &method))
        return "expected single, fused, pairwise or frustum after --method";
    if (!pick(a->backend, backends, backend_values, &backend))
        return "expected plain, openmp or opencl after --backend";
    if (a->seed && !options_number(a->seed, 0, UINT64_MAX / 2, &tour->first))
        return "expected a whole number after --seed";
    if (tour->scale >= 0.0 && (tour->scale < 1e-6 || tour->scale > 1e6))
        return "--scale is from 1e-6 to 1e6";
    if (tour->offset > 1e7) return "--offset is 1e7 at most";
    if (a->family && !family_find(a->family)) return "no such family (see --family list)";
    if (a->out && (!a->family || a->worlds > 1)) return "--out takes one world of one --family";
    tour->knobs.method = (occ_method)method;
    tour->backend = (occ_backend)backend;
    tour->worlds = a->worlds ? a->worlds : a->out ? 1 : 112;
    if (a->min_area > 0.0) tour->knobs.min_area = (float)a->min_area;
    return NULL;
}

static int list_families(void)
{
    for (const family *f = families; f->name; f++)
        printf("%-20s %s\n", f->name, f->brief);
    return 0;
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_hard(int argc, char **argv, hard_arguments *a)
{
    *a = (hard_arguments){.method = "single", .backend = "plain"};
    a->tour =
        (tour_settings){.scale = -1.0, .offset = -1.0, .knobs = trial_knobs(OCC_METHOD_SINGLE)};
    const options_entry entries[] = {
        {"--family", OPTIONS_TEXT, &a->family},
        {"--scale", OPTIONS_REAL, &a->tour.scale},
        {"--offset", OPTIONS_REAL, &a->tour.offset},
        {"--seed", OPTIONS_TEXT, &a->seed},
        {"--worlds", OPTIONS_COUNT, &a->worlds},
        {"--method", OPTIONS_TEXT, &a->method},
        {"--backend", OPTIONS_TEXT, &a->backend},
        {"--threads", OPTIONS_COUNT, &a->tour.threads},
        {"--min-area", OPTIONS_REAL, &a->min_area},
        {"--grain", OPTIONS_COUNT, &a->tour.knobs.grain},
        {"--max-occluders", OPTIONS_COUNT, &a->tour.knobs.max_occluders},
        {"--csv", OPTIONS_TEXT, &a->csv},
        {"--out", OPTIONS_TEXT, &a->out},
        {NULL, OPTIONS_FLAG, NULL}};
    char *words[1];
    int count = options_parse(argc, argv, entries, words, 0);
    if (count < 0) return count == OPTIONS_HELP ? OPTIONS_HELP : 2;
    if (a->family && strcmp(a->family, "list") == 0) return 0;
    const char *complaint = complete(a);
    return complaint ? options_complain(argv[0], complaint) : 0;
}

// --- the table -----------------------------------------------------------------------------------

static double percent(uint64_t part, uint64_t whole)
{
    return whole ? 100.0 * (double)part / (double)whole : 0.0;
}

static void print_row(const char *name, const tour_result *r)
{
    const trial_tally *t = &r->tally;
    printf("%-20s %7llu %9llu %9llu %9llu %9llu %7llu %9llu %6.2f %8llu %6.3f\n", name,
           (unsigned long long)t->worlds, (unsigned long long)t->verdicts,
           (unsigned long long)t->hidden, (unsigned long long)t->seen,
           (unsigned long long)t->outside, (unsigned long long)t->false_hidden,
           (unsigned long long)t->missed, percent(t->missed, t->hidden),
           (unsigned long long)t->generous, percent(r->effort.exact, r->effort.signs));
}

static void write_row(FILE *stream, const char *name, const tour_result *r)
{
    const trial_tally *t = &r->tally;
    fprintf(stream, "%s,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%.4f,%llu,%.4f\n", name,
            (unsigned long long)t->worlds, (unsigned long long)t->verdicts,
            (unsigned long long)t->hidden, (unsigned long long)t->seen,
            (unsigned long long)t->outside, (unsigned long long)t->false_hidden,
            (unsigned long long)t->missed, percent(t->missed, t->hidden),
            (unsigned long long)t->generous, percent(r->effort.exact, r->effort.signs));
}

static void write_head(FILE *stream, const hard_arguments *a, const tour_crew *crew)
{
    char driver[256];
    build_info_device(tour_view(crew), driver, sizeof driver);
    build_info_write(stream, driver);
    fprintf(stream, "# method=%s\n# backend=%s\n# threads=%u\n# first_world=%llu\n", a->method,
            a->backend, a->tour.threads, (unsigned long long)a->tour.first);
    fputs("family,worlds,verdicts,hidden,seen,outside,false_hidden,missed,missed_pct,generous,"
          "exact_pct\n",
          stream);
}

// How to get at a world that something is wrong with.
static void name_world(const hard_arguments *a, const char *name, uint64_t number, const char *what)
{
    family_place place = tour_place(&a->tour, number);
    fprintf(stderr,
            "occlude-bench: %s: --family %s --scale %g --offset %g --seed %llu --worlds 1 --method "
            "%s --backend %s\n",
            what, name, place.scale, place.offset, (unsigned long long)number, a->method,
            a->backend);
}

// --- the run -------------------------------------------------------------------------------------

// False if the library refused a world.
static bool run_family(const hard_arguments *a, tour_crew *crew, const family *f, FILE *table,
                       trial_tally *sum)
{
    tour_result result = tour_run(crew, f, &a->tour);
    if (result.error) {
        name_world(a, f->name, result.refused, occ_result_message(result.error));
        return false;
    }
    if (result.tally.false_hidden)
        name_world(a, f->name, result.forbidden, "hides what can be seen");
    print_row(f->name, &result);
    fflush(stdout);
    if (table) write_row(table, f->name, &result);
    trial_add(sum, &result.tally);
    return true;
}

static bool run_all(const hard_arguments *a, tour_crew *crew, FILE *table, trial_tally *sum)
{
    uint32_t count = 0;
    printf("%-20s %7s %9s %9s %9s %9s %7s %9s %6s %8s %6s\n", "family", "worlds", "verdicts",
           "hidden", "seen", "outside", "false_h", "missed", "%", "generous", "exact%");
    progress_begin("running families", a->family ? 1 : family_count());
    bool good = true;
    for (const family *f = families; f->name && good; f++) {
        if (a->family && strcmp(a->family, f->name) != 0) continue;
        good = run_family(a, crew, f, table, sum);
        progress_step(++count);
    }
    progress_end();
    if (good)
        printf("families=%u worlds=%llu verdicts=%llu false_hidden=%llu missed=%llu "
               "missed_pct=%.3f\n",
               count, (unsigned long long)sum->worlds, (unsigned long long)sum->verdicts,
               (unsigned long long)sum->false_hidden, (unsigned long long)sum->missed,
               percent(sum->missed, sum->hidden));
    return good;
}

static bool write_scene(const hard_arguments *a)
{
    family_world world;
    family_place place = tour_place(&a->tour, a->tour.first);
    family_find(a->family)->make(&world, &place);
    return hard_scene_write(a->out, &world);
}

int bench_hard(int argc, char **argv)
{
    hard_arguments a;
    trial_tally sum = {0};
    outfile table = {0};
    int status = parse_hard(argc, argv, &a);
    if (status == OPTIONS_HELP) return fputs(hard_usage, stdout) < 0;
    if (status != 0) return status;
    if (a.family && strcmp(a.family, "list") == 0) return list_families();
    if (a.csv && !outfile_open(&table, a.csv)) return 1;
    tour_crew *crew = tour_open(&a.tour);
    bool good = crew != NULL;
    if (!crew) fprintf(stderr, "occlude-bench: no view on backend %s\n", a.backend);
    if (good && a.csv) write_head(table.stream, &a, crew);
    if (good && a.out) good = write_scene(&a);
    good = good && run_all(&a, crew, table.stream, &sum);
    tour_close(crew);
    if (!good) {
        outfile_abandon(&table);
    } else if (a.csv) {
        good = outfile_commit(&table);
    }
    if (!good) return 1;
    return sum.false_hidden ? STATUS_FALSE_HIDDEN : 0;
}
