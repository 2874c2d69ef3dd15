// SPDX-License-Identifier: Apache-2.0
// Rows of the error report, as CSV and as Markdown.
#define _POSIX_C_SOURCE 200809L
#include "error_report.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A row as a run would leave it.
static error_row make_row(const char *scene, const char *method, const char *backend)
{
    error_row row = {.objects = 100, .occluders = 10, .frames = 60, .truth_frames = 3};
    row.run.method = error_method_find(method);
    ck_assert_ptr_nonnull(row.run.method);
    row.run.settings = measure_defaults();
    row.run.settings.method = method;
    row.run.settings.backend = backend;
    row.run.settings.knobs = error_default_knobs;
    row.run.scale = 1;
    row.threads = 1;
    row.is_timed = true;
    row.median_ms = 0.25;
    row.p99_ms = 0.5;
    row.sums = (compare_sums){.in_frustum = 240, .visible = 40, .missed = 50};
    row.build_ms = 1.5;
    row.bytes = 4096;
    snprintf(row.scene, sizeof row.scene, "%s", scene);
    return row;
}

static char *csv_of(const error_row *row)
{
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(stream);
    if (row)
        error_csv_row(stream, row);
    else
        error_csv_header(stream);
    fclose(stream);
    ck_assert_int_eq(text[size - 1], '\n');
    text[size - 1] = '\0';
    ck_assert_ptr_null(strchr(text, '\n'));
    return text;
}

// The text between the commas before and behind the column.
static void find_column(const char *line, int column, char *text, size_t size)
{
    for (; column > 0; column--) {
        line = strchr(line, ',');
        ck_assert_ptr_nonnull(line);
        line++;
    }
    snprintf(text, size, "%.*s", (int)strcspn(line, ","), line);
}

static int count_columns(const char *line)
{
    int count = 1;
    for (; *line; line++)
        count += *line == ',';
    return count;
}

static int column_of(const char *name)
{
    char *header = csv_of(NULL), text[64];
    int count = count_columns(header), found = -1;
    for (int i = 0; i < count; i++) {
        find_column(header, i, text, sizeof text);
        if (strcmp(text, name) == 0) found = i;
    }
    free(header);
    ck_assert_msg(found >= 0, "no column %s", name);
    return found;
}

static void assert_column(const error_row *row, const char *name, const char *wanted)
{
    char *line = csv_of(row), text[64];
    find_column(line, column_of(name), text, sizeof text);
    ck_assert_msg(strcmp(text, wanted) == 0, "%s is %s, not %s", name, text, wanted);
    free(line);
}

static void assert_as_many_columns(const error_row *row)
{
    char *header = csv_of(NULL), *line = csv_of(row);
    ck_assert_int_eq(count_columns(line), count_columns(header));
    free(header);
    free(line);
}

START_TEST(row_has_a_value_in_every_column_that_applies)
{
    error_row row = make_row("city_1000", "single", "openmp");
    row.settled = (settle_sums){.settled = 9, .judged_visible = 4, .unsettled = 2};
    row.sums.false_hidden = 3;
    row.sums.largest_px = 77;
    assert_as_many_columns(&row);
    const char *const wanted[][2] = {{"scene", "city_1000"},
                                     {"method", "single"},
                                     {"backend", "openmp"},
                                     {"threads", "1"},
                                     {"min_area_sr", "0.0003"},
                                     {"max_occluders", "1024"},
                                     {"grain", "64"},
                                     {"max_splits", ""},
                                     {"tolerance_rad", ""},
                                     {"preset", ""},
                                     {"rays", ""},
                                     {"scale", "1"},
                                     {"frames", "60"},
                                     {"objects", "100"},
                                     {"in_frustum_objects", "80.0"},
                                     {"visible_objects", "13.3"},
                                     {"median_ms", "0.250000"},
                                     {"p99_ms", "0.500000"},
                                     {"false_hidden_objects", "3"},
                                     {"largest_px", "77"},
                                     {"missed_objects", "50"},
                                     {"missed_pct", "25.0000"},
                                     {"settled_objects", "9"},
                                     {"judged_visible_objects", "4"},
                                     {"unsettled_objects", "2"},
                                     {"build_ms", "1.500"},
                                     {"memory_bytes", "4096"},
                                     {"skipped", ""}};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        assert_column(&row, wanted[i][0], wanted[i][1]);
}
END_TEST

START_TEST(what_does_not_apply_is_empty)
{
    error_row rays = make_row("city_1000", "embree-depth", "plain");
    assert_as_many_columns(&rays);
    assert_column(&rays, "rays", "85x48");
    assert_column(&rays, "grain", "");
    error_row fused = make_row("city_1000", "fused", "plain");
    fused.run.settings.knobs.tolerance = 0.25f;
    assert_as_many_columns(&fused);
    assert_column(&fused, "max_splits", "48");
    assert_column(&fused, "tolerance_rad", "0.25");
    assert_column(&fused, "preset", "balanced");
    fused.run.settings.knobs = (occ_cull_desc){.preset = OCC_PRESET_FAST};
    assert_as_many_columns(&fused);
    assert_column(&fused, "max_splits", "");
    assert_column(&fused, "min_area_sr", "");
    assert_column(&fused, "preset", "fast");
    error_row untimed = make_row("hard/panels", "thesis", "plain");
    untimed.is_timed = false;
    untimed.run.scale = 0.01;
    assert_as_many_columns(&untimed);
    assert_column(&untimed, "median_ms", "");
    assert_column(&untimed, "memory_bytes", "");
    assert_column(&untimed, "scale", "0.01");
    assert_column(&untimed, "missed_objects", "50");
}
END_TEST

START_TEST(skipped_row_says_why_and_nothing_else)
{
    error_row row = make_row("city_1000", "pairwise", "opencl");
    row.run.skipped = "no OpenCL device";
    assert_as_many_columns(&row);
    assert_column(&row, "skipped", "\"no OpenCL device\"");
    assert_column(&row, "objects", "100");
    assert_column(&row, "false_hidden_objects", "");
    assert_column(&row, "median_ms", "");
    assert_column(&row, "threads", "");
}
END_TEST

START_TEST(broken_promises_are_those_of_the_one_sided)
{
    error_table table = {0};
    error_row row = make_row("city_1000", "thesis", "plain");
    row.sums.false_hidden = 500;
    for (int i = 0; i < 200; i++) // the table grows
        ck_assert(error_table_add(&table, &row));
    ck_assert_uint_eq(error_table_broken_promises(&table), 0);
    row = make_row("city_1000", "single", "opencl");
    row.sums.false_hidden = 2;
    ck_assert(error_table_add(&table, &row));
    ck_assert(error_table_add(&table, &row));
    row = make_row("city_1000", "fused", "plain");
    row.sums.false_hidden = 7;
    row.run.settings.knobs.tolerance = 1e-3f; // with it there is no such promise
    ck_assert(error_table_add(&table, &row));
    ck_assert_uint_eq(error_table_broken_promises(&table), 4);
    error_table_free(&table);
}
END_TEST

// --- Markdown ------------------------------------------------------------------------------------

static int count_bars(const char *line)
{
    int count = 0;
    for (; *line && *line != '\n'; line++)
        count += *line == '|';
    return count;
}

// Every table has a head, a line of dashes, and as many bars in all its lines.
static int check_tables(const char *text)
{
    int tables = 0, bars = 0, lines = 0;
    for (const char *line = text; line && *line; line = strchr(line, '\n'), line += line != NULL) {
        if (*line != '|') {
            ck_assert_msg(bars == 0 || lines > 2, "an empty table before %.60s", line);
            bars = lines = 0;
            continue;
        }
        if (bars == 0) tables++;
        if (bars == 0) bars = count_bars(line);
        ck_assert_msg(count_bars(line) == bars, "%.100s", line);
        if (++lines == 2) ck_assert_uint_eq(strspn(line, "|-:"), strcspn(line, "\n"));
    }
    return tables;
}

static void add(error_table *table, error_row row)
{
    ck_assert(error_table_add(table, &row));
}

static char *markdown_of(const error_findings *findings, bool has_plots)
{
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(stream);
    error_write_markdown(stream, findings, has_plots);
    fclose(stream);
    return text;
}

static error_findings make_findings(void)
{
    error_findings findings = {.options.repeats = 3, .scenes = {.driver = "none", .peer = "none"}};
    error_table *table = &findings.scenes;
    add(table, make_row("city_1000", "frustum", "plain"));
    add(table, make_row("city_1000", "single", "plain"));
    error_row row = make_row("city_1000", "single", "openmp");
    row.run.settings.threads = 1;
    row.median_ms = 0.125;
    add(table, row);
    row = make_row("city_1000", "thesis", "plain");
    row.run.scale = 0.01;
    row.sums.false_hidden = 4321;
    add(table, row);
    row = make_row("forest", "pairwise", "plain");
    row.run.skipped = "it is large";
    add(table, row);
    add(table, make_row("forest", "single", "plain"));
    row = make_row("hard/panels", "single", "plain");
    row.is_timed = false;
    add(&findings.hard, row);
    row = make_row("hard/few", "single", "plain");
    row.is_timed = false;
    row.sums = (compare_sums){0};
    add(&findings.hard, row);
    return findings;
}

START_TEST(tables_are_well_formed)
{
    error_findings findings = make_findings();
    char *text = markdown_of(&findings, true);
    ck_assert_int_eq(check_tables(text), 4); // summary, two scenes, the families
    ck_assert_ptr_nonnull(strstr(text, "\n## city_1000\n"));
    ck_assert_ptr_nonnull(strstr(text, "\n## forest\n"));
    ck_assert_ptr_nonnull(strstr(text, "(city_1000.png)"));
    ck_assert_ptr_nonnull(strstr(text, "(hard.png)"));
    ck_assert_ptr_nonnull(strstr(text, "| thesis | scale 0.01 | **4321** |"));
    ck_assert_ptr_nonnull(strstr(text, "| panels | 25.0 / 0 |"));
    ck_assert_ptr_nonnull(strstr(text, "| few | - / 0 |"));
    ck_assert_ptr_nonnull(strstr(text, "Not run: `pairwise`: it is large."));
    free(text);
    error_table_free(&findings.scenes);
    error_table_free(&findings.hard);
}
END_TEST

// Both backends' times are in one line, for their verdicts are the same.
START_TEST(backends_share_a_line)
{
    error_findings findings = make_findings();
    char *text = markdown_of(&findings, false);
    ck_assert_ptr_nonnull(strstr(text, "| single | default | 0 | 0 | 50 | 25.000 | 0.250 (0.500) | "
                                       "0.125 (0.500) | | |\n"));
    ck_assert_ptr_null(strstr(text, ".png"));
    free(text);
    error_table_free(&findings.scenes);
    error_table_free(&findings.hard);
}
END_TEST

START_TEST(published_figures_need_the_scenes_identity)
{
    error_findings findings = make_findings();
    char *text = markdown_of(&findings, false);
    ck_assert_ptr_null(strstr(text, "MaskedOcclusionCulling"));
    free(text);
    for (size_t i = 0; i < 4; i++)
        findings.scenes.rows[i].identity = UINT64_C(0x540245dec19ff6f0);
    text = markdown_of(&findings, false);
    ck_assert_ptr_nonnull(strstr(text, "| MaskedOcclusionCulling | front 1 | 0 | 7.6 | 0.058 |"));
    ck_assert_ptr_null(strstr(text, "| 20.7 |"));
    ck_assert_int_eq(check_tables(text), 5);
    free(text);
    error_table_free(&findings.scenes);
    error_table_free(&findings.hard);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("error_report");
    TCase *rows = tcase_create("rows");
    tcase_add_test(rows, row_has_a_value_in_every_column_that_applies);
    tcase_add_test(rows, what_does_not_apply_is_empty);
    tcase_add_test(rows, skipped_row_says_why_and_nothing_else);
    tcase_add_test(rows, broken_promises_are_those_of_the_one_sided);
    suite_add_tcase(suite, rows);
    TCase *markdown = tcase_create("markdown");
    tcase_add_test(markdown, tables_are_well_formed);
    tcase_add_test(markdown, backends_share_a_line);
    tcase_add_test(markdown, published_figures_need_the_scenes_identity);
    suite_add_tcase(suite, markdown);
    return test_run_suite(suite);
}
