// SPDX-License-Identifier: Apache-2.0
// A large convex polygon around a seed, within a plane's triangles.
#ifndef OCC_SHEET_GROW_H
#define OCC_SHEET_GROW_H

#include "soup/sheet_cover.h"
#include "soup/sheet_proof.h"

// Which points of a plane are floats.
typedef enum occ_sheet_lattice {
    OCC_LATTICE_ALL,     // it is across an axis: every pair of floats
    OCC_LATTICE_COLUMNS, // it is along an axis: those above and below the vertices
    OCC_LATTICE_VERTICES // it is slanted: the vertices, and others by chance
} occ_sheet_lattice;

// A coordinate of a vertex along u or v, and its coordinate across the view.
typedef struct occ_sheet_place {
    float at, drop;
} occ_sheet_place;

// A plane made ready to grow sheets in.
typedef struct occ_grower {
    occ_hooks *hooks;
    const occ_surface *surface;
    const occ_sheets_desc *desc;
    const occ_sheet_plane *plane;
    occ_sheet_lattice lattice;
    int along;           // with columns: 0 if they are along u, 1 along v
    occ_array vertices;  // uint32_t
    occ_array places[2]; // occ_sheet_place: of the vertices along u and along v
    occ_array spots;     // scratch
    double low[2], high[2], tolerance;
    uint64_t work; // steps that were taken
} occ_grower;

void occ_grower_init(occ_grower *grower, occ_hooks *hooks, const occ_surface *surface,
                     const occ_sheets_desc *desc);

occ_result occ_grower_start(occ_grower *grower, const occ_sheet_plane *plane);

// Grows a sheet around a seed and proves it; `*grown` says whether there is one.
occ_result occ_grower_grow(occ_grower *grower, const occ_region *seed, occ_sheet *sheet,
                           occ_sheet_basis *basis, bool *grown);

void occ_grower_free(occ_grower *grower);

#endif
