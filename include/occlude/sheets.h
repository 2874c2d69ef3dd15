// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sheets: occluders from triangles, proven to lie in their surface.
///
/// **What is proven.** Let an eye and a point be such that a sheet hides the point: it is strictly
/// beyond all of the sheet's corners and strictly within its outline, as seen by the eye. Then the
/// way from the eye to the point passes through a triangle of the soup before it reaches the point
/// and, if sheets are one-sided, through one that turns its front to the eye. That holds in exact
/// arithmetic, also for corners that are in no common plane.
///
/// **Opaque.** Every triangle counts as opaque, unless it is marked in `see_through`.
///
/// Works on the soups of soup.h and fails as its calls do.
#ifndef OCCLUDE_SHEETS_H
#define OCCLUDE_SHEETS_H

#include "soup.h"

/// The label of a sheet that stands for triangles of different labels.
#define OCC_NO_LABEL UINT32_MAX

/// How sheets are looked for. All zero, or NULL in its place, is a good default.
typedef struct occ_sheets_desc {
    occ_soup_work work; ///< Allocator, logger, progress.
    /// From where the triangles are drawn. Default OCC_SIDES_BOTH: from both sides, whatever their
    /// winding. OCC_SIDES_FRONT: from where their corners go counterclockwise; then the sheets hide
    /// from there only.
    occ_sides sides;
    float min_area;          ///< Smaller sheets are left out, in square units. Default 0: none is.
    bool labels_apart;       ///< No sheet stands for triangles of different labels. Default: any.
    const uint32_t *labels;  ///< One for each triangle, below OCC_NO_LABEL. NULL: all are 0.
    const bool *see_through; ///< One for each triangle: it hides nothing. NULL: none of them.
} occ_sheets_desc;

/// A sheet that was found.
typedef struct occ_found_sheet {
    occ_sheet sheet;         ///< May be handed to the scene as it is.
    float area;              ///< In square units.
    float gain;              ///< The part of it that the sheets before it do not cover.
    uint32_t triangle;       ///< The first triangle that it stands for.
    uint32_t triangle_count; ///< How many these are.
    uint32_t label;          ///< Theirs, if it is one and the same, else OCC_NO_LABEL.
} occ_found_sheet;

/// How a search went.
typedef struct occ_sheets_stats {
    occ_soup_counts counts; ///< As occ_soup_check() gives them.
    uint32_t see_through;   ///< Triangles that were left out as such.
    uint32_t planes;        ///< Pieces of the surface whose triangles hang together in one plane.
    uint32_t found;         ///< Sheets that were found, written or not.
    double area;            ///< Of all triangles that count and are opaque.
    double covered;         ///< What the sheets that were found cover of it.
    uint64_t peak_bytes;    ///< The most memory that was allocated at any time.
} occ_sheets_stats;

/// Looks for sheets and writes the first `capacity` of them to `sheets`, `*count` of them: those of
/// more gain first. So any first few are a choice too. Sheets may overlap, which is what lets
/// culling fuse them without a seam. All have passed the check of occ_verify_sheets(). The same
/// soup and desc give the same sheets. `stats` may be NULL.
OCC_API OCC_NODISCARD occ_result occ_sheets_find(const occ_soup *soup, const occ_sheets_desc *desc,
                                                 occ_found_sheet *sheets, size_t capacity,
                                                 size_t *count, occ_sheets_stats *stats);

/// Why a sheet is none.
typedef enum occ_sheet_reason {
    OCC_SHEET_SOUND = 0,   ///< It is one.
    OCC_SHEET_MISMADE = 1, ///< It has too few corners or too many, or its sides are not the desc's.
    OCC_SHEET_FLAT = 2,    ///< All its corners are in line.
    OCC_SHEET_BENT = 3,    ///< It is in one plane, but not convex.
    OCC_SHEET_OPEN = 4     ///< No opaque triangles are proven to be all over it.
} occ_sheet_reason;

/// The first of several sheets that is none.
typedef struct occ_sheet_fault {
    occ_sheet_reason reason;
    uint32_t sheet;    ///< Its place in `sheets`.
    uint32_t triangle; ///< OCC_SHEET_OPEN: one beside which the surface ends within it, if known.
                       ///< Else UINT32_MAX.
} occ_sheet_fault;

/// Checks sheets anew, as found by occ_sheets_find() or made otherwise: OCC_SUCCESS if each is
/// proven to lie in the surface, OCC_ERROR_NOT_INSIDE if not. Of a found sheet it reads `sheet`
/// alone, of the desc `work`, `sides`, `see_through` and, with `labels_apart`, `labels`. `fault`
/// may be NULL.
OCC_API OCC_NODISCARD occ_result occ_verify_sheets(const occ_soup *soup,
                                                   const occ_found_sheet *sheets, size_t count,
                                                   const occ_sheets_desc *desc,
                                                   occ_sheet_fault *fault);

#endif
