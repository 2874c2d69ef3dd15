// SPDX-License-Identifier: Apache-2.0
// A soup made ready: equal positions are one vertex, no triangle has a vertex twice, and no two
// have the same three. Triangles whose corners are in line stay: they close cracks.
#ifndef OCC_SOUP_MESH_H
#define OCC_SOUP_MESH_H

#include "memory.h"

#include <occlude/soup.h>

typedef struct occ_mesh {
    float (*at)[3];        // never -0
    uint32_t (*corner)[3]; // vertices of each triangle, in the winding of the soup
    uint32_t *source;      // which triangle of the soup it is
    uint32_t vertices, vertex_room;
    uint32_t triangles, triangle_room;
    float min[3], max[3];
} occ_mesh;

// `soup` has passed occ_soup_check().
occ_result occ_mesh_build(occ_hooks *hooks, const occ_soup *soup, occ_mesh *mesh);

void occ_mesh_free(occ_hooks *hooks, occ_mesh *mesh);

// fmin() and fmax() mind NaN, and are calls.
static inline double occ_least(double a, double b)
{
    return a < b ? a : b;
}

static inline double occ_most(double a, double b)
{
    return a > b ? a : b;
}

static inline const float *occ_mesh_corner(const occ_mesh *mesh, uint32_t triangle, int i)
{
    return mesh->at[mesh->corner[triangle][i]];
}

#endif
