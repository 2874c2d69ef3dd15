// SPDX-License-Identifier: Apache-2.0
// Random triangle soups of many shapes, nasty ones among them.
#ifndef OCC_TEST_SOUPS_H
#define OCC_TEST_SOUPS_H

#include "kit.h"

enum { SOUPS_MOST_VERTICES = 400, SOUPS_MOST_TRIANGLES = 400 };

typedef struct soups_soup {
    float position[SOUPS_MOST_VERTICES][3];
    uint32_t index[3 * SOUPS_MOST_TRIANGLES];
    uint32_t vertices, triangles;
} soups_soup;

// A shape in no particular place: points of so many vertices, and what they are called.
typedef struct soups_shape {
    const char *name;
    void (*make)(kit_random *random, double at[][3], uint32_t count);
    bool solid; // its points are in no plane
} soups_shape;

extern const soups_shape soups_shapes[];
extern const uint32_t soups_shape_count;

// Fills the soup with a shape that is turned, stretched, scaled and moved at random, gently or to
// where floats end, and with triangles between its vertices; some have no area, some come twice.
void soups_make(kit_random *random, const soups_shape *shape, uint32_t vertices, bool gently,
                soups_soup *soup);

static inline occ_soup soups_view(const soups_soup *soup)
{
    return (occ_soup){soup->position[0], soup->vertices, 0, soup->index, soup->triangles};
}

#endif
