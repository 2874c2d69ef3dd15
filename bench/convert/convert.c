// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "cluster.h"
#include "model.h"
#include "obs.h"
#include "options.h"
#include "path.h"
#include "progress.h"
#include "sheets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CONVERT_PATTERNS = 64 };

typedef struct convert_arguments {
    const char *model, *out, *up;
    char *see_through; // one pattern after the other, by commas
    const char *patterns[CONVERT_PATTERNS];
    model_options options;
    uint32_t most, frames;
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

// Cuts the list at its commas, in place.
static bool split_patterns(convert_arguments *arguments)
{
    char *next = arguments->see_through;
    while (next && *next) {
        if (arguments->options.see_through_count == CONVERT_PATTERNS) return false;
        arguments->patterns[arguments->options.see_through_count++] = next;
        next = strchr(next, ',');
        if (next) *next++ = '\0';
    }
    arguments->options.see_through = arguments->patterns;
    return true;
}

// Returns a complaint, or NULL.
static const char *complete_arguments(convert_arguments *arguments)
{
    if (!arguments->out) return "expected --out F.obs";
    if (arguments->most < 2) return "--triangles is 2 at least: a sheet's triangles stay together";
    if (arguments->frames > 100000) return "--frames is 100000 at most";
    if (!split_patterns(arguments)) return "too many patterns after --see-through";
    if (!arguments->up) return NULL;
    if (strcmp(arguments->up, "y") != 0 && strcmp(arguments->up, "z") != 0)
        return "expected y or z after --up";
    arguments->options.up = *arguments->up == 'y' ? MODEL_UP_Y : MODEL_UP_Z;
    return NULL;
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_convert(int argc, char **argv, convert_arguments *arguments)
{
    *arguments = (convert_arguments){.most = 32, .frames = 60};
    const options_entry entries[] = {{"--out", OPTIONS_TEXT, &arguments->out},
                                     {"--triangles", OPTIONS_COUNT, &arguments->most},
                                     {"--frames", OPTIONS_COUNT, &arguments->frames},
                                     {"--eye", OPTIONS_REAL, &arguments->eye_height},
                                     {"--up", OPTIONS_TEXT, &arguments->up},
                                     {"--see-through", OPTIONS_TEXT, &arguments->see_through},
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

// One object's bounds. The points are copied together for the library's own function.
static bool bound_object(const model *m, const cluster_list *objects, uint32_t object,
                         float (*points)[3], occ_box *box)
{
    size_t count = 0;
    for (uint32_t i = objects->first[object]; i < objects->first[object + 1]; i++)
        for (int c = 0; c < 3; c++)
            memcpy(points[count++], m->positions[m->corners[objects->triangles[i]][c]],
                   3 * sizeof(float));
    occ_result result = occ_box_from_points(points[0], count, 0, box);
    if (result == OCC_SUCCESS) return true;
    fprintf(stderr, "occlude-bench: bounds of object %u: %s\n", object, occ_result_message(result));
    return false;
}

static bool add_objects(const model *m, const cluster_list *objects, obs_scene *scene)
{
    uint32_t most = 0;
    for (uint32_t o = 0; o < objects->count; o++) {
        uint32_t count = objects->first[o + 1] - objects->first[o];
        if (count > most) most = count;
    }
    float(*points)[3] = malloc(((size_t)most * 3 + 1) * sizeof *points);
    if (!points) return out_of_memory();
    bool good = true;
    for (uint32_t o = 0; good && o < objects->count; o++) {
        occ_box box;
        good = bound_object(m, objects, o, points, &box) &&
               (obs_add_object(scene, &box) != UINT32_MAX || out_of_memory());
    }
    free(points);
    return good;
}

static bool add_sheets(const sheet_list *sheets, const cluster_list *objects, double least_area,
                       obs_scene *scene)
{
    for (uint32_t i = 0; i < sheets->count; i++) {
        const sheet *s = &sheets->at[i];
        if (s->area < least_area) continue;
        uint32_t owner = objects->object_of[s->triangles[0]];
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

static bool make_objects(const convert_arguments *arguments, const model *m,
                         const sheet_list *sheets, obs_scene *scene)
{
    cluster_list objects;
    if (!clusters_build(m, sheets, arguments->most, &objects)) return out_of_memory();
    bool good = add_objects(m, &objects, scene) &&
                add_sheets(sheets, &objects, arguments->least_area, scene);
    clusters_free(&objects);
    return good;
}

static bool convert_model(const convert_arguments *arguments, const model *m)
{
    sheet_list sheets;
    obs_scene scene = {0};
    path_report path;
    if (!sheets_find(m, &sheets)) return out_of_memory();
    bool good = make_objects(arguments, m, &sheets, &scene) &&
                (path_make(m, arguments->frames, arguments->eye_height, &scene, &path) ||
                 out_of_memory()) &&
                obs_write(arguments->out, &scene);
    if (good) print_report(m, &sheets, &path, &scene);
    obs_free(&scene);
    sheets_free(&sheets);
    return good;
}

int bench_convert(int argc, char **argv)
{
    convert_arguments arguments;
    int status = parse_convert(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(convert_usage, stdout) < 0;
    if (status != 0) return status;
    model m;
    if (!model_read(arguments.model, &arguments.options, &m)) return 1;
    bool good = convert_model(&arguments, &m);
    model_free(&m);
    return good ? 0 : 1;
}
