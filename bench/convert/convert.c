// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "division.h"
#include "library.h"
#include "names.h"
#include "obs.h"
#include "options.h"
#include "path.h"
#include "solids.h"
#include "walls.h"

#include <stdio.h>
#include <string.h>

typedef struct convert_arguments {
    const char *model, *out, *names;
    division_options division;
    solids_wish solids;
    walls_wish walls;
    uint32_t frames;
    double eye_height;
} convert_arguments;

// What was made.
typedef struct conversion {
    division objects;
    obs_scene scene;
    path_report path;
    walls_report walls;
    solids_report solids;
} conversion;

static const char convert_usage[] =
    "usage: occlude-bench convert MODEL --out F.obs [options]\n"
    "\n"
    "Turns a model (OBJ, PLY, glTF: anything Assimp reads) into a scene file: compact objects\n"
    "with their bounds, a camera path through its free space, and occluders: sheets that lie\n"
    "exactly in its surface, and boxes that lie in what is solid. What is guaranteed is told in\n"
    "docs/convert.md.\n"
    "\n"
    "  --triangles N        at most so many triangles in an object (default 32)\n"
    "  --split W            what is not to share an object: light (default: what light passes and\n"
    "                       what not), material or mesh\n"
    "  --names F.csv        write which meshes and materials the objects are of\n"
    "  --frames N           frames of the camera path (default 60)\n"
    "  --eye H              height of the eye above floors, in the model's units (default: 3 % of\n"
    "                       its width, or 10 % of its height if that is less)\n"
    "  --up A               y or z: the model's upward axis (default: y for glTF, else the one of\n"
    "                       y and z along which the model extends less; y is up in what is\n"
    "                       written)\n"
    "  --see-through LIST   patterns of materials or meshes that light passes, with commas\n"
    "                       between (such as glass*,water): these never occlude\n"
    "  --sheets K           at most so many sheets, those that cover most first (default 8192)\n"
    "  --min-sheet A        leave out sheets of an area below A (default 0)\n"
    "  --one-sided          triangles are drawn from where they go counterclockwise only\n"
    "  --inner K            at most so many inner boxes of the model as a whole (default 128)\n"
    "  --inner-mesh K       and of each mesh that stands in several places (default 8)\n"
    "  --coverage C         enough of the silhouette for inner boxes, 0 to 1 (default: all)\n"
    "  --max-hole H         openings up to this width count as closed (default 0: none does)\n"
    "  --cells N            most cells of a grid for inner boxes (default 4194304)\n"
    "\n"
    "Example: occlude-bench convert hall.obj --out hall.obs --see-through 'glass*'\n";

// Returns a complaint, or NULL.
static const char *complete_arguments(convert_arguments *arguments)
{
    const solids_wish *solids = &arguments->solids;
    if (!arguments->out) return "expected --out F.obs";
    if (arguments->frames > 100000) return "--frames is 100000 at most";
    if (solids->most > 1000000 || solids->most_placed > 1000000)
        return "--inner and --inner-mesh are 1000000 at most";
    if (solids->coverage > 1) return "--coverage is from 0 to 1";
    if (solids->max_cells && (solids->max_cells < 4096 || solids->max_cells > 1u << 28))
        return "--cells is from 4096 to 268435456";
    return division_complete(&arguments->division);
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_convert(int argc, char **argv, convert_arguments *arguments)
{
    *arguments = (convert_arguments){.division = division_defaults(),
                                     .solids = {.most = 128, .most_placed = 8},
                                     .frames = 60,
                                     .walls = {.most = 8192}};
    division_options *dividing = &arguments->division;
    solids_wish *solids = &arguments->solids;
    const options_entry entries[] = {{"--out", OPTIONS_TEXT, &arguments->out},
                                     {"--names", OPTIONS_TEXT, &arguments->names},
                                     {"--triangles", OPTIONS_COUNT, &dividing->most},
                                     {"--split", OPTIONS_TEXT, &dividing->split},
                                     {"--frames", OPTIONS_COUNT, &arguments->frames},
                                     {"--eye", OPTIONS_REAL, &arguments->eye_height},
                                     {"--up", OPTIONS_TEXT, &dividing->up},
                                     {"--see-through", OPTIONS_TEXT, &dividing->see_through},
                                     {"--sheets", OPTIONS_MOST, &arguments->walls.most},
                                     {"--min-sheet", OPTIONS_REAL, &arguments->walls.min_area},
                                     {"--one-sided", OPTIONS_FLAG, &arguments->walls.one_sided},
                                     {"--inner", OPTIONS_MOST, &solids->most},
                                     {"--inner-mesh", OPTIONS_MOST, &solids->most_placed},
                                     {"--coverage", OPTIONS_REAL, &solids->coverage},
                                     {"--max-hole", OPTIONS_REAL, &solids->max_hole},
                                     {"--cells", OPTIONS_COUNT, &solids->max_cells},
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

static bool add_objects(const division *d, obs_scene *scene)
{
    for (uint32_t o = 0; o < d->count; o++)
        if (obs_add_object(scene, &d->boxes[o]) == UINT32_MAX) return library_out_of_memory();
    return true;
}

static bool add_solids(const convert_arguments *arguments, const model *m, conversion *c)
{
    solids_wish wish = arguments->solids;
    wish.within = strcmp(c->path.kind, "orbit") != 0;
    return solids_find(m, &wish, &c->scene, &c->solids);
}

static void print_report(const model *m, const convert_arguments *arguments, const conversion *c)
{
    const solids_report *solids = &c->solids;
    const walls_report *walls = &c->walls;
    printf(
        "model   %u triangles, %u vertices, %c is up; %u see-through, %u faces skipped that are\n"
        "        points or lines\n",
        m->triangle_count, m->vertex_count, m->up == MODEL_UP_Z ? 'z' : 'y', m->see_through_count,
        m->skipped_faces);
    printf("objects %u, of instances %u, with boxes turned from the axes %u\n", c->objects.count,
           c->objects.instanced, c->objects.turned);
    printf("path    %u frames, %s of %g units, %g from the nearest triangle, near %g, far %g\n",
           c->scene.frame_count, c->path.kind, c->path.length, c->path.clearance, c->path.near_z,
           c->path.far_z);
    printf("sheets  %u of %u found in %u planes; all cover %.1f %% of the opaque surface\n",
           walls->sheets, walls->found, walls->planes, 100 * walls->share);
    printf("inner   %u boxes, %u of them proven without tolerance; %.1f %% of the silhouette%s\n",
           solids->boxes, solids->closed, 100 * solids->coverage,
           strcmp(c->path.kind, "orbit") != 0 ? "s of its layers" : "");
    if (arguments->solids.max_hole > 0)
        printf("        holes up to %g were asked to count as closed; the others' widest is %g\n",
               arguments->solids.max_hole, solids->largest_hole);
    if (solids->of_meshes)
        printf("        and %u of meshes in several places, there %u\n", solids->of_meshes,
               solids->carried);
    printf("triangles=%u objects=%u sheets=%u sheet_area_pct=%.2f inner=%u frames=%u path=%s\n",
           m->triangle_count, c->scene.object_count, walls->sheets, 100 * walls->share,
           solids->boxes + solids->carried, c->scene.frame_count, c->path.kind);
}

static bool make_scene(const convert_arguments *arguments, const model *m, conversion *c)
{
    if (!division_make(m, &arguments->division, &c->objects)) return false;
    if (!add_objects(&c->objects, &c->scene)) return false;
    if (!path_make(m, arguments->frames, arguments->eye_height, &c->scene, &c->path))
        return library_out_of_memory();
    return walls_find(m, &c->objects, &arguments->walls, &c->scene, &c->walls) &&
           add_solids(arguments, m, c);
}

static bool convert_model(const convert_arguments *arguments, const model *m)
{
    conversion c = {0};
    bool good = make_scene(arguments, m, &c) &&
                (!arguments->names || names_write(arguments->names, m, &c.objects)) &&
                obs_write(arguments->out, &c.scene);
    if (good) print_report(m, arguments, &c);
    obs_free(&c.scene);
    division_free(&c.objects);
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
