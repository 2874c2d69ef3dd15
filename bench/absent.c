// SPDX-License-Identifier: Apache-2.0
// Stand in for commands, and what several of them share, whose packages were not there when this
// was built.
#include "commands.h"
#include "model.h"

#include <stdio.h>

#ifndef OCC_BENCH_CONVERT
int bench_convert(int argc, char **argv)
{
    (void)argc;
    fprintf(stderr, "occlude-bench %s: built without Assimp, which it needs\n", argv[0]);
    return 1;
}

bool model_read(const char *path, const model_options *options, model *out)
{
    (void)options;
    *out = (model){0};
    fprintf(stderr, "occlude-bench: %s: built without Assimp, which reading models needs\n", path);
    return false;
}
#endif

#ifndef OCC_BENCH_PICTURE
int bench_picture(int argc, char **argv)
{
    (void)argc;
    fprintf(stderr, "occlude-bench %s: built without stb_image_write.h, which it needs\n", argv[0]);
    return 1;
}
#endif

#ifndef OCC_BENCH_IMAGE
int bench_image(int argc, char **argv)
{
    (void)argc;
    fprintf(stderr,
            "occlude-bench %s: built without OpenGL (EGL), Assimp or stb_image_write.h, which it "
            "needs\n",
            argv[0]);
    return 1;
}
#endif

#ifndef OCC_BENCH_HARD
int bench_hard(int argc, char **argv)
{
    (void)argc;
    fprintf(stderr, "occlude-bench %s: built without GMP, which it needs\n", argv[0]);
    return 1;
}
#endif

#ifndef OCC_BENCH_OPENCL
int bench_gpu(int argc, char **argv)
{
    (void)argc;
    fprintf(stderr, "occlude-bench %s: built without OpenCL, which it needs\n", argv[0]);
    return 1;
}
#endif
