// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// What the walk asks the lanes about a box and the occluders so far, in every instruction set,
// against scalar C: on the edges of verdicts, and on the shadows of real occluders.
#include "crowds.h"
#include "kit_edge.h"
#include "kit_set.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>

enum { ROUNDS = 12000 / OCC_TEST_SLOWNESS, WORLDS = 1500 / OCC_TEST_SLOWNESS, ROWS = 200 };

// --- scalar C ------------------------------------------------------------------------------------

static bool is_own(const occ_question *q, const occ_shadow *shadow)
{
    return shadow->owner >= q->first && shadow->owner - q->first < q->rows;
}

static bool is_held(const occ_question *q, const occ_shadow_set *set, float x, float y, float z)
{
    for (uint32_t i = 0; i < set->count; i++) {
        const occ_shadow *shadow = &set->shadows[i];
        if (!is_own(q, shadow) && occ_shadow_holds_point(shadow, x, y, z, q->box->e)) return true;
    }
    return false;
}

// Whether the center or a corner is in the picture, and in no shadow.
static bool shows(const occ_question *q, const occ_shadow_set *set, const occ_eye *eye)
{
    const float *t = q->box->t;
    if (occ_point_in_frustum(t[0], t[1], t[2], eye, q->frustum) &&
        !is_held(q, set, t[0], t[1], t[2]))
        return true;
    for (uint32_t k = 0; k < 8; k++) {
        float x, y, z;
        occ_box_corner(q->box, k, &x, &y, &z);
        if (occ_point_in_frustum(x, y, z, eye, q->frustum) && !is_held(q, set, x, y, z))
            return true;
    }
    return false;
}

// Whether the outline is covered by what the box is wholly behind: those listed.
static bool is_covered(const occ_question *q, const uint32_t *list, uint32_t count,
                       const occ_shadow_set *set, const occ_eye *eye)
{
    const uint32_t any_row = OCC_NOBODY - 1u;
    occ_fusion fusion;
    occ_outline outline;
    if (!occ_outline_set(&outline, q->box, eye, 0)) return false;
    fusion.depth = occ_outline_pieces(&outline, q->box, fusion.stack);
    return fusion.depth && occ_fusion_covers(&fusion, q->box, eye, q->frustum, set->shadows, list,
                                             count, any_row, 0);
}

typedef enum said { SHOWN, ALONE, TOGETHER, UNKNOWN } said;

static said hide_plainly(const occ_question *q, const occ_shadow_set *set, const occ_eye *eye)
{
    uint32_t list[KIT_SET_MOST], count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        kit_contact met = kit_contact_of(q->box, &set->shadows[i]);
        if (met.apart || is_own(q, &set->shadows[i])) continue;
        if (met.inside) return ALONE;
        list[count++] = i;
    }
    if (!q->fuse || shows(q, set, eye)) return SHOWN;
    if (!is_covered(q, list, count, set, eye)) return SHOWN;
    return count ? TOGETHER : UNKNOWN; // beside the picture there is nothing to hide
}

// Those that touch the box; or true, where one of them holds it.
static bool gather_plainly(const occ_question *q, const occ_shadow_set *set, uint32_t *list,
                           uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        kit_contact met = kit_contact_of(q->box, &set->shadows[i]);
        bool before = !(set->rects[i / OCC_SHADOW_LANES].key[i % OCC_SHADOW_LANES] > q->key);
        if (met.apart || !before) continue;
        if (met.inside && !is_own(q, &set->shadows[i])) return true;
        list[(*count)++] = i;
    }
    return false;
}

// --- every instruction set -----------------------------------------------------------------------

// What a question is asked with.
typedef struct asked {
    occ_question question;
    occ_shadow_set set;
    const occ_eye *eye;
    const occ_screen *screen;
} asked;

static bool hide_all(const asked *a, uint32_t hint)
{
    bool first = false;
    for (uint32_t v = 0; occ_lanes_get(v); v++) {
        occ_projection seen;
        occ_question question = a->question;
        uint32_t corner = hint;
        question.seen = &seen;
        question.hint = &corner;
        bool hidden = occ_lanes_get(v)->hide(&question, &a->set, a->eye, a->screen);
        if (!v) first = hidden;
        KIT_CHECK(hidden == first, "%s: hidden %d", occ_lanes_get(v)->name, hidden);
    }
    return first;
}

static bool gather_all(const asked *a, uint32_t *list, uint32_t *count)
{
    bool first = false;
    for (uint32_t v = 0; occ_lanes_get(v); v++) {
        occ_projection seen;
        occ_question question = a->question;
        uint32_t other[KIT_SET_MOST + 1], others = 0;
        question.seen = &seen;
        occ_lanes_get(v)->project(a->screen, question.box, &seen);
        bool hidden =
            occ_lanes_get(v)->gather(&question, &a->set, v ? other : list, v ? &others : count);
        if (!v) first = hidden;
        bool same = hidden == first && (!v || hidden || others == *count);
        for (uint32_t i = 0; v && same && !hidden && i < others; i++)
            same = other[i] == list[i];
        KIT_CHECK(same, "%s: another list", occ_lanes_get(v)->name);
    }
    return first;
}

typedef struct tally {
    unsigned asked, alone, together, gathered, dropped, inner;
} tally;

// Both answers, where nothing is known of where the shadows are on the screen.
static void check_answers(const asked *a, uint32_t hint, tally *sum)
{
    uint32_t list[KIT_SET_MOST + 1], plain[KIT_SET_MOST + 1], count = 0, plain_count = 0;
    said expected = hide_plainly(&a->question, &a->set, a->eye);
    bool hidden = hide_all(a, hint);
    KIT_CHECK(expected == UNKNOWN || hidden == (expected != SHOWN), "hidden %d, where C says %d",
              hidden, expected);
    bool held = gather_plainly(&a->question, &a->set, plain, &plain_count);
    KIT_CHECK(gather_all(a, list, &count) == held, "gather: hidden %d in C", held);
    KIT_CHECK(held || count == plain_count, "%u gathered, %u in C", count, plain_count);
    for (uint32_t i = 0; i < count && !held; i++)
        KIT_CHECK(list[i] == plain[i], "gathered %u, %u in C", list[i], plain[i]);
    sum->asked++;
    sum->alone += expected == ALONE;
    sum->together += expected == TOGETHER;
    sum->gathered += !held && count > 0;
}

// --- on the edges of verdicts --------------------------------------------------------------------

static void set_upright(occ_relative_box *box)
{
    for (int k = 0; k < 9; k++)
        box->a[k] = k % 4 ? 0.0f : fabsf(box->a[k]);
    box->e = occ_box_slack(box, 0x1p-80f);
}

static void set_numbers(kit_random *random, occ_screen *screen)
{
    for (int r = 0; r < 9; r++)
        screen->row[r / 3][r % 3] = kit_between(random, -1, 1);
    screen->w = kit_below(random, 2) ? 0.0f : kit_between(random, 0, 1);
    screen->least = 3.0f * 0x1p-8f;
}

static float any_bound(kit_random *random)
{
    uint32_t what = kit_below(random, 16);
    return what == 0 ? NAN : what == 1 ? INFINITY : kit_between(random, -1, 1);
}

// Anywhere at all: then nothing is sure but that all say the same.
static void scatter_rects(kit_random *random, kit_set *set)
{
    for (uint32_t i = 0; i < set->count; i++) {
        occ_rect_block *block = &set->rects[i / OCC_SHADOW_LANES];
        uint32_t lane = i % OCC_SHADOW_LANES;
        for (int j = 0; j < 2; j++) {
            block->min[j][lane] = any_bound(random) - 1.0f;
            block->max[j][lane] = any_bound(random) + 1.0f;
        }
        block->key[lane] = kit_between(random, 0, 1);
    }
}

static void ask_on_edges(kit_random *random, bool scattered, tally *sum)
{
    static kit_set set;
    float size = edge_size(random);
    occ_eye eye = edge_eye(random, size);
    occ_screen screen;
    occ_relative_box box = edge_box(random, size, 0x1p-80f);
    asked a = {.eye = &eye, .screen = &screen};
    a.question = (occ_question){.box = &box,
                                .frustum = kit_below(random, 64),
                                .first = kit_below(random, ROWS),
                                .rows = kit_below(random, 3) * kit_below(random, ROWS / 2),
                                .key = kit_between(random, 0, 1),
                                .fuse = kit_below(random, 2),
                                .upright = kit_below(random, 2)};
    if (a.question.upright) set_upright(&box);
    eye.splits = kit_below(random, 60);
    set_numbers(random, &screen);
    for (int p = 0; p < OCC_FRUSTUM_PLANES; p++)
        edge_plane(random, &box, size, eye.plane[p]);
    uint32_t count = kit_below(random, kit_below(random, 4) ? 12 : 101);
    for (set.count = 0; set.count < count;) {
        occ_shadow shadow;
        edge_shadow(random, &box, size, ROWS, &shadow);
        kit_set_add(&set, &shadow);
    }
    if (scattered) scatter_rects(random, &set);
    a.set = kit_set_view(&set);
    if (!scattered) {
        check_answers(&a, kit_below(random, 8), sum);
        return;
    }
    uint32_t list[KIT_SET_MOST + 1];
    if (hide_all(&a, kit_below(random, 8))) {
        KIT_CHECK(hide_plainly(&a.question, &a.set, &eye) != SHOWN, "hidden, where C has it shown");
    }
    sum->gathered += !gather_all(&a, list, &count);
}

START_TEST(every_instruction_set_answers_as_c_does)
{
    kit_random random = {91};
    tally sum = {0};
    for (int i = 0; i < ROUNDS; i++)
        ask_on_edges(&random, false, &sum);
    ck_assert_uint_gt(sum.alone, ROUNDS / 20);
    ck_assert_uint_gt(sum.together, ROUNDS / 200);
    ck_assert_uint_gt(sum.gathered, ROUNDS / 20);
}
END_TEST

START_TEST(nor_does_it_matter_what_is_said_of_the_screen)
{
    kit_random random = {92};
    tally sum = {0};
    for (int i = 0; i < ROUNDS; i++)
        ask_on_edges(&random, true, &sum);
    ck_assert_uint_gt(sum.gathered, ROUNDS / 20);
}
END_TEST

// --- on the shadows of real occluders ------------------------------------------------------------

static occ_relative_box with_bound(occ_relative_box box, const occ_eye *eye)
{
    box.e = occ_box_slack(&box, eye->slack_floor);
    return box;
}

// The bounds of an object, or the object as it is, shrunk or grown.
static occ_relative_box any_box(kit_random *random, const crowd_frame *f, bool upright)
{
    occ_box object = occ_boxes_get(&f->scene->boxes, kit_below(random, f->scene->boxes.count));
    occ_relative_box box = occ_frame_relative(&f->frame, &object);
    float factor = kit_below(random, 2) ? 1.0f : kit_between(random, 0.01f, 2);
    for (int k = 0; k < 9; k++)
        box.a[k] *= factor;
    if (upright) {
        for (int j = 0; j < 3; j++)
            box.a[4 * j] = fabsf(box.a[j]) + fabsf(box.a[3 + j]) + fabsf(box.a[6 + j]);
        set_upright(&box);
    }
    return with_bound(box, &f->frame.camera.constants);
}

// A box in a box.
static occ_relative_box inner_box(kit_random *random, const occ_relative_box *box,
                                  const occ_eye *eye)
{
    occ_relative_box inner = *box;
    for (int k = 0; k < 3; k++) {
        float at = kit_between(random, -0.99f, 0.99f), left = 0.999f * (1.0f - fabsf(at));
        left *= kit_below(random, 2) ? 1.0f : kit_between(random, 0, 1);
        for (int j = 0; j < 3; j++) {
            inner.t[j] += at * box->a[3 * k + j];
            inner.a[3 * k + j] *= left;
        }
    }
    return with_bound(inner, eye);
}

// What was left out holds nothing that is in the box.
static void check_left_out(kit_random *random, const asked *a, const uint32_t *list, uint32_t count,
                           tally *sum)
{
    enum { INNER = 6 };
    occ_relative_box inner[INNER];
    for (int i = 0; i < INNER; i++)
        inner[i] = inner_box(random, a->question.box, a->eye);
    for (uint32_t s = 0, next = 0; s < a->set.count; s++) {
        if (next < count && list[next] == s) {
            next++;
            continue;
        }
        const occ_shadow *shadow = &a->set.shadows[s];
        sum->dropped++;
        for (int i = 0; i < INNER; i++)
            KIT_CHECK(!occ_box_in_shadow(&inner[i], shadow->plane[0], shadow->planes),
                      "shadow %u was left out, and holds a box inside", s);
    }
    sum->inner += INNER;
}

static void ask_in_crowd(kit_random *random, const crowd_frame *f, tally *sum)
{
    const occ_camera *camera = &f->frame.camera;
    asked a = {.eye = &camera->constants, .screen = &camera->screen};
    bool upright = kit_below(random, 2);
    occ_relative_box box = any_box(random, f, upright);
    float h[3];
    for (int j = 0; j < 3; j++)
        h[j] = fabsf(box.a[j]) + fabsf(box.a[3 + j]) + fabsf(box.a[6 + j]);
    a.question = (occ_question){.box = &box,
                                .frustum = camera->planes,
                                .first = kit_below(random, f->scene->boxes.count),
                                .rows = kit_below(random, 3),
                                .key = occ_frame_farness(&f->frame, box.t, h),
                                .fuse = kit_below(random, 4) > 0,
                                .upright = upright};
    a.set = occ_occluders_so_far(&f->frame);
    said expected = hide_plainly(&a.question, &a.set, a.eye);
    bool hidden = hide_all(&a, kit_below(random, 8));
    KIT_CHECK(expected == UNKNOWN || hidden == (expected != SHOWN), "hidden %d, where C says %d",
              hidden, expected);
    uint32_t list[KIT_SET_MOST + 1], plain[KIT_SET_MOST + 1], count = 0, plain_count = 0;
    bool held = gather_plainly(&a.question, &a.set, plain, &plain_count);
    KIT_CHECK(gather_all(&a, list, &count) == held, "gather: hidden %d in C", held);
    if (!held) check_left_out(random, &a, list, count, sum);
    sum->asked++;
    sum->alone += expected == ALONE;
    sum->together += expected == TOGETHER;
    sum->gathered += !held && count > 0;
}

typedef void make_crowd(kit_random *random, crowd *c, uint32_t objects);

START_TEST(where_things_are_on_the_screen_hides_no_answer)
{
    static make_crowd *const makes[] = {crowd_about, crowd_panels, crowd_around};
    static const double tolerances[] = {0.0, 0.0, 0.0, 1e-3, 0.1};
    kit_random random = {(uint64_t)_i + 93};
    tally sum = {0};
    for (int i = 0; i < WORLDS; i++) {
        crowd c;
        crowd_frame f;
        makes[_i](&random, &c, 24);
        crowd_frame_open(&f, &c, tolerances[kit_below(&random, 5)]);
        f.frame.camera.constants.splits = kit_below(&random, 100);
        for (int k = 0; k < 16; k++)
            ask_in_crowd(&random, &f, &sum);
        crowd_frame_close(&f);
    }
    printf("asked %u: alone %u, together %u, gathered %u, dropped %u\n", sum.asked, sum.alone,
           sum.together, sum.gathered, sum.dropped);
    ck_assert_uint_gt(sum.alone, WORLDS / 2);
    ck_assert_uint_gt(sum.together, WORLDS / 20);
    ck_assert_uint_gt(sum.gathered, WORLDS);
    ck_assert_uint_gt(sum.dropped, WORLDS);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("lanes_walk");
    TCase *edges = tcase_create("edges");
    tcase_add_test(edges, every_instruction_set_answers_as_c_does);
    tcase_add_test(edges, nor_does_it_matter_what_is_said_of_the_screen);
    suite_add_tcase(suite, edges);
    TCase *worlds = tcase_create("worlds");
    tcase_add_loop_test(worlds, where_things_are_on_the_screen_hides_no_answer, 0, 3);
    suite_add_tcase(suite, worlds);
    return test_run_suite(suite);
}
