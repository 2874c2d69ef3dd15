// SPDX-License-Identifier: Apache-2.0
// Closed parts of a surface, and which of them lie around a point: enclosure without tolerance.
//
// A set of triangles is closed if it has an even number of triangles at every edge. Whoever goes
// from a point to another and touches none of a closed set crosses it an even number of times, and
// so does every other way between the two that meets no edge of it: a straight line that crosses
// it an odd number of times proves that the points are apart.
//
//   open triangles   those that can be in no closed set: alone at an edge, or left alone by such
//   patch            the others, joined over edges that two of them have: a closed set holds all
//                    of a patch or nothing
//   rule             an edge with more of them: a closed set holds an even number of the patches
//                    that meet there. Rules are rows of bits, one per patch of their cluster.
//
// A line's crossings make one bit per patch, odd or even. Some closed set is crossed an odd number
// of times exactly if that row of bits is not a sum of rules (both are what elementary linear
// algebra over two elements says). So what remains of the row when the rules, in echelon form, are
// taken out of it, is a mark of where a line to infinity starts: points with different marks are
// apart, and a mark with bits in it is not outside.
#ifndef OCC_SOUP_CLOSED_H
#define OCC_SOUP_CLOSED_H

#include "soup/mesh.h"

#define OCC_OPEN         UINT32_MAX
#define OCC_MOST_PATCHES 2048u // of a cluster; a larger one counts as open
#define OCC_PATCH_WORDS  (OCC_MOST_PATCHES / 64u)

// Patches [first, first + count) that rules connect.
typedef struct occ_cluster {
    uint32_t first, count;
    uint32_t words; // 64 patches each, in a rule
    size_t rules;   // where in occ_closed.rules the first of its rows begins
    uint32_t rule_count;
} occ_cluster;

typedef struct occ_closed {
    const occ_mesh *mesh;
    uint32_t *patch; // of each triangle, or OCC_OPEN
    uint32_t patches, open_triangles;
    uint32_t *cluster_of; // for each patch
    size_t cluster_room;
    occ_array clusters; // occ_cluster
    occ_array rules;    // uint64_t; the rows of a cluster ascend by their lowest bit
} occ_closed;

occ_result occ_closed_build(occ_hooks *hooks, const occ_mesh *mesh, occ_closed *closed);

void occ_closed_free(occ_hooks *hooks, occ_closed *closed);

// Brings the rules of one cluster into echelon form: rows of `words` words, `*count` of them, any
// of which may be sums of others. `*count` becomes how many are left.
void occ_reduce_rules(uint64_t *rows, uint32_t *count, uint32_t words);

// Takes the rules out of a row.
void occ_take_out_rules(const uint64_t *rows, uint32_t count, uint32_t words, uint64_t *row);

// Where a point is. Equal marks: perhaps in one region. Different ones: apart.
typedef struct occ_mark {
    occ_array bits; // uint32_t: patches, ascending
    // How often a line from the point leaves by the back of a triangle, less by its front: of what
    // is in closed sets, and of all triangles.
    int32_t winding, all_winding;
    bool known; // false: the point is on a triangle, or every line met an edge
} occ_mark;

#define OCC_MARK ((occ_mark){.bits = OCC_ARRAY(uint32_t)})

// Marks a point by the triangles in a list (NULL: the first `count` of the mesh), which must hold
// all that a line from the point may cross an odd number of times. Fails for want of memory only.
occ_result occ_mark_point(occ_hooks *hooks, const occ_closed *closed, const uint32_t *triangles,
                          uint32_t count, const float point[3], occ_mark *mark);

bool occ_marks_differ(const occ_mark *a, const occ_mark *b);

void occ_mark_free(occ_hooks *hooks, occ_mark *mark);

#endif
