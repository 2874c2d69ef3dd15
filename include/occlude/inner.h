// SPDX-License-Identifier: Apache-2.0
/// @file
/// Inner boxes: occluders from triangles, proven to lie in solid space.
///
/// **Solid** is what nobody can get to, or look into, without passing through a triangle. By
/// default that is proven without any tolerance: a box counts only if a part of the surface that is
/// closed to the last bit of its coordinates lies around it, and no triangle enters the box. An
/// open mesh gives few boxes or none. Where small holes are known to be harmless, `max_hole` allows
/// them; a box then is where no ball of that width can be moved to.
///
/// **Rooms.** A level is often modelled from within, and nobody can get into its rooms from outside
/// either. Name points in them (`free_points`: where the eye may be), or let the winding tell
/// (`facing`), or boxes will fill the rooms. And if the eye never leaves the rooms, all that is
/// beyond their walls may be solid (`outside_solid`).
///
/// Works on the soups of soup.h and fails as its calls do.
#ifndef OCCLUDE_INNER_H
#define OCCLUDE_INNER_H

#include "soup.h"

/// What tells solid space from a room, where both are closed.
typedef enum occ_facing {
    OCC_FACING_ANY = 0, ///< Nothing does: closed is solid, unless it holds one of `free_points`.
    OCC_FACING_OUT = 1  ///< Triangles wind counterclockwise seen from free space.
} occ_facing;

/// How inner boxes are looked for. All zero, or NULL in its place, is a good default.
typedef struct occ_inner_desc {
    occ_soup_work work; ///< Allocator, logger, progress.
    uint32_t max_cells; ///< Most cells of a grid, 4096 to 2^28; each takes 5 bytes, and there is
                        ///< one grid at a time. Default 0: 2^22.
    uint32_t threads;   ///< OpenMP threads, 1024 at most. Default 0: what OpenMP offers.
    float coverage;     ///< Enough, as a share of the silhouette, from 0 to 1. Default 0: all.
    float max_hole;     ///< Openings up to this width, in world units, count as closed. Default 0:
                        ///< none does.
    occ_facing facing;  ///< Default: the winding says nothing.
    bool aligned_only;  ///< Boxes along the axes alone. Default: turned ones where they gain more.
    /// The eye is in rooms that `free_points` lead to, and so is whatever is to be seen; beyond
    /// their walls all is solid, the outside too. Boxes are then chosen by what they cover of each
    /// of eight layers of the model, not of its silhouette. Default: the outside is free.
    bool outside_solid;
    const float *free_points; ///< Three floats each: points of free space. May be NULL.
    uint32_t free_count;      ///< How many.
} occ_inner_desc;

/// A grid of cells as it was laid over a part of the soup. The cell (i, j, k) is all points p for
/// which, with n being i, j, k in turn and without rounding, (origin + n) * cell <= axis . p <=
/// (origin + n + 1) * cell, all three read at [0], [1], [2] in turn.
typedef struct occ_inner_grid {
    float axis[3][3];  ///< Nearly unit vectors at right angles.
    float cell[3];     ///< Edges of a cell.
    int32_t origin[3]; ///< Of cell (0, 0, 0), in cells.
    uint32_t size[3];  ///< Cells; the outermost are beyond the part.
    uint32_t closing;  ///< By how many cells the surface was thickened before the flood.
    float hole;        ///< No ball of this width gets from outside to what the flood left dry.
} occ_inner_grid;

/// An inner box, and what it is worth.
typedef struct occ_inner_box {
    occ_box box;         ///< May be handed to occ_scene_add_occluder() as it is.
    float gain;          ///< The share of the silhouette that the boxes before it left open.
    bool closed;         ///< Proven without tolerance; else up to holes of the width grid.hole.
    occ_inner_grid grid; ///< Where it was found.
} occ_inner_box;

/// How a search went.
typedef struct occ_inner_stats {
    occ_soup_counts counts;  ///< As occ_soup_check() gives them.
    uint32_t open_triangles; ///< Triangles that are in no closed part of the surface.
    uint32_t parts;          ///< Parts of the soup whose bounds do not meet.
    uint32_t parts_left_out; ///< Of these, small ones that were not looked at.
    uint32_t grids;          ///< Grids that were laid.
    uint64_t cells;          ///< Cells of all of them.
    uint64_t solid_cells;    ///< Of these, cells in which a box may lie.
    uint32_t candidates;     ///< Boxes that were chosen from.
    float silhouette;        ///< Area of the model's silhouette, mean over the directions; with
                             ///< `outside_solid`, of those of its layers in sum.
    float coverage;          ///< The share of it that the boxes cover.
    uint64_t peak_bytes;     ///< The most memory that was allocated at any time.
} occ_inner_stats;

/// Looks for up to `capacity` boxes and writes them to `boxes`, `*count` of them, in the order of
/// choice: each is the one that, before it is grown, adds most to the covered silhouette, as a mean
/// over 13 directions from all around. So any first few are a choice too, and `gain` is the curve
/// by which to cut. The same soup and desc give the same boxes, whatever `threads`. `stats` may be
/// NULL.
OCC_API OCC_NODISCARD occ_result occ_inner_find(const occ_soup *soup, const occ_inner_desc *desc,
                                                occ_inner_box *boxes, size_t capacity,
                                                size_t *count, occ_inner_stats *stats);

/// Why a box is no inner box.
typedef enum occ_inner_reason {
    OCC_INNER_SOUND = 0,   ///< It is one.
    OCC_INNER_FLAT = 1,    ///< It has no volume.
    OCC_INNER_ENTERED = 2, ///< A triangle has a point in its open interior.
    OCC_INNER_OPEN = 3,    ///< It is not proven to lie in solid space.
    OCC_INNER_ROOM = 4     ///< A point of `free_points` is on the same side of all closed parts.
} occ_inner_reason;

/// The first box of several that is no inner box.
typedef struct occ_inner_fault {
    occ_inner_reason reason;
    uint32_t box;      ///< Its place in `boxes`.
    uint32_t triangle; ///< OCC_INNER_ENTERED: the first that enters it. Else UINT32_MAX.
    uint32_t point;    ///< OCC_INNER_ROOM: the point of `free_points`. Else UINT32_MAX.
} occ_inner_fault;

/// Checks boxes anew, as found by occ_inner_find() or made otherwise: OCC_SUCCESS if each is an
/// inner box, OCC_ERROR_NOT_INSIDE if not. Of the desc it reads `work`, `threads`, `max_hole`,
/// `facing` and `free_points`. That no triangle enters a box is decided in exact arithmetic, and so
/// is that closed parts of the surface lie around it. With `max_hole`, a box that is not closed off
/// so must be dry in its own grid, which is laid and flooded again. `fault` may be NULL.
OCC_API OCC_NODISCARD occ_result occ_verify_inner(const occ_soup *soup, const occ_inner_box *boxes,
                                                  size_t count, const occ_inner_desc *desc,
                                                  occ_inner_fault *fault);

#endif
