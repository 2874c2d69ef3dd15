// SPDX-License-Identifier: Apache-2.0
// What must hold of a scene's octrees, worked out from the boxes without the code that builds or
// validates them.
#ifndef OCC_TEST_KIT_TREE_H
#define OCC_TEST_KIT_TREE_H

#include "kit.h"
#include "scene_data.h"

// Fails the test unless both trees of a committed scene, and its tables, are as they must be;
// occ_scene_validate() must agree.
void kit_check_trees(const occ_scene *scene);

// Fails the test unless two trees are the same, node for node and bit for bit.
void kit_check_same_tree(const occ_octree *a, const occ_octree *b);

// Fails the test unless two scenes have the same occluders in the same rows, whatever their slots,
// and know the same about them.
void kit_check_same_occluders(const occ_scene *a, const occ_scene *b);

// Fails the test unless two scenes with the same slots are the same inside, bit for bit.
void kit_check_same_scene(const occ_scene *a, const occ_scene *b);

// The deepest node that holds an object.
const occ_node *kit_node_of(const occ_scene *scene, occ_object object);

#endif
