// SPDX-License-Identifier: Apache-2.0
// labels: property
// timeout: 120
// Mini worlds of every kind, on every method and backend, against the exact judges. A world that
// fails is shrunk, and written where the message says.
//
// OCC_PROPERTY_SEED=<number> makes other worlds, OCC_PROPERTY_WORLDS=<number> so many of them.
#define _POSIX_C_SOURCE 200809L

#include "mini_check.h"
#include "mini_shrink.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>

static uint64_t setting(const char *name, uint64_t otherwise)
{
    const char *value = getenv(name);
    return value && value[0] ? strtoull(value, NULL, 10) : otherwise;
}

static bool still_breaks(const mini *m, void *context)
{
    return mini_breaks(m, context, NULL);
}

// Whether the file shows the fault, with the eye given or derived.
static bool file_breaks(const char *path, mini_views *views)
{
    mini m;
    uint32_t frames;
    if (!mini_read(&m, path, 0, &frames)) return false;
    bool broken = mini_breaks(&m, views, NULL);
    m.camera.eye_given = true;
    return broken || mini_breaks(&m, views, NULL);
}

// Shrinks, keeps and tells.
static void report(mini *m, uint64_t seed, mini_views *views, const char *fault)
{
    char path[512], remark[200] = "";
    unsigned long long number = seed;
    unsigned asked = mini_shrink(m, still_breaks, views);
    mini_fault small;
    mini_breaks(m, views, &small);
    snprintf(path, sizeof path, OCC_TEST_OUT "/property_%llu.txt", number);
    bool kept = mini_write_text(m, path);
    const char *lost = mini_shrink_for_file(m, still_breaks, views);
    snprintf(path, sizeof path, OCC_TEST_OUT "/property_%llu.obs", number);
    mini_embody(m);
    if (!kept || !mini_write(m, path)) snprintf(remark, sizeof remark, " (could not be written)");
    if (lost || !file_breaks(path, views))
        snprintf(remark, sizeof remark,
                 " (does not show it: a scene file cannot hold %s; all numbers are in the .txt)",
                 lost ? lost : "this");
    ck_abort_msg("world %llu: %s.\nShrunk in %u tries to %u objects and %u occluders: %s.\n"
                 "It is in %s%s.\nTo have it tested for ever: cp it to "
                 "tests/regressions/<what was wrong>.obs",
                 number, fault, asked, m->object_count, m->occluder_count, small.text, path,
                 remark);
}

static void try_worlds(mini_views *views, uint64_t worlds)
{
    uint64_t seed = setting("OCC_PROPERTY_SEED", 1) * 1000000000;
    worlds = setting("OCC_PROPERTY_WORLDS", worlds);
    for (uint64_t i = 0; i < worlds; i++) {
        mini m;
        mini_fault fault;
        mini_make(&m, seed + i);
        if (mini_breaks(&m, views, &fault)) report(&m, seed + i, views, fault.text);
    }
}

// Worlds in which nothing is hidden would prove nothing.
static void demand_substance(const mini_views *views)
{
    uint64_t objects = views->count.objects;
    printf("%llu worlds, %llu verdicts: %llu outside, %llu hidden, %llu culls refused\n",
           (unsigned long long)views->count.worlds, (unsigned long long)objects,
           (unsigned long long)views->count.outside, (unsigned long long)views->count.hidden,
           (unsigned long long)views->count.refused);
    ck_assert_uint_gt(views->count.hidden, objects / 100 * 5);
    ck_assert_uint_gt(views->count.outside, objects / 100 * 5);
    ck_assert_uint_lt(views->count.refused, views->count.worlds / 20);
}

START_TEST(no_small_world_has_a_seen_object_left_out)
{
    mini_views views = mini_open_views(false);
    try_worlds(&views, WORLD_SHARE(60000));
    demand_substance(&views);
    mini_close_views(&views);
}
END_TEST

START_TEST(an_opencl_device_leaves_out_the_same)
{
    mini_views views = mini_open_views(true);
    if (views.view[2]) try_worlds(&views, WORLD_SHARE(10000));
    mini_close_views(&views);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("property");
    TCase *host = tcase_create("host");
    tcase_add_test(host, no_small_world_has_a_seen_object_left_out);
    suite_add_tcase(suite, host);
    TCase *device = tcase_create("device");
    tcase_add_test(device, an_opencl_device_leaves_out_the_same);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
