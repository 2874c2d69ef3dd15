// SPDX-License-Identifier: Apache-2.0
// Where a group of things is cut in two.
#ifndef OCC_SOUP_CLUSTER_H
#define OCC_SOUP_CLUSTER_H

#include <stdint.h>

// What is never cut: a triangle, or several that stay together.
typedef struct occ_cluster_unit {
    float min[3], max[3];
    uint32_t first, weight; // its triangles are listed at [first, first + weight)
    uint32_t label;
} occ_cluster_unit;

// A unit, and its middle along the axis that is being sorted by.
typedef struct occ_cluster_key {
    float middle;
    uint32_t unit;
} occ_cluster_key;

typedef struct occ_cluster_cutter {
    const occ_cluster_unit *units;
    occ_cluster_key *keys; // one for each unit, in the order of the groups
    double *cost_from;     // of all units from one on, as long
    double overhead;       // what a cluster costs beside its triangles, in triangles
    double rim;            // by how much boxes are taken to be larger than they are
    uint32_t most;         // triangles in a cluster
} occ_cluster_cutter;

// Cuts the group of keys [first, end), which are put in order for that. Returns where its second
// half begins, or `first` if the group is to stay whole. No half of a group of more than
// OCC_CLUSTER_MARGIN * OCC_CLUSTER_MARGIN units has less than a part in OCC_CLUSTER_MARGIN of it.
#define OCC_CLUSTER_MARGIN 32u
uint32_t occ_cluster_cut(const occ_cluster_cutter *cutter, uint32_t first, uint32_t end);

#endif
