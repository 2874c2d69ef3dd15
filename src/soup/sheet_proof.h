// SPDX-License-Identifier: Apache-2.0
// The two proofs that a sheet lies in a surface; either will do. Neither rounds.
//
//   in a plane   the corners are in the plane of a piece and go around a convex polygon; no edge
//                that bounds the piece has a point in the polygon's interior, and a triangle has
//   by corners   the outline can be filled with triangles of the soup that have all their corners
//                on the sheet's: their sum then has the outline as its boundary, in a plane or not
#ifndef OCC_SHEET_PROOF_H
#define OCC_SHEET_PROOF_H

#include "soup/sheet_surface.h"

// What a proven sheet stands for.
typedef struct occ_sheet_basis {
    uint32_t triangle, count; // the first one in the soup, and how many
    uint32_t label;
    uint64_t work; // steps that its proof in a plane took, or the attempt
} occ_sheet_basis;

// Whether a sheet can be one at all: its corner count, numbers, corners that follow each other at
// one place, and its sides.
occ_sheet_reason occ_sheet_shape(const occ_sheet *sheet, occ_sides sides);

// Proves a well-shaped sheet in a plane. If that fails, `*beside` may become a triangle of the soup
// that bounds the piece within the sheet.
occ_sheet_reason occ_prove_in_plane(const occ_surface *surface, const occ_sheets_desc *desc,
                                    const occ_sheet_plane *plane, const occ_sheet *sheet,
                                    occ_sheet_basis *basis, uint32_t *beside);

// Where a position's vertex is, and the triangles at a vertex.
typedef struct occ_corner_index {
    uint32_t *slot; // vertices, open addressing
    size_t slots;
    uint32_t *first, *at; // triangles of vertex v: at[first[v]] up to at[first[v + 1]]
} occ_corner_index;

occ_result occ_corner_index_build(occ_hooks *hooks, const occ_mesh *mesh, occ_corner_index *index);
void occ_corner_index_free(occ_hooks *hooks, const occ_mesh *mesh, occ_corner_index *index);

// Proves a well-shaped sheet by its corners.
bool occ_prove_by_corners(const occ_surface *surface, const occ_sheets_desc *desc,
                          const occ_corner_index *index, const occ_sheet *sheet,
                          occ_sheet_basis *basis);

#endif
