// SPDX-License-Identifier: Apache-2.0
/// @file
/// Objects from triangles: a soup split into compact clusters, each with its bounds.
///
/// A level or a scan that comes as one soup, or sorted by material, is culled as a whole or not at
/// all. Clusters are what an engine should draw by one call each: triangles that lie together.
///
/// Works on the soups of soup.h and fails as its calls do.
#ifndef OCCLUDE_CLUSTERS_H
#define OCCLUDE_CLUSTERS_H

#include "soup.h"

/// In `groups`: a triangle that may go anywhere.
#define OCC_NO_GROUP UINT32_MAX

/// How a soup is split. All zero, or NULL in its place, is a good default.
typedef struct occ_clusters_desc {
    occ_soup_work work; ///< Allocator, logger, progress.
    /// Most triangles in a cluster. Fewer cull better and cost more draw calls. Default 0: 32.
    uint32_t max_triangles;
    /// A number for each triangle, such as its material or mesh: no cluster has triangles of two
    /// numbers. Default NULL: all may be mixed.
    const uint32_t *labels;
    /// A number for each triangle, or OCC_NO_GROUP: triangles of one number stay together, even
    /// where they are more than `max_triangles`; they must have one label. Default NULL: no groups.
    const uint32_t *groups;
} occ_clusters_desc;

/// Splits a soup. Every triangle is in exactly one cluster: cluster i has the triangles
/// order[first[i]] up to, and not including, order[first[i + 1]], ascending. Of different labels
/// the least comes first. `order` has room for soup->triangle_count numbers and `first` for one
/// more than that; on an error they hold anything. The same soup and desc give the same clusters.
OCC_API OCC_NODISCARD occ_result occ_clusters_find(const occ_soup *soup,
                                                   const occ_clusters_desc *desc, uint32_t *order,
                                                   uint32_t *first, uint32_t *count);

/// The bounds of each of `count` clusters, at least one, as occ_clusters_find() gave them or split
/// otherwise: what occ_bounds_of_soup() gives for its triangles. On an error `boxes` holds
/// anything.
OCC_API OCC_NODISCARD occ_result occ_clusters_bounds(const occ_soup *soup, const uint32_t *order,
                                                     const uint32_t *first, uint32_t count,
                                                     const occ_soup_work *work, occ_box *boxes);

#endif
