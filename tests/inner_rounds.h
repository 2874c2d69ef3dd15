// SPDX-License-Identifier: Apache-2.0
// Inner boxes of random soups, judged with GMP.
#ifndef OCC_TEST_INNER_ROUNDS_H
#define OCC_TEST_INNER_ROUNDS_H

#include "kit.h"
#include "shapes.h"

typedef struct rounds_report {
    uint32_t soups, boxes, turned, barren; // barren: soups without a box
} rounds_report;

// Makes soups of solids that are whole or lack triangles, that overlap, touch or lie in each other,
// with triangles between that have no volume, no area, or are there twice; and demands of every box
// found in them that no triangle enters it and that a whole solid is around it.
void rounds_run(uint64_t seed, uint32_t soups, rounds_report *report);

#endif
