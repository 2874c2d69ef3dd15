// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include "commands.h"
#include "options.h"
#include "steady.h"

#include <stdio.h>
#include <string.h>

const scenes_kind scenes_kinds[] = {
    {"seedscene", "the 2019 thesis's: cubes around random spheres, seen from a corner",
     scenes_seedscene},
    {"city", "blocks of towers, street furniture, a ground; a walk along a street", scenes_city},
    {"forest", "trees whose trunks hide and whose crowns do not; a walk among them", scenes_forest},
    {"soup", "boxes of all sizes and attitudes in a cube; a round in its middle", scenes_soup},
    {"interior", "rooms, corridors, doorways, furniture; a walk through the doorways",
     scenes_interior},
    {NULL, NULL, NULL}};

const scenes_kind *scenes_find(const char *name)
{
    for (const scenes_kind *kind = scenes_kinds; kind->name; kind++)
        if (strcmp(kind->name, name) == 0) return kind;
    return NULL;
}

bool scenes_make(const char *name, uint32_t count, uint64_t seed, obs_scene *scene)
{
    *scene = (obs_scene){0};
    const scenes_kind *kind = scenes_find(name);
    if (!kind || count < 1 || count > SCENES_MAX_COUNT) return false;
    kind->make(scene, count, seed);
    if (!scene->out_of_memory) return true;
    obs_free(scene);
    return false;
}

occ_box scenes_box(double x, double y, double z, double half_x, double half_y, double half_z)
{
    occ_box box = {{(float)x, (float)y, (float)z},
                   {{(float)half_x, 0, 0}, {0, (float)half_y, 0}, {0, 0, (float)half_z}}};
    return box;
}

occ_box scenes_turned(const occ_box *box, double angle)
{
    double cosine = steady_cos(angle), sine = steady_sin(angle);
    occ_box turned = *box;
    for (int k = 0; k < 3; k++) {
        double x = (double)box->axis[k][0], z = (double)box->axis[k][2];
        turned.axis[k][0] = (float)(cosine * x + sine * z);
        turned.axis[k][2] = (float)(cosine * z - sine * x);
    }
    return turned;
}

occ_box scenes_shrunk(const occ_box *box, double x, double y, double z)
{
    const double factors[3] = {x, y, z};
    occ_box shrunk = *box;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            shrunk.axis[k][j] = (float)(factors[k] * (double)box->axis[k][j]);
    return shrunk;
}

static void print_kinds(FILE *stream)
{
    fputs("usage: occlude-bench scene NAME COUNT SEED --out F.obs\n\n"
          "Writes a named scene of about COUNT objects. NAME is one of\n",
          stream);
    for (const scenes_kind *kind = scenes_kinds; kind->name; kind++)
        fprintf(stream, "  %-10s %s\n", kind->name, kind->brief);
    fputs("COUNT is 1 to 20000000, SEED any number below 2^64. The same three words give the same\n"
          "file on every machine.\n\n"
          "Example: occlude-bench scene city 10000 2 --out city_10000.obs\n",
          stream);
}

int bench_scene(int argc, char **argv)
{
    const char *out = NULL;
    const options_entry entries[] = {{"--out", OPTIONS_TEXT, &out}, {NULL, OPTIONS_FLAG, NULL}};
    char *words[3];
    int count = options_parse(argc, argv, entries, words, 3);
    if (count == OPTIONS_HELP) return print_kinds(stdout), 0;
    if (count == OPTIONS_BAD) return 2;
    uint64_t objects, seed;
    if (count != 3 || !out)
        return options_complain(argv[0], "expected NAME COUNT SEED --out F.obs");
    if (!scenes_find(words[0]))
        return options_complain(argv[0],
                                "expected seedscene, city, forest, soup or interior as NAME");
    if (!options_number(words[1], 1, SCENES_MAX_COUNT, &objects))
        return options_complain(argv[0], "expected a COUNT from 1 to 20000000");
    if (!options_number(words[2], 0, UINT64_MAX, &seed))
        return options_complain(argv[0], "expected a whole number as SEED");

    obs_scene scene;
    if (!scenes_make(words[0], (uint32_t)objects, seed, &scene)) {
        fputs("occlude-bench: not enough memory for the scene\n", stderr);
        return 1;
    }
    bool written = obs_write(out, &scene);
    if (written)
        printf("%s: %u objects, %u occluders, %u frames\n", out, scene.object_count,
               obs_occluder_total(&scene), scene.frame_count);
    obs_free(&scene);
    return written ? 0 : 1;
}
