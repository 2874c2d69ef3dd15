// SPDX-License-Identifier: Apache-2.0
#include "kit_flat.h"

#include "flat.h"

#include "boxes.h"
#include "knobs.h"
#include "octree.h"
#include "strips.h"

#include <stdlib.h>

enum { GROUP_ROWS = OCC_FLAT_ROWS * OCC_FLAT_BLOCKS };

typedef struct flat_frame {
    const kit_flat *table;
    occ_frame *frame;
    occ_shadow *shadows;
    uint32_t count;
    bool fused;
    uint32_t *mask;
    kit_flat_counts *counts;
} flat_frame;

static const occ_box *row_box(const kit_flat *table, uint32_t row)
{
    return &table->boxes[table->slot_of ? table->slot_of[row] : row];
}

static bool is_object(const occ_box *box)
{
    return occ_flat_is_object(&box->center[0]);
}

// The bounds of rows [first, end).
static occ_relative_box node_of(const flat_frame *f, uint32_t first, uint32_t end)
{
    float least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t row = first; row < end; row++) {
        const occ_box *box = row_box(f->table, row);
        if (!is_object(box)) continue;
        for (int j = 0; j < 3; j++) {
            float low, high;
            occ_flat_extent(box->center[j], box->axis[0][j], box->axis[1][j], box->axis[2][j], &low,
                            &high);
            least[j] = low < least[j] ? low : least[j];
            most[j] = high > most[j] ? high : most[j];
        }
    }
    occ_relative_box node;
    occ_flat_node(&node, least, most, &f->frame->camera.constants);
    return node;
}

static void test_row(flat_frame *f, uint32_t row, uint32_t planes, const uint32_t *list,
                     uint32_t count)
{
    const occ_box *box = row_box(f->table, row);
    const occ_eye *eye = &f->frame->camera.constants;
    if (!is_object(box)) return;
    occ_relative_box relative = occ_frame_relative(f->frame, box);
    uint32_t known =
        occ_flat_object(&relative, eye, planes, f->shadows, list, count, row, f->fused);
    if (known == OCC_UNRESOLVED) {
        f->counts->unresolved++;
        known = occ_box_fused(&relative, eye, planes, f->shadows, list, count, row) ? OCC_HIDDEN
                                                                                    : OCC_VISIBLE;
    } else if (f->fused && known != OCC_OUTSIDE) { // the cheap answers are fusion's
        int hidden = occ_box_fused(&relative, eye, planes, f->shadows, list, count, row);
        KIT_CHECK(hidden == (known == OCC_HIDDEN), "row %u is %u, and by fusion %d", row, known,
                  hidden);
    }
    f->counts->outside += known == OCC_OUTSIDE;
    f->counts->hidden += known == OCC_HIDDEN;
    f->counts->visible += known == OCC_VISIBLE;
    uint32_t slot = f->table->slot_of ? f->table->slot_of[row] : row;
    if (known == OCC_VISIBLE) f->mask[slot / 32] |= 1u << slot % 32;
}

static void test_block(flat_frame *f, uint32_t first, uint32_t end, uint32_t planes,
                       const bool *touch)
{
    uint32_t list[OCC_FLAT_LIST], count = 0;
    occ_relative_box node = node_of(f, first, end);
    planes = occ_flat_cut(&node, &f->frame->camera.constants, planes);
    f->counts->blocks_dropped++;
    if (planes == OCC_FLAT_OUTSIDE) return;
    for (uint32_t s = 0; s < f->count; s++) {
        if (!touch[s]) continue;
        uint32_t met = occ_flat_meet_node(&node, &f->shadows[s], first, first + OCC_FLAT_ROWS);
        if (met == OCC_MEET_HELD) return;
        if (met == OCC_MEET_TOUCHES && count < OCC_FLAT_LIST) list[count++] = s;
    }
    f->counts->blocks_dropped--;
    for (uint32_t row = first; row < end; row++)
        test_row(f, row, planes, list, count);
}

static void test_group(flat_frame *f, uint32_t first, uint32_t end)
{
    bool touch[OCC_FLAT_SHADOWS] = {false};
    occ_relative_box node = node_of(f, first, end);
    uint32_t planes = occ_flat_cut(&node, &f->frame->camera.constants, f->frame->camera.planes);
    f->counts->groups_dropped++;
    if (planes == OCC_FLAT_OUTSIDE) return;
    for (uint32_t s = 0; s < f->count; s++) {
        uint32_t met = occ_flat_meet_node(&node, &f->shadows[s], first, first + GROUP_ROWS);
        if (met == OCC_MEET_HELD) return;
        touch[s] = met == OCC_MEET_TOUCHES;
    }
    f->counts->groups_dropped--;
    for (uint32_t row = first; row < end; row += OCC_FLAT_ROWS)
        test_block(f, row, row + OCC_FLAT_ROWS < end ? row + OCC_FLAT_ROWS : end, planes, touch);
}

// The occluders of a frame, whose owners are rows.
static void choose(flat_frame *f, const occ_scene *occluders, const uint32_t *owners)
{
    occ_frame *frame = f->frame;
    const kit_flat *table = f->table;
    occ_occluders_clear(frame);
    if (!occluders || frame->knobs.method == OCC_METHOD_FRUSTUM) return;
    frame->scene = occluders;
    static occ_strips strips;
    uint32_t count = table->strips ? table->strips : 1;
    ck_assert_int_eq(occ_strips_open(&strips, frame->hooks, frame->lanes, count), OCC_SUCCESS);
    ck_assert_int_eq(occ_strips_choose(&strips, frame), OCC_SUCCESS);
    occ_strips_close(&strips);
    const occ_occluder *sources = frame->sources.data;
    f->shadows = frame->shadows.data;
    f->count = frame->shadows.count;
    for (uint32_t s = 0; s < f->count; s++) {
        uint32_t slot = owners ? owners[sources[s].index - 1] : OCC_NOBODY;
        f->shadows[s].owner = slot < table->count && !table->slot_of ? slot : OCC_NOBODY;
        for (uint32_t row = 0; table->slot_of && row < table->count; row++)
            if (table->slot_of[row] == slot) f->shadows[s].owner = row;
    }
}

static void set_frame(occ_frame *frame, const occ_camera_desc *camera, const occ_cull_desc *knobs)
{
    const char *reason;
    ck_assert_int_eq(occ_knobs_init(&frame->knobs, knobs, frame->hooks), OCC_SUCCESS);
    if (frame->knobs.max_occluders > OCC_FLAT_SHADOWS)
        frame->knobs.max_occluders = OCC_FLAT_SHADOWS;
    ck_assert_int_eq(occ_camera_init(&frame->camera, camera, &reason), OCC_SUCCESS);
    frame->camera.tolerance = (double)frame->knobs.tolerance;
    frame->camera.constants.splits = frame->knobs.max_splits;
}

uint32_t *kit_flat_mask(const kit_flat *table, const occ_scene *occluders, const uint32_t *owners,
                        const occ_camera_desc *camera, const occ_cull_desc *knobs,
                        kit_flat_counts *counts)
{
    occ_hooks hooks;
    occ_frame frame;
    kit_flat_counts own, *where = counts ? counts : &own;
    *where = (kit_flat_counts){0};
    uint32_t *mask = calloc(OCC_MASK_WORDS(table->count) + 1, sizeof *mask);
    ck_assert_ptr_nonnull(mask);
    ck_assert_int_eq(occ_hooks_init(&hooks, &(occ_allocator){0}, &(occ_logger){0}), OCC_SUCCESS);
    occ_frame_init(&frame, &hooks, occ_lanes_choose());
    set_frame(&frame, camera, knobs);
    flat_frame f = {.table = table, .frame = &frame, .mask = mask, .counts = where};
    f.fused = frame.knobs.method == OCC_METHOD_FUSED;
    choose(&f, occluders, owners);
    for (uint32_t row = 0; row < table->count; row += GROUP_ROWS)
        test_group(&f, row, row + GROUP_ROWS < table->count ? row + GROUP_ROWS : table->count);
    occ_frame_free(&frame);
    return mask;
}

typedef struct keyed_slot {
    uint64_t key;
    uint32_t slot;
} keyed_slot;

static int by_key(const void *a, const void *b)
{
    const keyed_slot *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->slot < y->slot ? -1 : 1;
}

static void bounds_of(const void *boxes, const uint32_t *rows, uint32_t first, uint32_t count,
                      occ_block *block)
{
    occ_bounds_of_array(boxes, rows, first, count, block);
}

uint32_t *kit_flat_order(const occ_box *boxes, uint32_t count)
{
    occ_tree_items items = {boxes, bounds_of};
    occ_root root = occ_octree_root(&items, NULL, count, NULL);
    keyed_slot *keyed = calloc(count, sizeof *keyed);
    uint32_t *slot_of = calloc(count, sizeof *slot_of);
    ck_assert(keyed && slot_of);
    for (uint32_t i = 0; i < count; i++) {
        occ_block block;
        float min[3], max[3];
        occ_bounds_of_array(boxes, NULL, i, 1, &block);
        for (int j = 0; j < 3; j++) {
            min[j] = block.min[j][0];
            max[j] = block.max[j][0];
        }
        keyed[i] = (keyed_slot){occ_octree_key(&root, min, max), i};
    }
    qsort(keyed, count, sizeof *keyed, by_key);
    for (uint32_t i = 0; i < count; i++)
        slot_of[i] = keyed[i].slot;
    free(keyed);
    return slot_of;
}
