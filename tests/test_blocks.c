// SPDX-License-Identifier: Apache-2.0
// What is worked out for a block of boxes, on every instruction set that is here, is bit for bit
// what is worked out for each of them.
#include "blocks.h"
#include "bounds.h"
#include "box.h"
#include "kit.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = OCC_TEST_SLOWNESS > 1 ? 50 : 500, VARIANTS = 3 };

typedef occ_box (*box_maker)(kit_random *random);

static occ_box common(kit_random *random)
{
    return kit_box(random, 1000, 3);
}

static occ_box any_size(kit_random *random)
{
    float reach = ldexpf(1, (int)kit_below(random, 90) - 41);
    return kit_box(random, reach, ldexpf(1, (int)kit_below(random, 90) - 41));
}

// Sheets, lines and points, at zero and at minus zero.
static occ_box flat(kit_random *random)
{
    occ_box box = kit_box(random, 10, 3);
    float *numbers = (float *)&box;
    for (uint32_t i = 0; i < 12; i++)
        if (kit_below(random, 2)) numbers[i] = kit_below(random, 2) ? 0.0f : -0.0f;
    return box;
}

static occ_box denormal(kit_random *random)
{
    occ_box box = kit_box(random, 0x1p-125f, 0x1p-130f);
    float *numbers = (float *)&box;
    for (uint32_t i = 0; i < 12; i++)
        if (!kit_below(random, 3)) numbers[i] = ldexpf(kit_between(random, -4, 4), -149);
    return box;
}

// Bounds next to a boundary between floats, or on it.
static occ_box on_the_grid(kit_random *random)
{
    occ_box box = kit_cube(0, 0, 0, 0);
    for (int j = 0; j < 3; j++) {
        box.center[j] = ldexpf((float)(1 + kit_below(random, 9)), -(int)kit_below(random, 30));
        box.axis[j][j] = kit_below(random, 3) ? box.center[j] * 0x1p-24f : box.center[j];
    }
    return box;
}

static const box_maker makers[] = {common, any_size, flat, denormal, on_the_grid};

enum { MAKERS = (int)(sizeof makers / sizeof *makers) };

// A block of boxes, and the same as columns.
typedef struct block_of_boxes {
    occ_box boxes[OCC_BLOCK];
    float columns[OCC_BOX_COLUMNS][OCC_BLOCK];
    occ_block_columns from;
    uint32_t count;
} block_of_boxes;

static void make_block(block_of_boxes *b, kit_random *random, box_maker maker)
{
    b->count = 1 + kit_below(random, OCC_BLOCK);
    for (uint32_t i = 0; i < b->count; i++) {
        b->boxes[i] = maker(random);
        float numbers[OCC_BOX_COLUMNS];
        memcpy(numbers, &b->boxes[i], sizeof numbers);
        for (uint32_t c = 0; c < OCC_BOX_COLUMNS; c++)
            b->columns[c][i] = numbers[c];
    }
    for (uint32_t c = 0; c < OCC_BOX_COLUMNS; c++)
        b->from[c] = b->columns[c];
}

static void check_bounds(const block_of_boxes *b, const occ_block *block, const char *name)
{
    for (uint32_t i = 0; i < b->count; i++) {
        float min[3], max[3];
        occ_box_bounds(&b->boxes[i], min, max);
        for (int j = 0; j < 3; j++)
            KIT_CHECK(kit_same_bits(&min[j], &block->min[j][i], sizeof *min) &&
                          kit_same_bits(&max[j], &block->max[j][i], sizeof *max),
                      "%s: box %u has [%a, %a], not [%a, %a]", name, i, (double)block->min[j][i],
                      (double)block->max[j][i], (double)min[j], (double)max[j]);
    }
}

START_TEST(bounds_are_those_of_each_box)
{
    block_of_boxes b;
    occ_block block;
    kit_random random = {(uint64_t)_i};
    for (uint32_t round = 0; round < ROUNDS; round++) {
        make_block(&b, &random, makers[_i]);
        for (uint32_t v = 0; occ_blocks_get(v); v++) {
            occ_blocks_get(v)->bounds(b.from, b.count, &block);
            check_bounds(&b, &block, occ_blocks_get(v)->name);
        }
        occ_bounds_of_array(b.boxes, NULL, 0, b.count, &block);
        check_bounds(&b, &block, "array");
    }
}
END_TEST

START_TEST(reaches_are_those_of_each_box)
{
    block_of_boxes b;
    float reaches[OCC_BLOCK];
    kit_random random = {(uint64_t)_i + 100};
    for (uint32_t round = 0; round < ROUNDS; round++) {
        make_block(&b, &random, makers[_i]);
        if (round % 5 == 0) { // more area than a float can name
            b.boxes[0].axis[0][0] = b.columns[3][0] = 0.3e15f;
            b.boxes[0].axis[1][1] = b.columns[7][0] = round % 2 ? 0.3e15f : 1e30f;
        }
        for (uint32_t v = 0; occ_blocks_get(v); v++) {
            occ_blocks_get(v)->reaches(b.from, b.count, reaches);
            for (uint32_t i = 0; i < b.count; i++) {
                float expected = occ_occluder_reach(&b.boxes[i]);
                KIT_CHECK(kit_same_bits(&reaches[i], &expected, sizeof expected),
                          "%s: box %u reaches %a, not %a", occ_blocks_get(v)->name, i,
                          (double)reaches[i], (double)expected);
            }
        }
    }
}
END_TEST

// An item's key, by the words of octree.h.
static uint64_t key_of(const occ_root *root, const occ_block *block, uint32_t i)
{
    double width = 0.0, most = ldexp(1.0, (int)OCC_TREE_BITS) - 1.0;
    uint64_t place[3], code = 0;
    for (int j = 0; j < 3; j++) {
        double low = (double)block->min[j][i], high = (double)block->max[j][i];
        double cells = (0.5 * (low + high) - root->origin[j]) / root->size * (most + 1.0);
        place[j] = (uint64_t)fmin(fmax(cells, 0.0), most);
        width = fmax(width, high - low);
    }
    uint32_t level = OCC_TREE_BITS;
    while (level && ldexp(root->size, -(int)level) < 0.5 * width)
        level--;
    for (uint32_t bit = 0; bit < 3 * OCC_TREE_BITS; bit++) {
        bool kept = bit >= 3 * (OCC_TREE_BITS - level);
        if (kept) code |= (place[bit % 3] >> bit / 3 & 1u) << bit;
    }
    return code << OCC_LEVEL_BITS | level;
}

START_TEST(keys_are_cells_and_levels)
{
    block_of_boxes b;
    occ_block block;
    uint64_t keys[OCC_BLOCK];
    kit_random random = {(uint64_t)_i + 200};
    for (uint32_t round = 0; round < ROUNDS / 5; round++) {
        make_block(&b, &random, makers[_i]);
        occ_blocks_get(0)->bounds(b.from, b.count, &block);
        occ_root root = {.size = ldexp(1.0, (int)kit_below(&random, 60) - 40)};
        for (int j = 0; j < 3; j++)
            root.origin[j] = (double)kit_below(&random, 9) * -0.125 * root.size;
        for (uint32_t v = 0; occ_blocks_get(v); v++) {
            occ_blocks_get(v)->keys(&root, &block, b.count, keys);
            for (uint32_t i = 0; i < b.count; i++)
                KIT_CHECK(keys[i] == key_of(&root, &block, i), "%s: item %u has another key",
                          occ_blocks_get(v)->name, i);
        }
    }
}
END_TEST

START_TEST(best_variant_is_chosen_and_plain_is_always_there)
{
    uint32_t count = 0;
    while (occ_blocks_get(count))
        count++;
    ck_assert_uint_ge(count, 1);
    ck_assert_uint_le(count, VARIANTS);
    ck_assert_ptr_eq(occ_blocks_choose(), occ_blocks_get(0));
    ck_assert_str_eq(occ_blocks_get(count - 1)->name, "plain");
}
END_TEST

START_TEST(rows_and_lists_name_the_boxes)
{
    enum { ROWS = 900 };
    occ_hooks hooks;
    occ_allocator none = {0};
    occ_logger silent = {0};
    ck_assert_int_eq(occ_hooks_init(&hooks, &none, &silent), OCC_SUCCESS);
    occ_boxes table = {NULL, 0, 0};
    ck_assert_int_eq(occ_boxes_reserve(&hooks, &table, ROWS), OCC_SUCCESS);
    occ_box *boxes = malloc(ROWS * sizeof *boxes);
    ck_assert_ptr_nonnull(boxes);
    kit_random random = {3};
    uint32_t list[OCC_BLOCK];
    for (uint32_t i = 0; i < ROWS; i++) {
        boxes[i] = common(&random);
        occ_boxes_set(&table, i, &boxes[i]);
    }
    for (uint32_t i = 0; i < OCC_BLOCK; i++)
        list[i] = kit_below(&random, ROWS);
    for (int listed = 0; listed < 2; listed++) {
        static block_of_boxes b;
        occ_block block;
        b.count = 200;
        for (uint32_t i = 0; i < b.count; i++)
            b.boxes[i] = boxes[listed ? list[i] : 77 + i];
        occ_bounds_of_rows(&table, listed ? list : NULL, 77, b.count, &block);
        check_bounds(&b, &block, "rows");
        occ_bounds_of_array(boxes, listed ? list : NULL, 77, b.count, &block);
        check_bounds(&b, &block, "array");
    }
    free(boxes);
    occ_boxes_free(&hooks, &table);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("blocks");
    TCase *same = tcase_create("same");
    tcase_add_loop_test(same, bounds_are_those_of_each_box, 0, MAKERS);
    tcase_add_loop_test(same, reaches_are_those_of_each_box, 0, MAKERS);
    tcase_add_loop_test(same, keys_are_cells_and_levels, 0, MAKERS);
    tcase_add_test(same, best_variant_is_chosen_and_plain_is_always_there);
    tcase_add_test(same, rows_and_lists_name_the_boxes);
    suite_add_tcase(suite, same);
    return test_run_suite(suite);
}
