// SPDX-License-Identifier: Apache-2.0
// The surface in pieces of one plane each, and where these end.
//
// A piece ("plane") is a set of triangles in one plane, exactly, that hang together over edges
// with one of them on either side. What bounds it are the edges, cut where a vertex lies on them,
// that have more of its triangles on one side than on the other. Let w be the number of the piece's
// triangles at a point: w changes nowhere but there. So a convex polygon in the plane whose
// interior meets no such edge, and does meet a triangle, is covered by them all over.
#ifndef OCC_SHEET_SURFACE_H
#define OCC_SHEET_SURFACE_H

#include "soup/edges.h"

#include <occlude/sheets.h>

// An edge that bounds: vertices, with more triangles to the left as seen from the front.
typedef struct occ_sheet_rim {
    uint32_t from, to;
    uint32_t triangle; // one of those
} occ_sheet_rim;

// Triangles [first, first + count) of the list, and rims likewise. The plane is seen along the axes
// u and v of space, which keeps its points apart; its front, where the corners of its first
// triangle go counterclockwise, is where u and v do.
typedef struct occ_sheet_plane {
    uint32_t first, count;
    uint32_t first_rim, rims;
    uint8_t u, v, drop;
} occ_sheet_plane;

typedef struct occ_surface {
    occ_mesh mesh; // opaque triangles only
    occ_edges edges;
    uint32_t *plane_of;   // for each triangle, or OCC_NO_PLANE
    uint32_t *triangle;   // by plane
    occ_array planes;     // occ_sheet_plane
    occ_array rims;       // occ_sheet_rim
    uint32_t see_through; // triangles that were left out
} occ_surface;

#define OCC_NO_PLANE UINT32_MAX // of triangles without area

// `soup` and `desc` have been checked.
occ_result occ_surface_build(occ_hooks *hooks, const occ_soup *soup, const occ_sheets_desc *desc,
                             occ_surface *surface);

void occ_surface_free(occ_hooks *hooks, occ_surface *surface);

static inline void occ_sheet_flatten(const occ_sheet_plane *plane, const float p[3], float out[2])
{
    out[0] = p[plane->u];
    out[1] = p[plane->v];
}

#endif
