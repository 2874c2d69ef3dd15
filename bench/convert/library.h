// SPDX-License-Identifier: Apache-2.0
/// @file
/// The library's long calls, as a command makes them: its log lines go to standard error, and its
/// progress to the line there.
#ifndef OCC_BENCH_LIBRARY_H
#define OCC_BENCH_LIBRARY_H

#include "model.h"

#include <occlude/soup.h>
#include <stdio.h>

/// Reports under the label that progress_begin() was given with LIBRARY_STEPS.
occ_soup_work library_work(void);
enum { LIBRARY_STEPS = 1000 };

/// Whether a call went well; if not, says what was being done, and why that failed.
bool library_succeeded(occ_result result, const char *what);

/// "not enough memory", on standard error. False.
static inline bool library_out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

/// Some of a model's triangles, as their corners say.
occ_soup library_soup(const model *m, const uint32_t (*corners)[3], uint32_t count);

/// All triangles of a mesh that has several places, in its own coordinates.
occ_soup library_mesh_soup(const model_mesh *mesh);

#endif
