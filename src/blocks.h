// SPDX-License-Identifier: Apache-2.0
// Arithmetic on a block of boxes at a time: bounds, keys and reaches. blocks.c is compiled once for
// each instruction set; all variants give the same bits.
#ifndef OCC_BLOCKS_H
#define OCC_BLOCKS_H

#include <stdint.h>

#define OCC_BLOCK       256u // boxes in a block: what is made of them stays in the nearest cache
#define OCC_BOX_COLUMNS 12u

#define OCC_TREE_BITS  19u // levels of cells below the octree's root
#define OCC_LEVEL_BITS 5u  // of a key, the lowest: the level

// The numbers of a block's boxes, a column for each: center x, y, z, axis[0] x, ...
typedef const float *occ_block_columns[OCC_BOX_COLUMNS];

// Their bounds.
typedef struct occ_block {
    float min[3][OCC_BLOCK];
    float max[3][OCC_BLOCK];
} occ_block;

// The cube that the octree's cells halve. Quantised, so that small edits seldom change it.
typedef struct occ_root {
    double origin[3];
    double size; // a power of two; 0 without items
} occ_root;

typedef struct occ_blocks {
    const char *name; // of the instruction set
    // What occ_box_bounds() gives for each box.
    void (*bounds)(occ_block_columns from, uint32_t count, occ_block *block);
    // The items' keys under a root.
    void (*keys)(const occ_root *root, const occ_block *block, uint32_t count, uint64_t *keys);
    // An upper bound on the area that each box shows to any direction.
    void (*reaches)(occ_block_columns from, uint32_t count, float *reaches);
} occ_blocks;

// The best variant for this CPU.
const occ_blocks *occ_blocks_choose(void);

// Variant `index` of those this CPU can run, best first, or NULL.
const occ_blocks *occ_blocks_get(uint32_t index);

#endif
