// SPDX-License-Identifier: Apache-2.0
/// @file
/// The subcommands of occlude-bench. Each gets its own name as argv[0] and returns the exit status:
/// 0, 1 when an input could not be used (after a message, with nothing written), 2 on bad usage,
/// and 3 when `compare`, `image`, `hard` or `error` found a visible object reported hidden that
/// must not be.
#ifndef OCC_BENCH_COMMANDS_H
#define OCC_BENCH_COMMANDS_H

/// Writes one of the named scenes.
int bench_scene(int argc, char **argv);

/// Culls every frame of a scene file, and measures it.
int bench_cull(int argc, char **argv);

/// The 2019 thesis's experiment.
int bench_seed(int argc, char **argv);

/// Triangles to boxes and a camera path.
int bench_convert(int argc, char **argv);

/// Draws what was decided in one frame.
int bench_picture(int argc, char **argv);

/// Draws a model with and without culling, and compares.
int bench_image(int argc, char **argv);

/// Finds out by sampling what can truly be seen.
int bench_truth(int argc, char **argv);

/// Judges a result file by it.
int bench_compare(int argc, char **argv);

/// The families of hard cases, judged exactly.
int bench_hard(int argc, char **argv);

/// Speed against error, for every method and scene.
int bench_error(int argc, char **argv);

/// Tables on an OpenCL device, measured.
int bench_gpu(int argc, char **argv);

#endif
