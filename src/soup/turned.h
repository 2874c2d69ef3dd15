// SPDX-License-Identifier: Apache-2.0
// Axes for grids: those of the world, and others that a part of a mesh suggests.
#ifndef OCC_SOUP_TURNED_H
#define OCC_SOUP_TURNED_H

#include "soup/voxels.h"

#define OCC_MOST_TURNS 3

// Writes the world's axes, then those of the normals that most of the area has, then those along
// which the area extends; but none that are those before, nearly. Returns how many.
uint32_t occ_turned_axes(const occ_triangles *triangles, float axes[OCC_MOST_TURNS][3][3]);

#endif
