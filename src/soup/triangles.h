// SPDX-License-Identifier: Apache-2.0
// The triangles of a soup, one after the other.
#ifndef OCC_TRIANGLES_H
#define OCC_TRIANGLES_H

#include "memory.h"

#include <occlude/soup.h>

// Takes over what a caller gave, NULL included; logs and fails like the calls of soup.h.
occ_result occ_soup_hooks(const occ_soup_work *work, occ_hooks *hooks);

// Asks the caller whether to go on with so much of the work done. NULL is accepted.
occ_result occ_soup_progress(const occ_soup_work *work, const occ_hooks *hooks, double done);

// OCC_SUCCESS if every vertex that is named exists and every number is good; else the reason is
// logged.
occ_result occ_soup_validate(const occ_soup *soup, const occ_hooks *hooks);

// What is below needs a valid soup.

static inline uint32_t occ_soup_index(const occ_soup *soup, uint32_t triangle, int corner)
{
    size_t place = 3 * (size_t)triangle + (size_t)corner;
    return soup->indices ? soup->indices[place] : (uint32_t)place;
}

static inline const float *occ_soup_vertex(const occ_soup *soup, uint32_t vertex)
{
    size_t stride = soup->stride ? soup->stride : 3 * sizeof(float);
    return (const float *)(const void *)((const char *)soup->positions + vertex * stride);
}

static inline void occ_soup_corners(const occ_soup *soup, uint32_t triangle, const float *corner[3])
{
    for (int c = 0; c < 3; c++)
        corner[c] = occ_soup_vertex(soup, occ_soup_index(soup, triangle, c));
}

// Whether a triangle has no area, exactly.
bool occ_triangle_is_degenerate(const float *const corner[3]);

#endif
