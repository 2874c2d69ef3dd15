// SPDX-License-Identifier: Apache-2.0
// labels: property
// Every scene file in tests/regressions, on every method and backend, against the exact judges:
// small worlds that some fault, named by the file, once got wrong. A file that is put there is
// tested.
#define _POSIX_C_SOURCE 200809L

#include "mini_check.h"
#include "support.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_FILES = 12, MOST_FILES = 1000 };

static const char directory[] = OCC_TEST_DATA "/regressions";

static int is_scene(const struct dirent *entry)
{
    size_t length = strlen(entry->d_name);
    return length > 4 && strcmp(entry->d_name + length - 4, ".obs") == 0;
}

// Every frame, with the eye that stands in the file and with the one that its matrices have.
static void replay(const char *name, mini_views *views)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    uint32_t frames = 1;
    for (uint32_t frame = 0; frame < frames; frame++)
        for (int given = 0; given < 2; given++) {
            mini m;
            mini_fault fault;
            ck_assert_msg(mini_read(&m, path, frame, &frames), "%s is no small scene", name);
            m.camera.eye_given = given == 1;
            ck_assert_msg(!mini_breaks(&m, views, &fault), "%s, eye %s: %s", name,
                          given ? "given" : "derived", fault.text);
        }
}

static void replay_all(bool device)
{
    struct dirent **entries = NULL;
    int count = scandir(directory, &entries, is_scene, alphasort);
    ck_assert_int_ge(count, LEAST_FILES);
    ck_assert_int_lt(count, MOST_FILES);
    mini_views views = mini_open_views(device);
    for (int i = 0; i < count; i++) {
        replay(entries[i]->d_name, &views);
        free(entries[i]);
    }
    ck_assert_uint_ge(views.count.worlds, 2 * (uint64_t)count);
    ck_assert_uint_eq(views.count.refused, 0);
    mini_close_views(&views);
    free(entries);
}

START_TEST(no_world_that_was_once_wrong_is_wrong_again)
{
    replay_all(false);
}
END_TEST

START_TEST(nor_on_an_opencl_device)
{
    replay_all(true);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("regressions");
    TCase *host = tcase_create("host");
    tcase_add_test(host, no_world_that_was_once_wrong_is_wrong_again);
    suite_add_tcase(suite, host);
    TCase *device = tcase_create("device");
    tcase_add_test(device, nor_on_an_opencl_device);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
