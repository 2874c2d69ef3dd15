// SPDX-License-Identifier: Apache-2.0
// What a search for inner boxes holds. Its steps:
//
//     soup -> mesh -> closed parts of the surface
//                  -> parts -> grids -> solid cells -> candidates -> greedy choice, grown -> boxes
#ifndef OCC_SOUP_SEARCH_H
#define OCC_SOUP_SEARCH_H

#include "soup/closed.h"
#include "soup/cuboids.h"
#include "soup/parts.h"
#include "soup/silhouette.h"
#include "soup/triangles.h"

// Which points are in free space, and what that says of others. Also for verification.
typedef struct occ_free_space {
    const occ_closed *closed;
    occ_mark *marks; // of the points that the desc names
    uint32_t count;
    occ_facing facing;
    float max_hole;
    bool outside_solid;
} occ_free_space;

occ_result occ_free_space_make(occ_hooks *hooks, const occ_closed *closed,
                               const occ_inner_desc *desc, occ_free_space *space);

void occ_free_space_free(occ_hooks *hooks, occ_free_space *space);

// Whether a point with this mark is apart from all points of free space, the outside included, and
// on the back of the surface if facing is to count. `point`, which may be NULL, becomes a point
// that it is not apart from, or UINT32_MAX.
bool occ_is_closed_off(const occ_free_space *space, const occ_mark *mark, uint32_t *point);

// Whether a point that a flood left dry counts as solid, for want of something better.
bool occ_is_dry_enough(const occ_free_space *space, const occ_mark *mark, float hole);

// What gets grids of its own: a part, or a cluster of closed patches within one that is small in
// it.
typedef struct occ_site {
    occ_triangles own;  // it lies around these
    occ_triangles near; // all of the part that come near it, these included
    occ_triangles part; // all of the part
    uint32_t *list;     // own and near, if they are not the part's; `room` long
    uint32_t room;
    uint32_t pictures;         // the site of the part
    occ_silhouette silhouette; // of a part
    uint32_t most_cells;
    bool has_closed; // some of its surface is
} occ_site;

static inline occ_silhouette *occ_site_pictures(occ_site *sites, uint32_t site)
{
    return &sites[sites[site].pictures].silhouette;
}

// A grid that was laid over a site.
typedef struct occ_laid_grid {
    occ_inner_grid grid;
    uint32_t site;
} occ_laid_grid;

typedef struct occ_candidate {
    occ_cuboid cells;
    uint32_t laid; // which grid
    occ_box box;   // the cells, in world units
    double gain;   // when last looked at
} occ_candidate;

typedef struct occ_search {
    occ_hooks *hooks;
    const occ_inner_desc *desc;
    occ_mesh mesh;
    occ_parts parts;
    occ_closed closed;
    occ_free_space space;
    occ_array sites;      // occ_site
    occ_array laid;       // occ_laid_grid
    occ_array candidates; // occ_candidate
    occ_inner_stats stats;
} occ_search;

// Chooses the parts and clusters to look at, and draws the parts' silhouettes.
occ_result occ_search_sites(occ_search *search, occ_team *team);

// Lays grids over the sites and gathers candidates.
occ_result occ_search_candidates(occ_search *search, occ_team *team);

// Chooses and grows up to `capacity` of them.
occ_result occ_search_choose(occ_search *search, occ_inner_box *boxes, size_t capacity,
                             size_t *count);

#endif
