// SPDX-License-Identifier: Apache-2.0
/// @file
/// Occluders that need no trust: parallelograms that lie exactly in the surface of a model.
#ifndef OCC_BENCH_SHEETS_H
#define OCC_BENCH_SHEETS_H

#include "model.h"

#include <occlude/scene.h>

/// A box of zero thickness inside the union of two coplanar triangles.
///
/// As real numbers, not only as floats: its corners center ± axis[0] ± axis[1] lie in the plane of
/// the triangles and within them, and axis[2] is zero.
typedef struct sheet {
    occ_box box;
    uint32_t triangles[2];
    double area;
    double worth; ///< What decided which of several sheets was kept.
} sheet;

/// No triangle is in two sheets. All zero is empty; sheets_free() it when done.
typedef struct sheet_list {
    sheet *at;
    uint32_t count;
    uint32_t coplanar_pairs; ///< Pairs of triangles that share an edge, a plane and a facing.
    double area;             ///< Of all the sheets.
} sheet_list;

/// Finds the sheets of a model, in order of area, larger first. Where a triangle could go into
/// several, the larger and squarer one is kept. Returns false when memory runs out.
bool sheets_find(const model *m, sheet_list *out);

/// Frees what a list holds and zeroes it.
void sheets_free(sheet_list *list);

#endif
