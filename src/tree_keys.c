// SPDX-License-Identifier: Apache-2.0
#include "tree_keys.h"

#include <math.h>

#define ROOT_STEPS 8.0 // the root's origin is a multiple of its size over this

// --- the root ------------------------------------------------------------------------------------

// How far the middles of items reach.
typedef struct reach {
    double low[3], high[3];
} reach;

static const reach nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void reach_block(reach *to, const occ_block *block, uint32_t count)
{
    reach all = *to;
    for (uint32_t i = 0; i < count; i++)
        for (int j = 0; j < 3; j++) {
            double middle = 0.5 * ((double)block->min[j][i] + (double)block->max[j][i]);
            all.low[j] = middle < all.low[j] ? middle : all.low[j];
            all.high[j] = middle > all.high[j] ? middle : all.high[j];
        }
    *to = all;
}

static void join(reach *a, const reach *b)
{
    for (int j = 0; j < 3; j++) {
        a->low[j] = b->low[j] < a->low[j] ? b->low[j] : a->low[j];
        a->high[j] = b->high[j] > a->high[j] ? b->high[j] : a->high[j];
    }
}

typedef struct root_job {
    const occ_tree_items *items;
    const uint32_t *rows;
    uint32_t count, parts;
    reach reaches[OCC_MOST_PARTS];
} root_job;

static void reach_part(void *context, uint32_t part)
{
    root_job *job = context;
    reach *all = &job->reaches[part];
    occ_block block;
    *all = nothing;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i += OCC_BLOCK) {
        uint32_t count = end - i < OCC_BLOCK ? end - i : OCC_BLOCK;
        const uint32_t *rows = job->rows ? job->rows + i : NULL;
        job->items->bounds(job->items->table, rows, i, count, &block);
        reach_block(all, &block, count);
    }
}

// The smallest cube of its kind that holds all middles.
static occ_root cube_around(const reach *all)
{
    occ_root root;
    double extent = 0.0, far = 0.0;
    for (int j = 0; j < 3; j++) {
        extent = fmax(extent, all->high[j] - all->low[j]);
        far = fmax(far, fmax(fabs(all->low[j]), fabs(all->high[j])));
    }
    // Rounding the origin down can cost one step. Far from zero the cube is kept wide enough for
    // its cells to be told apart in double.
    int exponent;
    double least = fmax(extent * (ROOT_STEPS / (ROOT_STEPS - 1.0)), fmax(far * 0x1p-30, 0x1p-100));
    (void)frexp(least, &exponent);
    root.size = ldexp(1.0, exponent);
    double step = root.size / ROOT_STEPS;
    for (int j = 0; j < 3; j++)
        root.origin[j] = floor(all->low[j] / step) * step;
    return root;
}

occ_root occ_octree_root(const occ_tree_items *items, const uint32_t *rows, uint32_t count,
                         occ_team *team)
{
    if (!count) return (occ_root){{0.0, 0.0, 0.0}, 0.0};
    root_job job = {.items = items, .rows = rows, .count = count, .parts = occ_parts_of(count)};
    occ_do_parts(team, job.parts, reach_part, &job);
    reach all = job.reaches[0];
    for (uint32_t part = 1; part < job.parts; part++)
        join(&all, &job.reaches[part]);
    return cube_around(&all);
}

// --- keys ----------------------------------------------------------------------------------------

uint64_t occ_octree_key(const occ_root *root, const float min[3], const float max[3])
{
    occ_block block;
    uint64_t key;
    for (int j = 0; j < 3; j++) {
        block.min[j][0] = min[j];
        block.max[j][0] = max[j];
    }
    occ_blocks_choose()->keys(root, &block, 1, &key);
    return key;
}

typedef struct keys_job {
    const occ_tree_items *items;
    const occ_root *root;
    uint32_t count, parts;
    uint64_t *keys;
} keys_job;

static void keys_part(void *context, uint32_t part)
{
    const keys_job *job = context;
    const occ_blocks *blocks = occ_blocks_choose();
    occ_block block;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i += OCC_BLOCK) {
        uint32_t count = end - i < OCC_BLOCK ? end - i : OCC_BLOCK;
        job->items->bounds(job->items->table, NULL, i, count, &block);
        blocks->keys(job->root, &block, count, job->keys + i);
    }
}

void occ_octree_keys(const occ_tree_items *items, const occ_root *root, uint32_t count,
                     uint64_t *keys, occ_team *team)
{
    keys_job job = {.items = items, .root = root, .count = count, .parts = occ_parts_of(count)};
    job.keys = keys;
    occ_do_parts(team, job.parts, keys_part, &job);
}
