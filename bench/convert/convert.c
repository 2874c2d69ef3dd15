// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "division.h"
#include "obs.h"
#include "options.h"
#include "path.h"

#include <math.h>
#include <stdio.h>

typedef struct convert_arguments {
    const char *model, *out;
    division_options division;
    uint32_t frames;
    double eye_height, least_area;
} convert_arguments;

static const char convert_usage[] =
    "usage: occlude-bench convert MODEL --out F.obs [options]\n"
    "\n"
    "Turns a model (OBJ, PLY, glTF: anything Assimp reads) into a scene file: compact objects "
    "with\n"
    "their bounds, occluders that lie exactly in its surface, and a camera path through its free\n"
    "space. What is guaranteed is told in docs/convert.md.\n"
    "\n"
    "  --triangles N        at most so many triangles in an object (default 32, at least 2)\n"
    "  --frames N           frames of the camera path (default 60)\n"
    "  --eye H              height of the eye above floors, in the model's units (default: 3 % of\n"
    "                       its width, or 10 % of its height if that is less)\n"
    "  --up A               y or z: the model's upward axis (default: y for glTF, else the one of\n"
    "                       y and z along which the model extends less; y is up in what is "
    "written)\n"
    "  --see-through LIST   patterns of materials or meshes that light passes, with commas "
    "between\n"
    "                       (such as glass*,water): these never occlude\n"
    "  --min-sheet A        leave out occluders of an area below A (default 0: keep all)\n"
    "\n"
    "Example: occlude-bench convert hall.obj --out hall.obs --see-through 'glass*'\n";

// Returns a complaint, or NULL.
static const char *complete_arguments(convert_arguments *arguments)
{
    if (!arguments->out) return "expected --out F.obs";
    if (arguments->frames > 100000) return "--frames is 100000 at most";
    return division_complete(&arguments->division);
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_convert(int argc, char **argv, convert_arguments *arguments)
{
    *arguments = (convert_arguments){.division = division_defaults(), .frames = 60};
    division_options *dividing = &arguments->division;
    const options_entry entries[] = {{"--out", OPTIONS_TEXT, &arguments->out},
                                     {"--triangles", OPTIONS_COUNT, &dividing->most},
                                     {"--frames", OPTIONS_COUNT, &arguments->frames},
                                     {"--eye", OPTIONS_REAL, &arguments->eye_height},
                                     {"--up", OPTIONS_TEXT, &dividing->up},
                                     {"--see-through", OPTIONS_TEXT, &dividing->see_through},
                                     {"--min-sheet", OPTIONS_REAL, &arguments->least_area},
                                     {NULL, OPTIONS_FLAG, NULL}};
    char *words[1];
    int count = options_parse(argc, argv, entries, words, 1);
    if (count == OPTIONS_HELP) return OPTIONS_HELP;
    if (count == OPTIONS_BAD) return 2;
    if (count != 1) return options_complain(argv[0], "expected a model file");
    arguments->model = words[0];
    const char *complaint = complete_arguments(arguments);
    return complaint ? options_complain(argv[0], complaint) : 0;
}

static bool out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

static bool add_objects(const division *d, obs_scene *scene)
{
    for (uint32_t o = 0; o < d->objects.count; o++)
        if (obs_add_object(scene, &d->boxes[o]) == UINT32_MAX) return out_of_memory();
    return true;
}

static bool add_sheets(const division *d, double least_area, obs_scene *scene)
{
    for (uint32_t i = 0; i < d->sheets.count; i++) {
        const sheet *s = &d->sheets.at[i];
        if (s->area < least_area) continue;
        uint32_t owner = d->objects.object_of[s->triangles[0]];
        if (obs_add_occluder(scene, &s->box, owner) == UINT32_MAX) return out_of_memory();
    }
    return true;
}

static double surface_of(const model *m)
{
    double sum = 0;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        double e[2][3], square = 0;
        for (int n = 0; n < 2; n++)
            for (int k = 0; k < 3; k++)
                e[n][k] = (double)m->positions[m->corners[t][n + 1]][k] -
                          (double)m->positions[m->corners[t][0]][k];
        for (int k = 0; k < 3; k++) {
            double n =
                e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
            square += n * n;
        }
        sum += sqrt(square) / 2;
    }
    return sum;
}

static void print_report(const model *m, const sheet_list *sheets, const path_report *path,
                         const obs_scene *scene)
{
    double surface = surface_of(m), area = 0;
    for (uint32_t i = 0; i < scene->occluder_count; i++)
        area += sheets->at[i].area; // Sorted by area, so those left out are the last.
    printf(
        "model   %u triangles, %u vertices, %c is up; %u see-through, %u faces skipped that are\n"
        "        points or lines\n",
        m->triangle_count, m->vertex_count, m->up == MODEL_UP_Z ? 'z' : 'y', m->see_through_count,
        m->skipped_faces);
    printf("sheets  %u from %u coplanar pairs of triangles, %.1f %% of the surface\n",
           scene->occluder_count, sheets->coplanar_pairs, surface > 0 ? 100 * area / surface : 0);
    printf("path    %u frames, %s of %g units, %g from the nearest triangle, near %g, far %g\n",
           scene->frame_count, path->kind, path->length, path->clearance, path->near_z,
           path->far_z);
    printf("triangles=%u objects=%u sheets=%u sheet_area_pct=%.2f frames=%u path=%s\n",
           m->triangle_count, scene->object_count, scene->occluder_count,
           surface > 0 ? 100 * area / surface : 0, scene->frame_count, path->kind);
}

static bool convert_model(const convert_arguments *arguments, const model *m)
{
    division d;
    obs_scene scene = {0};
    path_report path;
    if (!division_make(m, arguments->division.most, &d)) return false;
    bool good = add_objects(&d, &scene) && add_sheets(&d, arguments->least_area, &scene) &&
                (path_make(m, arguments->frames, arguments->eye_height, &scene, &path) ||
                 out_of_memory()) &&
                obs_write(arguments->out, &scene);
    if (good) print_report(m, &d.sheets, &path, &scene);
    obs_free(&scene);
    division_free(&d);
    return good;
}

int bench_convert(int argc, char **argv)
{
    convert_arguments arguments;
    int status = parse_convert(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(convert_usage, stdout) < 0;
    if (status != 0) return status;
    model m;
    if (!model_read(arguments.model, &arguments.division.model, &m)) return 1;
    bool good = convert_model(&arguments, &m);
    model_free(&m);
    return good ? 0 : 1;
}
