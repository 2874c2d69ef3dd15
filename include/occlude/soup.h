// SPDX-License-Identifier: Apache-2.0
/// @file
/// From triangles to boxes: bounds that hold a model, and the proof that they do.
///
/// **Soup.** Triangles in any order, watertight or not, with any winding. Only vertices that a
/// triangle names are read, so that a part of a larger vertex buffer is a soup too.
///
/// **Exact.** What is said of boxes and triangles here is true of the real numbers that the floats
/// stand for: a box is center ± axis[0] ± axis[1] ± axis[2] without rounding.
///
/// **Bad input** is a named error: a NaN or an infinity (OCC_ERROR_NOT_FINITE), a coordinate beyond
/// OCC_MAX_COORDINATE (OCC_ERROR_OUT_OF_RANGE), an index that names no vertex or an empty soup
/// (OCC_ERROR_INVALID_ARGUMENT). Triangles without area and triangles given twice are no error;
/// occ_soup_check() counts them.
///
/// **Threads.** Any number of calls may run at once; there is no state. The same input gives the
/// same bits everywhere.
#ifndef OCCLUDE_SOUP_H
#define OCCLUDE_SOUP_H

#include "scene.h"

/// Triangles. The arrays stay the caller's and are read during the call alone.
typedef struct occ_soup {
    const float *positions;  ///< Three floats for each vertex, in world units.
    uint32_t vertex_count;   ///< Vertices in `positions`.
    uint32_t stride;         ///< Bytes from one vertex to the next, a multiple of 4. 0: 12.
    const uint32_t *indices; ///< Three for each triangle. NULL: 0, 1, 2, and so on.
    uint32_t triangle_count; ///< Triangles; at least one.
} occ_soup;

/// How a call of this header works. All zero, or NULL in its place, is a good default.
typedef struct occ_soup_work {
    occ_allocator allocator; ///< Default: the C library.
    occ_logger logger;       ///< Default: silent.
    /// Called now and then in the caller's thread, with how much is done, from 0 to 1. Returning
    /// false stops the work, which then gives OCC_ERROR_CANCELLED. Default NULL: never stopped.
    bool (*progress)(float done, void *user_data);
    void *user_data; ///< Handed to `progress`.
} occ_soup_work;

/// What a soup holds.
typedef struct occ_soup_counts {
    uint32_t triangles;  ///< Triangles that count: triangle_count less the next two.
    uint32_t degenerate; ///< Triangles without area: two corners alike, or all three in line.
    uint32_t duplicate;  ///< Others whose corners are those of an earlier one, in any order.
    uint32_t vertices;   ///< Vertices that a triangle names.
} occ_soup_counts;

/// OCC_SUCCESS if the soup can be worked with, else what is wrong with it; the log line names the
/// first triangle and vertex. `counts` may be NULL: then nothing is counted and no memory used.
OCC_API OCC_NODISCARD occ_result occ_soup_check(const occ_soup *soup, const occ_soup_work *work,
                                                occ_soup_counts *counts);

/// A small oriented box that holds every one of `count` points (at least one), each three floats at
/// `points` plus a multiple of `stride` bytes (0: 12, else a multiple of 4). Its axes are at right
/// angles but for their rounding to floats. It is turned where that makes it smaller by a
/// thousandth at least; else it is what occ_box_from_points() gives. OCC_ERROR_OUT_OF_RANGE if a
/// coordinate of the box would be beyond OCC_MAX_COORDINATE. Needs no memory.
OCC_API OCC_NODISCARD occ_result occ_bounds_of_points(const float *points, size_t count,
                                                      size_t stride, const occ_soup_work *work,
                                                      occ_box *box);

/// The same of every vertex that a triangle of the soup names.
OCC_API OCC_NODISCARD occ_result occ_bounds_of_soup(const occ_soup *soup, const occ_soup_work *work,
                                                    occ_box *box);

/// Whether every vertex that a triangle names is inside the box or in its surface, exactly:
/// OCC_SUCCESS; or OCC_ERROR_NOT_INSIDE, with `*vertex` the first one outside in the order of the
/// triangles. `vertex` may be NULL.
OCC_API OCC_NODISCARD occ_result occ_verify_bounds(const occ_soup *soup, const occ_box *box,
                                                   const occ_soup_work *work, uint32_t *vertex);

#endif
