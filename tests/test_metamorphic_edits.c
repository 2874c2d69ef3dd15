// SPDX-License-Identifier: Apache-2.0
// labels: property
// timeout: 120
// Large scenes with a little more or less in them: what may then appear, and what may vanish.
#include "meta.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

enum { SCENES = 5, EDITED = 64 };

static const char *const names[SCENES] = {"city", "forest", "soup", "seedscene", "interior"};

static const occ_cull_desc by_pairs = {.method = OCC_METHOD_PAIRWISE};

// Nothing is seen in `more` that is not in `less`; returns what is seen in `less` alone.
static uint32_t none_appears(const bool *less, const bool *more, uint32_t count, const char *what)
{
    uint32_t gone = 0;
    for (uint32_t i = 0; i < count; i++) {
        KIT_CHECK(less[i] || !more[i], "%s: object %u is seen again", what, i);
        gone += less[i] && !more[i];
    }
    return gone;
}

static void is_same(const bool *a, const bool *b, uint32_t count, const char *what)
{
    for (uint32_t i = 0; i < count; i++)
        KIT_CHECK(a[i] == b[i], "%s: object %u", what, i);
}

// --- occluders -----------------------------------------------------------------------------------

// A scene whose last EDITED occluders, in a random order, are still to come.
typedef struct growth {
    meta m;
    occ_scene *scene;
    occ_occluder added[EDITED];
    bool *seen[META_CAMERAS];
    occ_view *view;
} growth;

static growth begin_growth(int number)
{
    growth g = {.m = meta_scene(names[number], 800, 5)};
    uint32_t *order = meta_order(g.m.occluder_count, 11);
    meta shuffled = meta_occluders_in_order(&g.m, order);
    free(order);
    meta_free(&g.m);
    g.m = shuffled;
    ck_assert_uint_gt(g.m.occluder_count, 2 * EDITED);
    meta less = g.m;
    less.occluder_count -= EDITED;
    g.scene = meta_build(&less);
    g.view = world_view(OCC_BACKEND_OPENMP, 2);
    for (uint32_t c = 0; c < META_CAMERAS; c++)
        g.seen[c] = meta_seen(g.view, g.scene, &g.m, c, &by_pairs);
    return g;
}

// All cameras once more, after an edit. With what was seen before: what one more occluder does.
static uint32_t look_again(growth *g, bool grown)
{
    uint32_t changed = 0;
    ck_assert_int_eq(occ_scene_commit(g->scene), OCC_SUCCESS);
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        bool *now = meta_seen(g->view, g->scene, &g->m, c, &by_pairs);
        uint32_t count = g->m.object_count;
        changed += grown ? none_appears(g->seen[c], now, count, "one occluder more")
                         : none_appears(now, g->seen[c], count, "one occluder less");
        free(g->seen[c]);
        g->seen[c] = now;
    }
    return changed;
}

// The whole scene, made from nothing, gives the same.
static void compare_with_fresh(const growth *g, uint32_t occluders)
{
    meta part = g->m;
    part.occluder_count = occluders;
    occ_scene *fresh = meta_build(&part);
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        bool *seen = meta_seen(g->view, fresh, &part, c, &by_pairs);
        is_same(g->seen[c], seen, part.object_count, "made from nothing");
        free(seen);
    }
    occ_scene_destroy(fresh);
}

static void end_growth(growth *g)
{
    for (uint32_t c = 0; c < META_CAMERAS; c++)
        free(g->seen[c]);
    occ_view_destroy(g->view);
    occ_scene_destroy(g->scene);
    meta_free(&g->m);
}

START_TEST(one_occluder_more_shows_nothing_and_one_less_hides_nothing)
{
    growth g = begin_growth(_i);
    uint32_t gone = 0, come = 0, first = g.m.occluder_count - EDITED;
    for (uint32_t k = 0; k < EDITED; k++) {
        const world_occluder *occluder = &g.m.occluders[first + k];
        occ_object owner = {(uint32_t)occluder->owner + 1u, 1};
        ck_assert(occ_scene_contains(g.scene, owner));
        ck_assert_int_eq(occ_scene_add_occluder(g.scene, &occluder->box, owner, &g.added[k]),
                         OCC_SUCCESS);
        gone += look_again(&g, true);
    }
    compare_with_fresh(&g, g.m.occluder_count);
    for (uint32_t k = EDITED; k-- > 0;) {
        ck_assert_int_eq(occ_scene_remove_occluder(g.scene, g.added[k]), OCC_SUCCESS);
        come += look_again(&g, false);
    }
    compare_with_fresh(&g, first);
    ck_assert_uint_eq(gone, come);
    ck_assert_uint_gt(gone, 0);
    end_growth(&g);
}
END_TEST

START_TEST(more_occluders_allowed_show_nothing_and_hide_nothing_that_is_seen)
{
    meta m = meta_scene(names[_i], WORLD_SHARE(4000), 6);
    occ_scene *scene = meta_build(&m);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    uint32_t changed = 0;
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        occ_cull_desc knobs = {.min_area = 1e-30f, .max_occluders = 1};
        bool *before = meta_seen(view, scene, &m, c, &knobs);
        for (knobs.max_occluders = 2; knobs.max_occluders <= 2048; knobs.max_occluders *= 2) {
            bool *now = meta_seen(view, scene, &m, c, &knobs);
            changed += none_appears(before, now, m.object_count, "more occluders");
            if (knobs.max_occluders == 64 || knobs.max_occluders == 2048)
                meta_compare(&m, c, now, now, 500);
            free(before);
            before = now;
        }
        free(before);
    }
    ck_assert_uint_gt(changed, 0);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    meta_free(&m);
}
END_TEST

// --- objects -------------------------------------------------------------------------------------

// Every object a second time, as one that owns nothing.
static meta with_twins(const meta *m)
{
    meta twins = meta_copy(m);
    twins.object_count = 2 * m->object_count;
    twins.objects = realloc(twins.objects, twins.object_count * sizeof *twins.objects);
    ck_assert_ptr_nonnull(twins.objects);
    memcpy(twins.objects + m->object_count, m->objects, m->object_count * sizeof *m->objects);
    return twins;
}

START_TEST(a_twin_is_seen_with_its_twin_unless_that_hides_it)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_FUSED, OCC_METHOD_PAIRWISE,
                                         OCC_METHOD_FRUSTUM};
    for (int n = 0; n < 4; n++) {
        bool small = methods[n] == OCC_METHOD_PAIRWISE;
        meta m = meta_scene(names[_i], small ? 600 : WORLD_SHARE(3000), 7);
        meta twins = with_twins(&m);
        bool *owns = calloc(m.object_count + 1u, sizeof *owns);
        ck_assert_ptr_nonnull(owns);
        for (uint32_t k = 0; k < m.occluder_count; k++)
            owns[m.occluders[k].owner] = true;
        occ_scene *scene = meta_build(&twins);
        occ_view *view = world_view(OCC_BACKEND_OPENMP, 2);
        occ_cull_desc knobs = {.method = methods[n]};
        for (uint32_t c = 0; c < META_CAMERAS; c++) {
            bool *seen = meta_seen(view, scene, &twins, c, &knobs), *other = seen + m.object_count;
            none_appears(seen, other, m.object_count, "a twin");
            for (uint32_t i = 0; i < m.object_count; i++)
                KIT_CHECK(owns[i] || seen[i] == other[i], "the twin of object %u", i);
            free(seen);
        }
        occ_view_destroy(view);
        occ_scene_destroy(scene);
        free(owns);
        meta_free(&twins);
        meta_free(&m);
    }
}
END_TEST

// With the same middle and half of each axis, what a plane has to prove is less: s - r > e where r
// is half of what it was, to the last bit, and e no larger.
START_TEST(a_hidden_object_at_half_its_size_stays_hidden)
{
    meta m = meta_scene(names[_i], 700, 8), half = meta_copy(&m);
    for (uint32_t i = 0; i < m.object_count; i++)
        for (int k = 0; k < 9; k++)
            half.objects[i].axis[k / 3][k % 3] *= 0.5f;
    occ_scene *scenes[2] = {meta_build(&m), meta_build(&half)};
    occ_view *view = world_view(OCC_BACKEND_OPENMP, 2);
    uint32_t left_out = 0;
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        bool *whole = meta_seen(view, scenes[0], &m, c, &by_pairs);
        bool *small = meta_seen(view, scenes[1], &half, c, &by_pairs);
        none_appears(whole, small, m.object_count, "half as large");
        left_out += m.object_count - meta_count(whole, m.object_count);
        free(whole);
        free(small);
    }
    ck_assert_uint_gt(left_out, m.object_count);
    occ_view_destroy(view);
    for (int i = 0; i < 2; i++)
        occ_scene_destroy(scenes[i]);
    meta_free(&m);
    meta_free(&half);
}
END_TEST

// --- edits that come to nothing ------------------------------------------------------------------

static void move_all(occ_scene *scene, const meta *m, float by)
{
    for (uint32_t i = 0; i < m->object_count; i++) {
        occ_box box = m->objects[i];
        box.center[1] += by;
        KIT_CHECK(!occ_scene_move(scene, (occ_object){i + 1, 1}, &box), "object %u", i);
    }
    for (uint32_t k = 0; k < m->occluder_count; k++) {
        occ_box box = m->occluders[k].box;
        box.center[1] += by;
        KIT_CHECK(!occ_scene_move_occluder(scene, (occ_occluder){k + 1, 1}, &box), "%u", k);
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

// The same content, added a few at a time with a commit after each.
static occ_scene *build_bit_by_bit(const meta *m)
{
    occ_scene *scene = NULL;
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    uint32_t step = m->object_count / 7 + 1;
    for (uint32_t i = 0; i < m->object_count; i += step) {
        uint32_t count = m->object_count - i < step ? m->object_count - i : step;
        ck_assert_int_eq(occ_scene_add_many(scene, m->objects + i, count, NULL), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    }
    for (uint32_t k = 0; k < m->occluder_count; k++) {
        occ_object owner = {(uint32_t)m->occluders[k].owner + 1, 1};
        KIT_CHECK(!occ_scene_add_occluder(scene, &m->occluders[k].box, owner, NULL), "%u", k);
        if (k % (m->occluder_count / 5 + 1) == 0)
            ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    return scene;
}

START_TEST(built_in_parts_or_moved_away_and_back_it_is_the_same_scene)
{
    static const occ_cull_desc knobs = {.method = OCC_METHOD_SINGLE};
    meta m = meta_scene(names[_i], WORLD_SHARE(4000), 9);
    occ_scene *scene = meta_build(&m), *parts = build_bit_by_bit(&m);
    occ_view *view = world_view(OCC_BACKEND_OPENMP, 2);
    bool *before[META_CAMERAS];
    for (uint32_t c = 0; c < META_CAMERAS; c++)
        before[c] = meta_seen(view, scene, &m, c, &knobs);
    move_all(scene, &m, 1e7f);
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        bool *away = meta_seen(view, scene, &m, c, &knobs);
        ck_assert_uint_eq(meta_count(away, m.object_count), 0);
        free(away);
    }
    move_all(scene, &m, 0.0f);
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        bool *back = meta_seen(view, scene, &m, c, &knobs);
        bool *built = meta_seen(view, parts, &m, c, &knobs);
        is_same(before[c], back, m.object_count, "away and back");
        is_same(before[c], built, m.object_count, "built in parts");
        ck_assert_uint_gt(meta_count(back, m.object_count), 0);
        free(back);
        free(built);
        free(before[c]);
    }
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    occ_scene_destroy(parts);
    meta_free(&m);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("metamorphic edits");
    TCase *occluders = tcase_create("occluders");
    tcase_add_loop_test(occluders, one_occluder_more_shows_nothing_and_one_less_hides_nothing, 0,
                        SCENES);
    tcase_add_loop_test(
        occluders, more_occluders_allowed_show_nothing_and_hide_nothing_that_is_seen, 0, SCENES);
    suite_add_tcase(suite, occluders);
    TCase *objects = tcase_create("objects");
    tcase_add_loop_test(objects, a_twin_is_seen_with_its_twin_unless_that_hides_it, 0, SCENES);
    tcase_add_loop_test(objects, a_hidden_object_at_half_its_size_stays_hidden, 0, SCENES);
    tcase_add_loop_test(objects, built_in_parts_or_moved_away_and_back_it_is_the_same_scene, 0,
                        SCENES);
    suite_add_tcase(suite, objects);
    return test_run_suite(suite);
}
