// SPDX-License-Identifier: Apache-2.0
// The validator has teeth: whatever is damaged in what a sound scene knows of its sheets, it sees.
#include "kit_damage.h"
#include "support.h"

#include <math.h>

// The first row from `from` on that is a sheet, or a box.
static uint32_t row_of(bool sheet, uint32_t from)
{
    for (uint32_t row = from; row < kit_victim->occluder_rows.count; row++)
        if ((occ_scene_sheet(kit_victim, row) != NULL) == sheet) return row;
    ck_abort_msg("no such row");
    return 0;
}

static occ_sheet_entry *entry_of(uint32_t row)
{
    return occ_sheets_at(&kit_victim->sheets, occ_scene_sheet_of(kit_victim, row));
}

static uint32_t *sheet_of(uint32_t row)
{
    return kit_victim->occluder_rows.sheet_of + row;
}

static void take_a_sheet_for_a_box(void)
{
    *sheet_of(row_of(true, 0)) = OCC_NO_SLOT;
}

static void take_a_box_for_a_sheet(void)
{
    *sheet_of(row_of(false, 0)) = *sheet_of(row_of(true, 0));
}

static void give_a_sheet_to_another(void)
{
    uint32_t row = row_of(true, 0);
    *sheet_of(row) = *sheet_of(row_of(true, row + 1));
}

static void name_a_sheet_outside(void)
{
    *sheet_of(row_of(true, 0)) = kit_victim->sheets.entries.count;
}

static void move_a_corner_secretly(void)
{
    entry_of(row_of(true, 0))->sheet.corner[1][2] += 1.0f;
}

static void move_a_proxy_secretly(void)
{
    occ_box *box = &kit_victim->occluder_rows.boxes[row_of(true, 0)];
    box->axis[0][0] = nextafterf(box->axis[0][0], INFINITY);
}

static void make_a_corner_unknown(void)
{
    entry_of(row_of(true, 0))->sheet.corner[0][0] = NAN;
}

static void add_a_ninth_corner(void)
{
    entry_of(row_of(true, 0))->sheet.corner_count = 9;
}

static void leave_a_corner_beyond_the_last(void)
{
    uint32_t row = row_of(true, 0);
    while (entry_of(row)->sheet.corner_count == OCC_SHEET_CORNERS)
        row = row_of(true, row + 1);
    entry_of(row)->sheet.corner[OCC_SHEET_CORNERS - 1][1] = 1.0f;
}

static void count_one_sheet_more(void)
{
    kit_victim->sheets.taken++;
}

static void count_one_sheet_less(void)
{
    kit_victim->sheets.taken--;
}

static void take_a_sheet_for_free(void)
{
    kit_victim->sheets.free = occ_scene_sheet_of(kit_victim, row_of(true, 0));
}

static void lose_the_free_entries(void)
{
    ck_assert_uint_ne(kit_victim->sheets.free, OCC_NO_SLOT);
    kit_victim->sheets.free = OCC_NO_SLOT;
}

static void chase_the_free_entries_in_a_ring(void)
{
    occ_sheet_entry *first = occ_sheets_at(&kit_victim->sheets, kit_victim->sheets.free);
    first->next = kit_victim->sheets.free;
}

static const kit_damage damages[] = {
    {"a sheet is taken for a box", take_a_sheet_for_a_box},
    {"a box is taken for a sheet", take_a_box_for_a_sheet},
    {"a sheet is another's", give_a_sheet_to_another},
    {"a row names a sheet outside", name_a_sheet_outside},
    {"a corner has moved", move_a_corner_secretly},
    {"a proxy has grown", move_a_proxy_secretly},
    {"a corner is NaN", make_a_corner_unknown},
    {"a sheet has nine corners", add_a_ninth_corner},
    {"there is a corner beyond the last", leave_a_corner_beyond_the_last},
    {"a sheet too many is counted", count_one_sheet_more},
    {"a sheet too few is counted", count_one_sheet_less},
    {"a sheet is taken for free", take_a_sheet_for_free},
    {"the free entries are lost", lose_the_free_entries},
    {"the free entries go round", chase_the_free_entries_in_a_ring},
};
enum { DAMAGES = (int)(sizeof damages / sizeof *damages) };

START_TEST(damage_to_the_sheets_is_seen)
{
    damages[_i].do_it();
    kit_damage_check(damages[_i].what);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sheet_check");
    TCase *table = tcase_create("table");
    tcase_add_checked_fixture(table, kit_damage_set_up, kit_damage_tear_down);
    tcase_add_loop_test(table, damage_to_the_sheets_is_seen, 0, DAMAGES);
    suite_add_tcase(suite, table);
    return test_run_suite(suite);
}
