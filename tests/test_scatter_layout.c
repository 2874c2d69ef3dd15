// SPDX-License-Identifier: Apache-2.0
// Where the error report's plots put things: nothing outside of the axes, no label on another.
#include "scatter_layout.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static scatter_axes axes_of(scatter_series *series, size_t count)
{
    const scatter_plot plot = {.series = series, .count = count};
    return scatter_axes_of(&plot);
}

static void add(scatter_series *series, double x, double y, const char *label)
{
    scatter_point *point = &series->points[series->count++];
    *point = (scatter_point){.x = x, .y = y};
    snprintf(point->label, sizeof point->label, "%s", label);
}

START_TEST(every_point_is_within_the_axes)
{
    static const double values[][2] = {{0.01, 100}, {3, 0.002}, {900, 0}, {0.5, 1}};
    scatter_series series = {0};
    for (size_t count = 1; count <= 4; count++) {
        add(&series, values[count - 1][0], values[count - 1][1], "");
        scatter_axes axes = axes_of(&series, 1);
        for (size_t i = 0; i < count; i++) {
            double y = scatter_place(&axes, values[i][1]);
            ck_assert(axes.x_low < values[i][0] && values[i][0] < axes.x_high);
            ck_assert(axes.y_low < y && y < axes.y_high);
        }
    }
}
END_TEST

START_TEST(nothing_missed_is_drawn_below_everything_else)
{
    scatter_series series = {0};
    add(&series, 1, 0, "");
    add(&series, 2, 0.0625, "");
    scatter_axes axes = axes_of(&series, 1);
    ck_assert(axes.has_zero);
    ck_assert(axes.zero > axes.y_low && axes.zero < 0.0625);
    ck_assert(!(scatter_place(&axes, 0) > axes.zero) && !(scatter_place(&axes, 0) < axes.zero));
    scatter_series alone = {0};
    add(&alone, 1, 0, "");
    axes = axes_of(&alone, 1);
    ck_assert(axes.has_zero && axes.zero > axes.y_low && axes.zero < axes.y_high);
}
END_TEST

static double width_of(const scatter_label *label)
{
    return 6.0 * (double)strlen(label->text); // a little less than it may take
}

// Points as close as those of programs that do about the same.
START_TEST(labels_of_a_heap_of_points_keep_apart)
{
    scatter_series *series = calloc(1, sizeof *series);
    for (int i = 0; i < 10; i++)
        add(series, 1 + 0.02 * i, 2 + 0.03 * (i * 7 % 10), i % 2 ? "123" : "x100: 77");
    add(series, 0.01, 100, "corner");
    add(series, 100, 0, "corner");
    const scatter_plot plot = {.series = series, .count = 1};
    scatter_axes axes = scatter_axes_of(&plot);
    static scatter_label labels[SCATTER_MAX_LABELS];
    size_t count = scatter_place_labels(&plot, &axes, labels);
    ck_assert_uint_eq(count, 12);
    for (size_t i = 0; i < count; i++) {
        ck_assert(labels[i].x >= SCATTER_LEFT &&
                  labels[i].x + width_of(&labels[i]) <= SCATTER_RIGHT);
        ck_assert(labels[i].y > SCATTER_BOTTOM && labels[i].y < SCATTER_TOP);
        for (size_t k = 0; k < i; k++) {
            bool is_beside = labels[k].x + width_of(&labels[k]) + 5 <= labels[i].x ||
                             labels[i].x + width_of(&labels[i]) + 5 <= labels[k].x;
            bool is_above = labels[k].y + 11 <= labels[i].y || labels[i].y + 11 <= labels[k].y;
            ck_assert_msg(is_beside || is_above, "labels %zu and %zu overlap", k, i);
        }
    }
    free(series);
}
END_TEST

START_TEST(points_without_text_have_no_label)
{
    scatter_series series = {0};
    add(&series, 1, 1, "");
    add(&series, 2, 1, "9");
    const scatter_plot plot = {.series = &series, .count = 1};
    scatter_axes axes = scatter_axes_of(&plot);
    static scatter_label labels[SCATTER_MAX_LABELS];
    ck_assert_uint_eq(scatter_place_labels(&plot, &axes, labels), 1);
    ck_assert_str_eq(labels[0].text, "9");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scatter_layout");
    TCase *axes = tcase_create("axes");
    tcase_add_test(axes, every_point_is_within_the_axes);
    tcase_add_test(axes, nothing_missed_is_drawn_below_everything_else);
    suite_add_tcase(suite, axes);
    TCase *labels = tcase_create("labels");
    tcase_add_test(labels, labels_of_a_heap_of_points_keep_apart);
    tcase_add_test(labels, points_without_text_have_no_label);
    suite_add_tcase(suite, labels);
    return test_run_suite(suite);
}
