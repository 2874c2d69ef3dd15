// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <occlude/occlude.h>

#include <stdio.h>
#include <string.h>

typedef struct bench_command {
    const char *name, *usage, *brief, *example;
    int (*run)(int argc, char **argv);
} bench_command;

static const bench_command bench_commands[] = {
    {"seed", "seed [--counts LIST] [--csv F.csv] [--plot P.png]",
     "the 2019 thesis's experiment: 1 to 1,000,000 objects, ours next to its figures",
     "occlude-bench seed --plot seed.png", bench_seed},
    {"scene", "scene NAME COUNT SEED --out F.obs",
     "write a named scene: seedscene, city, forest, soup, interior",
     "occlude-bench scene city 10000 2 --out city.obs", bench_scene},
    {"cull", "cull F.obs [--method M] [--backend B] [--threads T] [--out R.vis] [--csv F.csv] ...",
     "cull every frame of a scene file, and measure it",
     "occlude-bench cull city.obs --method single --backend openmp", bench_cull},
    {"convert", "convert MODEL --out F.obs",
     "turn a model (OBJ, PLY, glTF) into boxes, occluders and a camera path",
     "occlude-bench convert hall.obj --out hall.obs", bench_convert},
    {"picture", "picture F.obs --frame K --out P.png",
     "draw what was decided in a frame, from above and from the camera",
     "occlude-bench picture city.obs --frame 20 --out city.png", bench_picture},
    {"image", "image F.obs --model MODEL [--frames LIST] [--size WxH] [--method M] ...",
     "draw a converted model with and without culling, and compare every pixel",
     "occlude-bench image hall.obs --model hall.obj --every 10", bench_image},
    {"truth", "truth F.obs --out T.tru [--frames LIST] [--size WxH]",
     "find out by sampling what can truly be seen",
     "occlude-bench truth city.obs --frames 0,20,40 --out city.tru", bench_truth},
    {"compare", "compare T.tru R.vis [--scene F.obs [--settle N] [--hidden N]]",
     "judge a result by it: false-hidden and missed objects",
     "occlude-bench compare city.tru city.vis --scene city.obs", bench_compare},
    {"hard", "hard [--family F] [--scale S] [--offset O] [--seed N] [--worlds N] [--method M] ...",
     "run the hard cases and judge every answer exactly", "occlude-bench hard --method pairwise",
     bench_hard},
    {"error", "error [--quick] [--scenes DIR] [--scene NAME] [--out DIR] ...",
     "speed against error: every method and setting on every scene, as CSV, tables and plots",
     "occlude-bench error --quick --out error", bench_error},
    {"gpu", "gpu F.obs | NAME COUNT SEED [--arrange] [--move] [--devices N] ...",
     "cull with every object tested on an OpenCL device, and measure it",
     "occlude-bench gpu city 1000000 2 --every 6", bench_gpu},
};
enum { COMMANDS = sizeof bench_commands / sizeof *bench_commands };

static void print_usage(FILE *stream)
{
    fprintf(
        stream,
        "occlude-bench %d.%d.%d: measures occlude, the library that tells an engine which of its\n"
        "objects the camera can see.\n\n"
        "usage: occlude-bench COMMAND ...\n",
        OCC_VERSION_MAJOR, OCC_VERSION_MINOR, OCC_VERSION_PATCH);
    for (int i = 0; i < COMMANDS; i++) {
        const bench_command *command = &bench_commands[i];
        fprintf(stream, "\n  %s\n      %s\n      example: %s\n", command->usage, command->brief,
                command->example);
    }
    fputs(
        "\n`occlude-bench COMMAND --help` tells all of a command's options. Exit status: 0; 1 if\n"
        "an input cannot be used (nothing is written then); 2 on bad usage; 3 if `compare`,\n"
        "`image`, `hard` or `error` finds a visible object reported hidden that must not be.\n",
        stream);
}

int main(int argc, char **argv)
{
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return 0;
    }
    for (int i = 0; i < COMMANDS; i++)
        if (strcmp(argv[1], bench_commands[i].name) == 0)
            return bench_commands[i].run(argc - 1, argv + 1);
    fprintf(stderr,
            "occlude-bench: no command is named %.200s (run occlude-bench alone for help)\n",
            argv[1]);
    return 2;
}
