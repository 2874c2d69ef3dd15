// SPDX-License-Identifier: Apache-2.0
// Sheets of random soups, judged with GMP.
#ifndef OCC_TEST_SHEET_ROUNDS_H
#define OCC_TEST_SHEET_ROUNDS_H

#include "kit.h"

typedef struct sheet_report {
    uint32_t soups, sheets;
    uint32_t merged; // sheets of more than one triangle
    uint32_t bent;   // of these, with corners that are in no common plane
    uint32_t forged; // sheets that were tampered with
    uint32_t passed; // of these, found to be sound all the same
    uint64_t sights; // lines of sight that a sheet blocks, each seen to meet a triangle
} sheet_report;

// Makes soups of walls with openings, T-junctions, copies, flipped and missing triangles, turned or
// sheared or bent, and of triangles between a few points. Of every sheet found in them, and of
// every one made up that verification lets pass, it draws lines of sight that the sheet blocks, and
// demands that an opaque triangle blocks each: in rational numbers.
void sheet_rounds_run(uint64_t seed, uint32_t soups, sheet_report *report);

#endif
