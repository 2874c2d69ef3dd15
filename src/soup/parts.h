// SPDX-License-Identifier: Apache-2.0
// Parts of a mesh that can be told apart by planes along the axes: what is inside one does not
// depend on the others, and each gets a grid of its own.
#ifndef OCC_SOUP_PARTS_H
#define OCC_SOUP_PARTS_H

#include "soup/mesh.h"

// The triangles [first, first + count) of occ_parts.triangle. Closed bounds of no two parts meet.
typedef struct occ_part {
    uint32_t first, count;
    float min[3], max[3];
} occ_part;

typedef struct occ_parts {
    occ_array part;     // occ_part
    uint32_t *triangle; // those of the mesh, part by part, ascending within each
    uint32_t triangles;
} occ_parts;

// `whole`: the mesh is one part.
occ_result occ_parts_build(occ_hooks *hooks, const occ_mesh *mesh, bool whole, occ_parts *parts);

void occ_parts_free(occ_hooks *hooks, occ_parts *parts);

static inline const occ_part *occ_parts_at(const occ_parts *parts, uint32_t i)
{
    return (const occ_part *)parts->part.data + i;
}

#endif
