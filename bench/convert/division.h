// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a model becomes objects: which triangles go together, and the box around them. One function,
/// so that whoever needs the triangles of a scene's objects can find them again from the model.
#ifndef OCC_BENCH_DIVISION_H
#define OCC_BENCH_DIVISION_H

#include "model.h"

#include <occlude/scene.h>

enum { DIVISION_PATTERNS = 64 };

/// What is not to share an object.
typedef enum division_apart {
    DIVISION_APART_LIGHT = 0, ///< What light passes, and what it does not.
    DIVISION_APART_MATERIAL = 1,
    DIVISION_APART_MESH = 2
} division_apart;

/// What decides about it beside the model's file: options of a command line, as they stand there.
/// division_defaults() begins it, division_complete() ends it; then it must not be copied.
typedef struct division_options {
    uint32_t most;     ///< --triangles: at most so many in an object.
    const char *up;    ///< --up
    const char *split; ///< --split: what is kept apart.
    char *see_through; ///< --see-through: patterns, cut at their commas in place.
    model_options model;
    const char *patterns[DIVISION_PATTERNS];
    division_apart apart;
} division_options;

/// The division of a model: every triangle is in exactly one object. All zero is empty;
/// division_free() it when done.
typedef struct division {
    uint32_t count;      ///< Objects.
    uint32_t *first;     ///< Object i has triangles[first[i]] up to triangles[first[i + 1]].
    uint32_t *triangles; ///< The model's triangles, object by object.
    uint32_t *object_of; ///< The object of each triangle.
    occ_box *boxes;      ///< One around each object: its triangles are inside, exactly.
    uint32_t instanced;  ///< Objects whose clusters and boxes were found for a mesh once.
    uint32_t turned;     ///< Objects whose box is not along the axes.
} division;

/// 32 triangles.
division_options division_defaults(void);

/// Understands the texts. Returns a complaint, or NULL.
const char *division_complete(division_options *options);

/// Divides. The same model and options give the same bits. On failure says why on standard error,
/// zeroes `out` and returns false.
bool division_make(const model *m, const division_options *options, division *out);

void division_free(division *d);

#endif
