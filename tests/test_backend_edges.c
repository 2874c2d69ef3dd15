// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// oclgrind: yes
// Every backend, with every instruction set's lanes, on boxes that sit on the edge of a verdict: a
// comparison that admits what it must not, or a bound that one of them lacks, shows here alone.
#include "backend.h"
#include "box.h"
#include "kit_edge.h"
#include "support.h"

#ifdef OCC_HAVE_OPENCL
#include <occlude/opencl.h>
#endif

#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 300, RANGES = 24, LISTED = 6, SHADOWS = RANGES * LISTED, MOST_LANES = 8 };

// --- a frame made up -----------------------------------------------------------------------------

typedef struct world {
    occ_scene *scene;
    occ_eye eye;
    occ_shadow shadows[SHADOWS];
    occ_range ranges[RANGES];
    uint32_t candidates[SHADOWS];
    occ_verdict expected[RANGES];
    unsigned ties; // verdicts that "not less" in the place of "greater" would turn
} world;

static occ_relative_box row_of(const world *w, uint32_t row)
{
    occ_box box = occ_boxes_get(&w->scene->boxes, row);
    return occ_box_relative(&box, &w->eye);
}

static void add_objects(kit_random *random, world *w, float size)
{
    ck_assert_int_eq(occ_scene_create(NULL, &w->scene), OCC_SUCCESS);
    for (int i = 0; i < OBJECTS; i++) {
        occ_relative_box from = edge_box(random, size, 0.0f);
        occ_box box;
        memcpy(box.center, from.t, sizeof box.center);
        memcpy(box.axis, from.a, sizeof box.axis);
        occ_object object;
        ck_assert_int_eq(occ_scene_add(w->scene, &box, &object), OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(w->scene), OCC_SUCCESS);
}

static void make_world(kit_random *random, world *w)
{
    static const float sizes[] = {1.0f, 1e13f, 1e-30f, 1e-38f, 1e3f, 1e7f};
    float size = sizes[kit_below(random, sizeof sizes / sizeof *sizes)];
    *w = (world){.scene = NULL};
    add_objects(random, w, size);
    w->eye = edge_eye(random, size);
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        occ_relative_box edge = row_of(w, kit_below(random, OBJECTS));
        edge_plane(random, &edge, size, w->eye.plane[p]);
    }
    for (uint32_t r = 0; r < RANGES; r++) {
        occ_range *range = &w->ranges[r];
        range->first = kit_below(random, OBJECTS - OCC_RANGE_OBJECTS + 1);
        range->count = 1 + kit_below(random, OCC_RANGE_OBJECTS);
        range->candidates = r * LISTED;
        range->candidate_count = kit_below(random, LISTED + 1);
        range->frustum = 1u << kit_below(random, 2 * OCC_FRUSTUM_PLANES) & 0x3fu;
        for (uint32_t c = r * LISTED; c < (r + 1) * LISTED; c++) {
            occ_relative_box edge = row_of(w, range->first + kit_below(random, range->count));
            w->candidates[c] = SHADOWS - 1 - c;
            edge_shadow(random, &edge, size, OBJECTS, &w->shadows[SHADOWS - 1 - c]);
        }
    }
}

// --- what it comes to ----------------------------------------------------------------------------

// How far all of a box is inside of a plane, and how far at most. All rounding is as the verdicts
// have it; the comparisons are written out here.
static float depth_of(const occ_relative_box *box, const float n[4], float *most)
{
    float s = OCC_PLANE_AT(n[0], n[1], n[2], n[3], box->t[0], box->t[1], box->t[2]);
    float r = occ_box_reach(box, n[0], n[1], n[2]);
    *most = s + r;
    return s - r;
}

static bool is_outside(world *w, const occ_relative_box *box, uint32_t planes)
{
    bool outside = false, tie = false;
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        float most;
        if (!(planes >> p & 1u)) continue;
        (void)depth_of(box, w->eye.plane[p], &most);
        outside = outside || most < -box->e;
        tie = tie || most == -box->e;
    }
    w->ties += tie && !outside;
    return outside;
}

static bool is_inside(world *w, const occ_relative_box *box, const occ_shadow *shadow)
{
    bool inside = true, almost = true;
    for (uint32_t p = 0; p < shadow->planes; p++) {
        float most, least = depth_of(box, shadow->plane[p], &most);
        inside = inside && least > box->e;
        almost = almost && least >= box->e;
    }
    w->ties += almost && !inside;
    return inside;
}

static uint32_t verdict_on(world *w, const occ_range *range, uint32_t row)
{
    occ_relative_box box = row_of(w, row);
    if (is_outside(w, &box, range->frustum)) return OCC_OUTSIDE;
    for (uint32_t c = 0; c < range->candidate_count; c++) {
        const occ_shadow *shadow = &w->shadows[w->candidates[range->candidates + c]];
        if (shadow->owner != row && is_inside(w, &box, shadow)) return OCC_HIDDEN;
    }
    return OCC_VISIBLE;
}

static void decide(world *w, unsigned counts[3])
{
    for (uint32_t r = 0; r < RANGES; r++) {
        for (uint32_t i = 0; i < w->ranges[r].count; i++) {
            uint32_t verdict = verdict_on(w, &w->ranges[r], w->ranges[r].first + i);
            uint32_t bit = 1u << i % 32;
            if (verdict == OCC_VISIBLE) w->expected[r].visible[i / 32] |= bit;
            if (verdict == OCC_OUTSIDE) w->expected[r].outside[i / 32] |= bit;
            counts[verdict]++;
        }
    }
}

// --- the backends --------------------------------------------------------------------------------

static occ_hooks hooks;

static void begin(void)
{
    static const occ_allocator heap;
    static const occ_logger silence;
    ck_assert_int_eq(occ_hooks_init(&hooks, &heap, &silence), OCC_SUCCESS);
}

static void check_backend(occ_tester *backend, world *w, const char *lanes)
{
    static occ_wide_shadow wide[SHADOWS];
    static const occ_rect_block rects[SHADOWS / OCC_SHADOW_LANES]; // fusion alone reads them
    static const occ_screen screen;
    for (uint32_t i = 0; i < SHADOWS; i++)
        occ_wide_shadow_set(&wide[i], &w->shadows[i]);
    const occ_shadow_set set = {w->shadows, wide, rects, SHADOWS};
    occ_verdict verdicts[RANGES];
    memset(verdicts, 0x5a, sizeof verdicts);
    occ_test_job job = {.scene = w->scene,
                        .eye = &w->eye,
                        .screen = &screen,
                        .set = &set,
                        .ranges = w->ranges,
                        .range_count = RANGES,
                        .candidates = w->candidates,
                        .candidate_count = SHADOWS,
                        .verdicts = verdicts};
    ck_assert_int_eq(backend->ops->upload(backend, w->scene), OCC_SUCCESS);
    ck_assert_int_eq(backend->ops->test(backend, &job), OCC_SUCCESS);
    ck_assert_int_eq(backend->ops->read(backend, &job), OCC_SUCCESS);
    for (uint32_t r = 0; r < RANGES; r++)
        ck_assert_msg(kit_same_bits(&verdicts[r], &w->expected[r], sizeof *verdicts),
                      "%s %s: range %u is decided otherwise", backend->ops->name, lanes, r);
}

static void check_worlds(uint64_t seed, unsigned rounds, occ_tester **backends, const char **lanes,
                         unsigned backend_count)
{
    kit_random random = {seed};
    unsigned counts[3] = {0, 0, 0}, ties = 0;
    for (unsigned i = 0; i < rounds; i++) {
        static world w;
        make_world(&random, &w);
        decide(&w, counts);
        ties += w.ties;
        for (unsigned b = 0; b < backend_count; b++)
            check_backend(backends[b], &w, lanes[b]);
        occ_scene_destroy(w.scene);
    }
    for (int i = 0; i < 3; i++)
        ck_assert_uint_gt(counts[i], 10 * rounds);
    ck_assert_uint_gt(ties, rounds / 2);
    for (unsigned b = 0; b < backend_count; b++)
        backends[b]->ops->destroy(backends[b]);
}

START_TEST(no_backend_of_the_host_takes_an_edge_for_inside)
{
    occ_tester *backends[MOST_LANES + 1];
    const char *names[MOST_LANES + 1] = {"one by one"};
    unsigned count = 1;
    ck_assert_int_eq(occ_backend_plain_create(&hooks, &backends[0]), OCC_SUCCESS);
    for (; count <= MOST_LANES && occ_lanes_get(count - 1); count++) {
        const occ_lanes *lanes = occ_lanes_get(count - 1);
        names[count] = lanes->name;
        ck_assert_int_eq(occ_backend_openmp_create(&hooks, 2, lanes, &backends[count]),
                         OCC_SUCCESS);
    }
    check_worlds(1, 400 / OCC_TEST_SLOWNESS, backends, names, count);
}
END_TEST

START_TEST(no_device_takes_an_edge_for_inside)
{
#ifdef OCC_HAVE_OPENCL
    int skip = test_skip_without_device();
    ck_assert_int_ne(skip, EXIT_FAILURE); // CI must have one
    if (skip) return;
    occ_tester *backends[2];
    const char *names[2] = {"on a device", "by ranges on a device"};
    const occ_cl_shape shapes[2] = {OCC_CL_SHAPE_WIDE, OCC_CL_SHAPE_NARROW};
    // oclgrind interprets the kernel, and its watch over what is uninitialised trips over vectors
    const char *slow = getenv("OCLGRIND_UNINITIALIZED");
    unsigned rounds = slow ? 3 : 100 / OCC_TEST_SLOWNESS, count = slow ? 1 : 2;
    for (unsigned i = 0; i < count; i++) {
        occ_cl_desc desc = {.shape = shapes[i]};
        ck_assert_int_eq(occ_backend_opencl_create(&hooks, &desc, &backends[i]), OCC_SUCCESS);
    }
    check_worlds(2, rounds, backends, names, count);
#endif
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("backend_edges");
    TCase *host = tcase_create("host");
    tcase_add_checked_fixture(host, begin, NULL);
    tcase_add_test(host, no_backend_of_the_host_takes_an_edge_for_inside);
    suite_add_tcase(suite, host);
    TCase *device = tcase_create("device");
    tcase_add_checked_fixture(device, begin, NULL);
    tcase_add_test(device, no_device_takes_an_edge_for_inside);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
