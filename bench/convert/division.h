// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a model becomes objects: which triangles go together, and the box around them. One function,
/// so that whoever needs the triangles of a scene's objects can find them again from the model.
#ifndef OCC_BENCH_DIVISION_H
#define OCC_BENCH_DIVISION_H

#include "cluster.h"

enum { DIVISION_PATTERNS = 64 };

/// What decides about it beside the model's file: three options of a command line, as they stand
/// there. division_defaults() begins it, division_complete() ends it; then it must not be copied.
typedef struct division_options {
    uint32_t most;     ///< --triangles: at most so many in an object.
    const char *up;    ///< --up
    char *see_through; ///< --see-through: patterns, cut at their commas in place.
    model_options model;
    const char *patterns[DIVISION_PATTERNS];
} division_options;

/// The division of a model. All zero is empty; division_free() it when done.
typedef struct division {
    sheet_list sheets;
    cluster_list objects;
    occ_box *boxes; ///< One around each object: every corner of its triangles is inside, exactly.
} division;

/// 32 triangles.
division_options division_defaults(void);

/// Understands the texts. Returns a complaint, or NULL.
const char *division_complete(division_options *options);

/// Divides. The same model and `most` give the same bits. On failure says why on standard error,
/// zeroes `out` and returns false.
bool division_make(const model *m, uint32_t most, division *out);

void division_free(division *d);

#endif
