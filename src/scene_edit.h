// SPDX-License-Identifier: Apache-2.0
// What the edits of objects and of occluders share.
#ifndef OCC_SCENE_EDIT_H
#define OCC_SCENE_EDIT_H

#include "scene_data.h"

// Most objects, or occluders, of a scene.
#define OCC_MOST_ITEMS (UINT32_MAX - 2u * OCC_BOX_LANES)

// Each logs why an edit is refused, and returns the result for the caller to return.
occ_result occ_scene_missing(const occ_scene *scene, const char *what);
occ_result occ_scene_stale(const occ_scene *scene, const char *what, uint32_t index,
                           uint32_t generation);

// Checks `count` boxes and names the first bad one.
occ_result occ_scene_check_boxes(const occ_scene *scene, const occ_box *boxes, size_t count,
                                 const char *what);

// Whether two boxes have one key, so that the tree's order does not change.
bool occ_same_key(const occ_octree *tree, const occ_box *a, const occ_box *b);

// Room for `more` occluders, and for `sheets` among all that there are.
occ_result occ_scene_reserve_occluders(occ_scene *scene, size_t more, bool sheets);

#endif
