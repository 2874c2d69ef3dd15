// SPDX-License-Identifier: Apache-2.0
// Truth files, and the arithmetic of comparing with them.
#define _POSIX_C_SOURCE 200809L
#include "commands.h"
#include "compare_count.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OBJECTS = 5, HEADER = 20, ROW = 4 + 8 * OBJECTS, SIZE = HEADER + 2 * ROW };

static const truth_verdict outside = {0, 0, 0}, hidden = {0, 0, 1};

// Frames 0 and 2, of which the objects are: outside, hidden, seen by samples, by rays, hidden.
static truth_result make_truth(void)
{
    truth_result truth;
    ck_assert(truth_create(&truth, OBJECTS, 2));
    truth.width = 64;
    truth.height = 32;
    truth.frames[1] = 2;
    const truth_verdict row[OBJECTS] = {outside, hidden, {300, 0, 1}, {0, 7, 1}, hidden};
    memcpy(truth.verdicts, row, sizeof row);
    memcpy(truth.verdicts + OBJECTS, row, sizeof row);
    truth.verdicts[OBJECTS + 2].samples = 5;
    return truth;
}

// Three frames, each with a bit for an object.
static vis_result make_masks(uint32_t first, uint32_t second, uint32_t third)
{
    vis_result masks;
    ck_assert(vis_create(&masks, OBJECTS, 3));
    vis_set_frame(&masks, 0, &first);
    vis_set_frame(&masks, 1, &second);
    vis_set_frame(&masks, 2, &third);
    return masks;
}

// A file in the working directory that nothing else has; the caller removes it.
typedef struct temporary {
    char path[32];
} temporary;

static temporary new_file(void)
{
    temporary file = {"test_truth_file_XXXXXX"};
    int descriptor = mkstemp(file.path);
    ck_assert_int_ge(descriptor, 0);
    close(descriptor);
    return file;
}

static void read_text(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "rb");
    ck_assert_ptr_nonnull(file);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
    remove(path);
}

static void get_bytes(uint8_t bytes[SIZE])
{
    truth_result truth = make_truth();
    temporary place = new_file();
    ck_assert(truth_write(place.path, &truth));
    FILE *file = fopen(place.path, "rb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fread(bytes, 1, SIZE, file), SIZE);
    ck_assert_int_eq(fgetc(file), EOF);
    fclose(file);
    remove(place.path);
    truth_free(&truth);
}

// --- the format ----------------------------------------------------------------------------------

START_TEST(file_is_laid_out_as_documented)
{
    static const uint8_t header[HEADER + 4] = {'T', 'R', 'U', '1', 64, 0, 0, 0, 32, 0, 0, 0,
                                               5,   0,   0,   0,   2,  0, 0, 0, 0,  0, 0, 0};
    static const uint8_t seen[16] = {0x2c, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 7, 0, 1, 0};
    uint8_t bytes[SIZE];
    get_bytes(bytes);
    ck_assert_mem_eq(bytes, header, sizeof header);
    ck_assert_mem_eq(bytes + HEADER + 4 + 16, seen, sizeof seen);
    ck_assert_uint_eq(bytes[HEADER + ROW], 2);
}
END_TEST

START_TEST(result_survives_writing_and_reading)
{
    truth_result truth = make_truth(), copy;
    temporary place = new_file();
    ck_assert(truth_write(place.path, &truth));
    ck_assert(truth_read(place.path, &copy));
    remove(place.path);
    ck_assert_uint_eq(copy.width, 64);
    ck_assert_uint_eq(copy.height, 32);
    ck_assert_uint_eq(copy.object_count, OBJECTS);
    ck_assert_uint_eq(copy.frame_count, 2);
    ck_assert_mem_eq(copy.frames, truth.frames, 2 * sizeof *copy.frames);
    ck_assert_mem_eq(copy.verdicts, truth.verdicts, 2 * OBJECTS * sizeof *copy.verdicts);
    truth_free(&truth);
    truth_free(&copy);
}
END_TEST

START_TEST(file_of_any_other_length_is_refused)
{
    uint8_t bytes[SIZE + 1] = {0};
    truth_result truth;
    get_bytes(bytes);
    for (size_t size = 0; size <= SIZE + 1; size++) {
        bool is_whole = size == SIZE;
        ck_assert_int_eq(truth_parse(bytes, size, NULL, &truth), is_whole);
        ck_assert_int_eq(truth.verdicts != NULL, is_whole);
        truth_free(&truth);
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
        {2, 'X', "byte 2: expected the magic \"TRU1\""},
        {4, 0, "byte 4: expected a number of samples from 1 to 16384"},
        {9, 0xff, "byte 8: expected a number of samples from 1 to 16384"},
        {16, 3, "byte 108: expected a file of 152 bytes (5 objects, 3 frames), the file ends"},
        {12, 4, "byte 92: expected a file of 92 bytes (4 objects, 2 frames), the file goes on"},
        {15, 255, "byte 108: expected a file of "},
        {64, 0, "byte 64: expected ascending frames"},
        {43, 1, "byte 40: expected no more samples than the viewport has"},
        {46, 2, "byte 46: expected flags of 0 or 1"},
        {46, 0, "byte 46: expected a visible object to be in the frustum"},
        {28, 1, "byte 30: expected a visible object to be in the frustum"},
    };
    char text[512];
    temporary place = new_file();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint8_t bytes[SIZE];
        truth_result truth;
        get_bytes(bytes);
        bytes[cases[i].at] = cases[i].value;
        ck_assert_ptr_nonnull(freopen(place.path, "wb", stderr));
        ck_assert(!truth_parse(bytes, SIZE, "some.tru", &truth));
        fflush(stderr);
        read_text(place.path, text, sizeof text);
        ck_assert_msg(strstr(text, "some.tru: ") && strstr(text, cases[i].says),
                      "case %zu says: %s", i, text);
    }
}
END_TEST

// --- comparing -----------------------------------------------------------------------------------

START_TEST(sums_are_those_worked_out_by_hand)
{
    truth_result truth = make_truth();
    // Frame 0 shows objects 0, 1 and 3, frame 2 shows 1 and 4; nobody asks for frame 1.
    vis_result masks = make_masks(0x0b, 0x1f, 0x12);
    compare_sums sums = compare_count(&truth, &masks, NULL, NULL);
    ck_assert_uint_eq(sums.in_frustum, 8);
    ck_assert_uint_eq(sums.visible, 4);
    ck_assert_uint_eq(sums.false_hidden, 3);
    ck_assert_uint_eq(sums.largest_px, 300);
    ck_assert_uint_eq(sums.missed, 3);
    ck_assert_double_eq(compare_missed_percent(&sums), 75);
    const compare_sums nothing_hidden = {.in_frustum = 4, .visible = 4};
    ck_assert_double_eq(compare_missed_percent(&nothing_hidden), 0);
    truth_free(&truth);
    vis_free(&masks);
}
END_TEST

START_TEST(files_that_do_not_go_together_are_refused)
{
    truth_result truth = make_truth();
    vis_result masks = make_masks(0, 0, 0);
    ck_assert_ptr_null(compare_check(&truth, &masks));
    truth.frames[1] = 3;
    ck_assert_ptr_nonnull(compare_check(&truth, &masks));
    truth.frames[1] = 2;
    truth.object_count--;
    ck_assert_ptr_nonnull(compare_check(&truth, &masks));
    truth.object_count++;
    truth.frame_count = 0;
    ck_assert_ptr_nonnull(compare_check(&truth, &masks));
    truth_free(&truth);
    vis_free(&masks);
}
END_TEST

// Runs the command on the truth of above and these masks; `line` is what it prints.
static int run_compare(const vis_result *masks, char *line, char *errors, size_t size)
{
    static char name[] = "compare";
    temporary truth_file = new_file(), masks_file = new_file(), out = new_file(), err = new_file();
    truth_result truth = make_truth();
    ck_assert(truth_write(truth_file.path, &truth) && vis_write(masks_file.path, masks));
    truth_free(&truth);
    char *arguments[] = {name, truth_file.path, masks_file.path, NULL};
    fflush(stdout);
    ck_assert_ptr_nonnull(freopen(out.path, "wb", stdout));
    ck_assert_ptr_nonnull(freopen(err.path, "wb", stderr));
    int status = bench_compare(3, arguments);
    fflush(stdout);
    fflush(stderr);
    read_text(out.path, line, size);
    read_text(err.path, errors, size);
    remove(truth_file.path);
    remove(masks_file.path);
    return status;
}

START_TEST(false_hidden_objects_are_named_and_give_status_3)
{
    char line[512], errors[512];
    vis_result masks = make_masks(0x0b, 0x1f, 0x12);
    ck_assert_int_eq(run_compare(&masks, line, errors, sizeof line), 3);
    ck_assert_str_eq(line, "frames=2 in_frustum=4.0 visible=2.0 false_hidden=3 largest_px=300 "
                           "missed=3 missed_pct=75.000\n");
    ck_assert_ptr_nonnull(strstr(errors, "frame 0: object 2 is reported hidden: 300 samples"));
    ck_assert_ptr_nonnull(strstr(errors, "frame 2: object 2 is reported hidden: 5 samples"));
    ck_assert_ptr_nonnull(
        strstr(errors, "frame 2: object 3 is reported hidden: 0 samples and 7 r"));
    vis_free(&masks);
}
END_TEST

START_TEST(sound_result_gives_status_0)
{
    char line[512], errors[512];
    vis_result masks = make_masks(0x0c, 0, 0x1e);
    ck_assert_int_eq(run_compare(&masks, line, errors, sizeof line), 0);
    ck_assert_str_eq(line, "frames=2 in_frustum=4.0 visible=2.0 false_hidden=0 largest_px=0 "
                           "missed=2 missed_pct=50.000\n");
    ck_assert_str_eq(errors, "");
    vis_free(&masks);
}
END_TEST

START_TEST(other_objects_give_status_1_and_no_files_status_2)
{
    char line[512], errors[512];
    vis_result masks;
    ck_assert(vis_create(&masks, OBJECTS + 1, 3));
    ck_assert_int_eq(run_compare(&masks, line, errors, sizeof line), 1);
    ck_assert_str_eq(line, "");
    ck_assert_ptr_nonnull(strstr(errors, "another number of objects"));
    vis_free(&masks);
    static char name[] = "compare";
    char *arguments[] = {name, NULL};
    ck_assert_int_eq(bench_compare(1, arguments), 2);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("truth_file");
    TCase *format = tcase_create("format");
    tcase_add_test(format, file_is_laid_out_as_documented);
    tcase_add_test(format, result_survives_writing_and_reading);
    tcase_add_test(format, file_of_any_other_length_is_refused);
    tcase_add_test(format, refusal_names_file_byte_and_expectation);
    suite_add_tcase(suite, format);
    TCase *comparing = tcase_create("comparing");
    tcase_add_test(comparing, sums_are_those_worked_out_by_hand);
    tcase_add_test(comparing, files_that_do_not_go_together_are_refused);
    tcase_add_test(comparing, false_hidden_objects_are_named_and_give_status_3);
    tcase_add_test(comparing, sound_result_gives_status_0);
    tcase_add_test(comparing, other_objects_give_status_1_and_no_files_status_2);
    suite_add_tcase(suite, comparing);
    return test_run_suite(suite);
}
