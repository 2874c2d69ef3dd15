// SPDX-License-Identifier: Apache-2.0
// The edges of a mesh and the triangles at each. Where a vertex lies on an edge, exactly, the edge
// is cut: there the neighbours have shorter ones.
#ifndef OCC_SOUP_EDGES_H
#define OCC_SOUP_EDGES_H

#include "soup/mesh.h"

// Vertices low < high, and a triangle at it.
typedef struct occ_edge_use {
    uint32_t low, high, triangle;
} occ_edge_use;

// Edge e has uses [first[e], first[e + 1]), by triangle, no triangle twice.
typedef struct occ_edges {
    occ_edge_use *use;
    uint32_t *first;
    uint32_t count, uses;
    size_t room;
} occ_edges;

occ_result occ_edges_build(occ_hooks *hooks, const occ_mesh *mesh, occ_edges *edges);

void occ_edges_free(occ_hooks *hooks, occ_edges *edges);

#endif
