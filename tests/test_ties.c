// SPDX-License-Identifier: Apache-2.0
// labels: property
// The order in which objects and occluders were added, where many are alike.
#include "mini_check.h"
#include "support.h"

static const occ_cull_desc pairwise = {.method = OCC_METHOD_PAIRWISE};

// What `single` sees of a mini world, one bit for each object.
static uint64_t bits_of(const mini *m, occ_view *view, const occ_cull_desc *knobs)
{
    occ_camera_desc camera = mini_view_of(m);
    uint64_t bits = 0;
    occ_scene *scene = world_scene(m->objects, m->object_count, m->occluders, m->occluder_count, 2);
    if (!occ_cull(view, scene, &camera, knobs))
        for (uint32_t i = 0; i < m->object_count; i++)
            bits |= (uint64_t)world_sees(view, i) << i;
    occ_scene_destroy(scene);
    return bits;
}

// The occluders in the opposite order.
static mini reversed(const mini *m)
{
    mini other = *m;
    for (uint32_t k = 0; k < m->occluder_count; k++)
        other.occluders[k] = m->occluders[m->occluder_count - 1 - k];
    return other;
}

// The objects in the opposite order; bit i of the first is bit count - 1 - i of the other.
static mini objects_reversed(const mini *m)
{
    mini other = *m;
    for (uint32_t i = 0; i < m->object_count; i++)
        other.objects[i] = m->objects[m->object_count - 1 - i];
    for (uint32_t k = 0; k < m->occluder_count; k++)
        if (m->occluders[k].owner >= 0)
            other.occluders[k].owner = (int)m->object_count - 1 - m->occluders[k].owner;
    return other;
}

static uint64_t turned_round(uint64_t bits, uint32_t count)
{
    uint64_t turned = 0;
    for (uint32_t i = 0; i < count; i++)
        turned |= (bits >> i & 1u) << (count - 1 - i);
    return turned;
}

// Two tilted sheets whose bounds hold the eye are equally near. Each belongs to one of two boxes
// that are alike, so that these boxes' numbers say which is taken first. The larger hides the
// smaller, but belongs to a box that only the smaller may hide. So it matters to `single` whether
// the smaller was taken before the larger could hide it; it may miss the box, and pairs do not.
START_TEST(single_may_miss_more_or_less_with_the_owners_of_equally_near_occluders_exchanged)
{
    static const occ_box large = {{0, 0, -10}, {{12, 0, 12}, {0, 8, 0}, {0, 0, 0}}};
    static const occ_box small = {{3.5f, 0, -9.5f}, {{9.5f, 0, 10.5f}, {0, 4, 0}, {0, 0, 0}}};
    static const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    const occ_box objects[2] = {kit_cube(0, 0, -40, 1), kit_cube(0, 0, -40, 1)};
    occ_camera_desc camera = kit_look(eye, target);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    for (int owner = 0; owner < 2; owner++) { // of the larger
        const world_occluder occluders[2] = {{large, owner}, {small, !owner}};
        occ_scene *scene = world_scene(objects, 2, occluders, 2, 0);
        kit_cull(view, scene, &camera, &pairwise);
        ck_assert(!world_sees(view, 0) && !world_sees(view, 1));
        kit_cull(view, scene, &camera, NULL);
        ck_assert(!world_sees(view, (uint32_t)!owner));
        ck_assert_int_eq(world_sees(view, (uint32_t)owner), owner == 1);
        occ_scene_destroy(scene);
    }
    occ_view_destroy(view);
}
END_TEST

// What `single` makes of a world told in another order may differ, seldom, and is right.
static bool differs(const mini *told, uint64_t seen, uint64_t expected, mini_views *views,
                    uint32_t world)
{
    mini_fault fault;
    if (seen == expected) return false;
    KIT_CHECK(!mini_breaks(told, views, &fault), "world %u: %s", world, fault.text);
    return true;
}

// Most numbers of mini worlds are small and whole, so that many occluders are equally near.
START_TEST(an_order_matters_to_nothing_else)
{
    mini_views views = mini_open_views(false);
    occ_cull_desc single = world_knobs(OCC_METHOD_SINGLE);
    uint32_t worlds = WORLD_SHARE(10000), differ = 0;
    single.grain = 1;
    for (uint32_t n = 0; n < worlds; n++) {
        mini m, other, renumbered;
        mini_make(&m, 7000000000u + n);
        other = reversed(&m);
        renumbered = objects_reversed(&m);
        uint32_t count = m.object_count;
        uint64_t seen = bits_of(&m, views.view[0], &single);
        uint64_t pairs = bits_of(&m, views.view[0], &pairwise);
        KIT_CHECK(bits_of(&other, views.view[0], &pairwise) == pairs &&
                      turned_round(bits_of(&renumbered, views.view[0], &pairwise), count) == pairs,
                  "world %u: pairwise depends on an order", n);
        differ += differs(&other, bits_of(&other, views.view[0], &single), seen, &views, n);
        differ +=
            differs(&renumbered, turned_round(bits_of(&renumbered, views.view[0], &single), count),
                    seen, &views, n);
    }
    ck_assert_msg(differ <= worlds / 1000, "%u of %u worlds differ", differ, worlds);
    mini_close_views(&views);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ties");
    TCase *order = tcase_create("order");
    tcase_add_test(
        order, single_may_miss_more_or_less_with_the_owners_of_equally_near_occluders_exchanged);
    tcase_add_test(order, an_order_matters_to_nothing_else);
    suite_add_tcase(suite, order);
    return test_run_suite(suite);
}
