// SPDX-License-Identifier: Apache-2.0
/// @file
/// Splits a soup of triangles into objects: compact groups with tight boxes.
#ifndef OCC_BENCH_CLUSTER_H
#define OCC_BENCH_CLUSTER_H

#include "model.h"
#include "sheets.h"

/// Every triangle in exactly one object. All zero is empty; clusters_free() it when done.
typedef struct cluster_list {
    uint32_t count;
    uint32_t *first;     ///< Object i has triangles[first[i]] up to triangles[first[i + 1]].
    uint32_t *triangles; ///< The model's triangles, object by object.
    uint32_t *object_of; ///< The object of each triangle.
} cluster_list;

/// Splits a model into objects of at most `most` triangles (at least 2), the two triangles of a
/// sheet never apart. Returns false when memory runs out.
bool clusters_build(const model *m, const sheet_list *sheets, uint32_t most, cluster_list *out);

/// Frees what a list holds and zeroes it.
void clusters_free(cluster_list *list);

#endif
