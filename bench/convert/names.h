// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a model's file calls the triangles of an object: for whoever imports a scene beside its
/// model.
#ifndef OCC_BENCH_NAMES_H
#define OCC_BENCH_NAMES_H

#include "division.h"

/// Writes a table: for each object, each mesh that it has triangles of, and where that stands,
/// these triangles' number and the names of the mesh and its material. On failure says why and
/// returns false.
bool names_write(const char *path, const model *m, const division *d);

#endif
