// SPDX-License-Identifier: Apache-2.0
// Scene files of both versions: their bytes, and what is refused.
#define _POSIX_C_SOURCE 200809L
#include "obs.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    HEADER = 16,
    BOX = 48,
    OCCLUDER = 52,
    SHEET = 108,
    FRAME = 152,
    PLAIN = HEADER + 2 * BOX + OCCLUDER + FRAME,
    FIRST = HEADER + 4 + 2 * BOX + OCCLUDER, // where the sheets begin
    SIZE = FIRST + 2 * SHEET + FRAME,
};

// --- files ---------------------------------------------------------------------------------------

typedef struct temporary {
    char path[32];
} temporary;

static temporary new_file(void)
{
    temporary file = {"test_obs_XXXXXX"};
    int descriptor = mkstemp(file.path);
    ck_assert_int_ge(descriptor, 0);
    close(descriptor);
    return file;
}

static void get_bytes(const obs_scene *scene, uint8_t *bytes, size_t size)
{
    temporary place = new_file();
    ck_assert(obs_write(place.path, scene));
    FILE *file = fopen(place.path, "rb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fread(bytes, 1, size, file), size);
    ck_assert_int_eq(fgetc(file), EOF);
    fclose(file);
    remove(place.path);
}

// --- scenes --------------------------------------------------------------------------------------

static occ_sheet some_sheet(uint32_t count, occ_sides sides)
{
    occ_sheet sheet = {.corner_count = count, .sides = sides};
    for (uint32_t c = 0; c < OCC_SHEET_CORNERS; c++) // more than count: they are not to be written
        for (int j = 0; j < 3; j++)
            sheet.corner[c][j] = 0.5f + (float)(3 * c) + (float)j;
    return sheet;
}

static obs_scene some_scene(bool has_sheets)
{
    obs_scene scene = {0};
    const occ_box box = {{1, 2, 3}, {{4, 5, 6}, {7, 8, 9}, {-1, -2, 0.5f}}};
    const occ_sheet three = some_sheet(3, OCC_SIDES_FRONT), eight = some_sheet(8, OCC_SIDES_BOTH);
    obs_frame frame = {.eye = {1, 2, 3}, .dir = {0, 0, -1}};
    obs_add_object(&scene, &box);
    obs_add_object(&scene, &box);
    obs_add_occluder(&scene, &box, 1);
    if (has_sheets) obs_add_sheet(&scene, &three, 1);
    if (has_sheets) obs_add_sheet(&scene, &eight, 0);
    obs_add_frame(&scene, &frame);
    ck_assert(!scene.out_of_memory);
    return scene;
}

static void make_file(uint8_t bytes[SIZE])
{
    obs_scene scene = some_scene(true);
    get_bytes(&scene, bytes, SIZE);
    obs_free(&scene);
}

// --- the format ----------------------------------------------------------------------------------

START_TEST(scene_without_sheets_is_of_version_1)
{
    static const uint8_t header[HEADER] = {'O', 'B', 'S', '1', 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    static const uint8_t one[4] = {0, 0, 0x80, 0x3f}, owner[4] = {1, 0, 0, 0};
    uint8_t bytes[PLAIN], again[PLAIN];
    obs_scene scene = some_scene(false), copy;
    get_bytes(&scene, bytes, PLAIN);
    ck_assert_mem_eq(bytes, header, HEADER);
    ck_assert_mem_eq(bytes + HEADER, one, 4);
    ck_assert_mem_eq(bytes + HEADER + 2 * BOX + BOX, owner, 4);
    ck_assert_mem_eq(bytes + HEADER + 2 * BOX + OCCLUDER, one, 4);
    ck_assert(obs_parse(bytes, PLAIN, NULL, &copy));
    ck_assert_uint_eq(copy.sheet_count, 0);
    get_bytes(&copy, again, PLAIN);
    ck_assert_mem_eq(again, bytes, PLAIN);
    obs_free(&scene);
    obs_free(&copy);
}
END_TEST

START_TEST(scene_with_sheets_is_of_version_2)
{
    static const uint8_t header[HEADER + 4] = {'O', 'B', 'S', '2', 2, 0, 0, 0, 1, 0,
                                               0,   0,   2,   0,   0, 0, 1, 0, 0, 0};
    static const uint8_t first[12] = {3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0x3f},
                         owner[4] = {1, 0, 0, 0};
    static const uint8_t unused[60];
    uint8_t bytes[SIZE];
    make_file(bytes);
    ck_assert_mem_eq(bytes, header, sizeof header);
    ck_assert_mem_eq(bytes + FIRST, first, sizeof first);
    ck_assert_mem_eq(bytes + FIRST + 8 + 36, unused, sizeof unused);
    ck_assert_mem_eq(bytes + FIRST + 104, owner, 4);
    ck_assert_uint_eq(bytes[FIRST + SHEET], 8);
}
END_TEST

START_TEST(what_is_written_is_read)
{
    uint8_t bytes[SIZE], again[SIZE];
    obs_scene scene;
    make_file(bytes);
    ck_assert(obs_parse(bytes, SIZE, NULL, &scene));
    ck_assert_uint_eq(obs_occluder_total(&scene), 3);
    ck_assert_ptr_null(obs_occluder_sheet(&scene, 0));
    ck_assert_uint_eq(obs_occluder_sheet(&scene, 1)->corner_count, 3);
    ck_assert_int_eq(obs_occluder_sheet(&scene, 1)->sides, OCC_SIDES_FRONT);
    ck_assert_float_eq(obs_occluder_sheet(&scene, 2)->corner[7][2], 23.5f);
    for (uint32_t i = 0; i < 3; i++)
        ck_assert_uint_eq(obs_occluder_owner(&scene, i), i < 2);
    get_bytes(&scene, again, SIZE);
    ck_assert_mem_eq(again, bytes, SIZE);
    obs_free(&scene);
}
END_TEST

START_TEST(occluder_of_no_object_needs_version_2)
{
    enum { GROWN = PLAIN + 4, OWNER = HEADER + 4 + 2 * BOX + BOX };
    static const uint8_t none[4] = {0xff, 0xff, 0xff, 0xff};
    uint8_t bytes[GROWN], again[GROWN];
    obs_scene scene = some_scene(false), copy;
    scene.occluders[0].owner = OBS_NO_OWNER;
    get_bytes(&scene, bytes, GROWN);
    ck_assert_int_eq(bytes[3], '2');
    ck_assert_mem_eq(bytes + OWNER, none, 4);
    ck_assert(obs_parse(bytes, GROWN, NULL, &copy));
    ck_assert_uint_eq(obs_occluder_owner(&copy, 0), OBS_NO_OWNER);
    get_bytes(&copy, again, GROWN);
    ck_assert_mem_eq(again, bytes, GROWN);
    obs_free(&copy);
    // Version 1 knows no such thing.
    scene.occluders[0].owner = 1;
    get_bytes(&scene, bytes, PLAIN);
    memset(bytes + OWNER - 4, 0xff, 4);
    ck_assert(!obs_parse(bytes, PLAIN, NULL, &copy));
    obs_free(&scene);
    // A sheet may be of no object as well.
    uint8_t whole[SIZE];
    make_file(whole);
    memset(whole + FIRST + 104, 0xff, 4);
    ck_assert(obs_parse(whole, SIZE, NULL, &copy));
    ck_assert_uint_eq(obs_occluder_owner(&copy, 1), OBS_NO_OWNER);
    obs_free(&copy);
}
END_TEST

START_TEST(file_of_any_other_length_is_refused)
{
    uint8_t bytes[SIZE + 1] = {0};
    obs_scene scene;
    make_file(bytes);
    for (size_t size = 0; size <= SIZE + 1; size++) {
        ck_assert_int_eq(obs_parse(bytes, size, NULL, &scene), size == SIZE);
        ck_assert_int_eq(scene.sheets != NULL, size == SIZE);
        obs_free(&scene);
    }
}
END_TEST

START_TEST(refusal_names_file_byte_and_expectation)
{
    static const struct {
        size_t at;
        uint8_t value;
        const char *says;
    } cases[] = {
        {3, '3', "byte 3: expected the magic \"OBS1\" or \"OBS2\""},
        {0, 'X', "byte 0: expected the magic \"OBS1\" or \"OBS2\""},
        {12, 3, "byte 536: expected a file of 644 bytes (2 objects, 1 occluders, 3 sheets, 1"},
        {12, 1, "byte 428: expected a file of 428 bytes (2 objects, 1 occluders, 1 sheets, 1"},
        {FIRST, 2, "byte 168: expected 3 to 8 corners in sheet 0, found 2"},
        {FIRST + SHEET, 9, "byte 276: expected 3 to 8 corners in sheet 1, found 9"},
        {FIRST + 4, 2, "byte 172: expected sheet 0 to hide from both sides (0) or from its front"},
        {FIRST + 8 + 36, 1, "byte 212: expected 0 beyond the 3 corners of sheet 0"},
        {FIRST + 103, 0x80, "byte 271: expected 0 beyond the 3 corners of sheet 0"},
        {FIRST + 104, 2, "byte 272: expected the owner of sheet 0 to be below 2 objects, found 2"},
        {FIRST - 4, 7, "byte 164: expected the owner of occluder 0 to be below 2 objects, found 7"},
    };
    char text[512];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint8_t bytes[SIZE];
        obs_scene scene;
        make_file(bytes);
        bytes[cases[i].at] = cases[i].value;
        temporary place = new_file();
        ck_assert_ptr_nonnull(freopen(place.path, "wb", stderr));
        ck_assert(!obs_parse(bytes, SIZE, "some.obs", &scene));
        fflush(stderr);
        FILE *file = fopen(place.path, "rb");
        ck_assert_ptr_nonnull(file);
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
        remove(place.path);
        ck_assert_msg(strstr(text, "some.obs: ") && strstr(text, cases[i].says),
                      "case %zu says: %s", i, text);
    }
}
END_TEST

// Every float of a sheet, used or not.
START_TEST(sheet_that_is_not_finite_is_refused)
{
    static const uint8_t not_finite[2][4] = {{0, 0, 0x80, 0xff}, {1, 0, 0xc0, 0x7f}};
    for (size_t at = FIRST + 8; at < FIRST + 104; at += 4)
        for (int i = 0; i < 2; i++) {
            uint8_t bytes[SIZE];
            obs_scene scene;
            make_file(bytes);
            memcpy(bytes + at, not_finite[i], 4);
            ck_assert(!obs_parse(bytes, SIZE, NULL, &scene));
        }
}
END_TEST

// Together more than occluder numbers go, and more than there is memory for.
START_TEST(huge_counts_are_refused_before_memory_is_asked_for)
{
    uint8_t bytes[SIZE];
    obs_scene scene;
    make_file(bytes);
    memset(bytes + 8, 0xff, 8);
    ck_assert(!obs_parse(bytes, SIZE, NULL, &scene));
    make_file(bytes);
    memset(bytes + 12, 0xff, 4);
    ck_assert(!obs_parse(bytes, SIZE, NULL, &scene));
    ck_assert_ptr_null(scene.sheets);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("obs");
    TCase *format = tcase_create("format");
    tcase_add_test(format, scene_without_sheets_is_of_version_1);
    tcase_add_test(format, scene_with_sheets_is_of_version_2);
    tcase_add_test(format, what_is_written_is_read);
    tcase_add_test(format, occluder_of_no_object_needs_version_2);
    suite_add_tcase(suite, format);
    TCase *refusals = tcase_create("refusals");
    tcase_add_test(refusals, file_of_any_other_length_is_refused);
    tcase_add_test(refusals, refusal_names_file_byte_and_expectation);
    tcase_add_test(refusals, sheet_that_is_not_finite_is_refused);
    tcase_add_test(refusals, huge_counts_are_refused_before_memory_is_asked_for);
    suite_add_tcase(suite, refusals);
    return test_run_suite(suite);
}
