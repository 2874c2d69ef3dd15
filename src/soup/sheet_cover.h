// SPDX-License-Identifier: Apache-2.0
// What of a plane's triangles no sheet covers yet, as convex polygons. It decides which sheets are
// made and kept, not whether they are true, and is in doubles.
#ifndef OCC_SHEET_COVER_H
#define OCC_SHEET_COVER_H

#include "soup/sheet_surface.h"

#define OCC_REGION_CORNERS 24

// A convex polygon in a plane as it is seen, counterclockwise.
typedef struct occ_region {
    double at[OCC_REGION_CORNERS][2];
    uint32_t count;
} occ_region;

double occ_region_area(const occ_region *region);

// Keeps what is to the left of the line from a to b.
void occ_region_cut(occ_region *region, const double a[2], const double b[2]);

typedef struct occ_cover {
    occ_hooks *hooks;
    const occ_surface *surface;
    const bool *used; // triangles that count as covered from the start
    const occ_sheet_plane *plane;
    occ_array whole;  // uint32_t: triangles of which nothing is covered
    occ_array pieces; // of others
    double floor;     // of the area of a piece; smaller ones are let go
    double area;      // of all triangles
    uint64_t work;    // triangles and pieces that were looked at
    uint32_t largest; // where it is: in `whole`, and in `pieces` after these
} occ_cover;

// A part of a triangle.
typedef struct occ_cover_piece {
    occ_region region;
    uint32_t triangle;
    double area;
} occ_cover_piece;

void occ_cover_init(occ_cover *cover, occ_hooks *hooks, const occ_surface *surface,
                    const bool *used);

// Nothing else of the plane is covered.
occ_result occ_cover_start(occ_cover *cover, const occ_sheet_plane *plane);

// The largest piece, or false if none is left.
bool occ_cover_largest(occ_cover *cover, occ_cover_piece *piece);

// Lets the largest piece go, as it was found last.
void occ_cover_drop(occ_cover *cover);

// How much area within a region is not covered; with `take` it is from now on. If that fails for
// want of memory, `*result` says so.
double occ_cover_gain(occ_cover *cover, const occ_region *region, bool take, occ_result *result);

void occ_cover_free(occ_cover *cover);

#endif
