// SPDX-License-Identifier: Apache-2.0
// The judge of many occluders on random worlds: against the oracle of one occluder, which shares
// none of its geometry, against itself without the filter, against occluders cut into pieces that
// abut, and against sampling in double.
// labels: property oracle
// timeout: 120
#include "judge.h"

#include "oracle.h"
#include "support.h"
#include "worlds.h"

#include <math.h>
#include <string.h>

enum { MOST_BOXES = 48 };

// --- worlds --------------------------------------------------------------------------------------

static float pick_grid(kit_random *random, int reach)
{
    return (float)((int)kit_below(random, 2u * (uint32_t)reach + 1u) - reach);
}

// Small whole numbers: everything touches, lies in one plane, or is degenerate.
static occ_box grid_box(kit_random *random, int reach, int size)
{
    occ_box box = {{0}, {{0}}};
    bool aligned = kit_below(random, 2) == 0;
    for (int j = 0; j < 3; j++) {
        box.center[j] = pick_grid(random, reach);
        for (int k = 0; k < 3; k++)
            if (!aligned || j == k) box.axis[k][j] = 0.5f * pick_grid(random, size);
    }
    return box;
}

static void grid_eye(kit_random *random, int reach, double eye[3])
{
    do {
        for (int j = 0; j < 3; j++)
            eye[j] = (double)pick_grid(random, reach);
    } while (eye[0] == 0.0 && eye[1] == 0.0 && eye[2] == 0.0);
}

static occ_box free_box(kit_random *random, double reach, double size)
{
    double center[3];
    for (int j = 0; j < 3; j++)
        center[j] = world_between(random, -reach, reach);
    return world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), center,
                     size * world_between(random, 0.1, 1));
}

// Half of the objects go where occluders around the origin may hide them.
static void move_behind(kit_random *random, const double eye[3], occ_box *object)
{
    uint32_t behind = kit_below(random, 2);
    for (int j = 0; behind && j < 3; j++)
        object->center[j] = 0.25f * object->center[j] - (float)eye[j];
}

static judge *any_judge(uint32_t kind, const double eye[3])
{
    return kind ? judge_of_direction(eye) : judge_of_eye(eye);
}

static bool sees(judge *j, bool filter, const occ_box *object, const occ_box *boxes, size_t count)
{
    judge_filter(j, filter);
    judge_set_occluders(j, boxes, NULL, count);
    return judge_sees(j, object, -1);
}

// --- one occluder --------------------------------------------------------------------------------

// How often each answer came, so that none is tested by nothing.
static void agree_on_one(kit_random *random, bool grid, unsigned counts[3])
{
    double eye[3];
    occ_box occluder = grid ? grid_box(random, 2, 5) : free_box(random, 1, 6);
    occ_box object = grid ? grid_box(random, 4, 2) : free_box(random, 8, 1);
    grid_eye(random, 6, eye);
    if (!grid) {
        world_direction(random, eye);
        for (int j = 0; j < 3; j++)
            eye[j] *= 8.0;
    }
    move_behind(random, eye, &object);
    if (grid && kit_below(random, 8) == 0) object = occluder;
    uint32_t kind = kit_below(random, 4) == 0;
    oracle *one = kind ? oracle_of_direction(eye) : oracle_of_eye(eye);
    judge *many = any_judge(kind, eye);
    int sight = (int)oracle_box(one, &object, &occluder);
    for (int filter = 0; filter < 2; filter++) {
        judge_filter(many, filter == 1);
        KIT_CHECK((int)judge_single(many, &object, &occluder) == sight, "%d is not said", sight);
        bool seen = sees(many, filter == 1, &object, &occluder, 1);
        KIT_CHECK(seen == (sight == (int)ORACLE_SEEN), "seen %d, sight %d", (int)seen, sight);
    }
    counts[sight]++;
    oracle_free(one);
    judge_free(many);
}

START_TEST(one_occluder_as_the_oracle_has_it)
{
    kit_random random = {11};
    for (int grid = 0; grid < 2; grid++) {
        unsigned counts[3] = {0, 0, 0};
        for (int i = 0; i < WORLD_SHARE(6000); i++)
            agree_on_one(&random, grid == 1, counts);
        for (int i = 0; i < 3; i++)
            if (grid || i != ORACLE_GRAZED) ck_assert_uint_gt(counts[i], WORLD_SHARE(30));
    }
}
END_TEST

// From the corners of a box of eyes, which are doubles here.
static void agree_on_eyes(kit_random *random, unsigned counts[3])
{
    occ_box eyes = grid_box(random, 2, 2), object = grid_box(random, 2, 2);
    occ_box occluder = grid_box(random, 1, 12);
    eyes.center[0] += 12.0f;
    object.center[0] -= 8.0f;
    int least = ORACLE_HIDDEN;
    for (unsigned corner = 0; corner < 8; corner++) {
        double eye[3];
        world_corner(&eyes, corner, eye);
        oracle *one = oracle_of_eye(eye);
        int sight = (int)oracle_box(one, &object, &occluder);
        least = sight < least ? sight : least;
        oracle_free(one);
    }
    int said = (int)judge_single_from(&eyes, &object, &occluder, true);
    KIT_CHECK(said == (int)judge_single_from(&eyes, &object, &occluder, false), "the filter errs");
    KIT_CHECK(said <= least, "%d, but an eye has %d", said, least);
    double middle[3] = {(double)eyes.center[0], (double)eyes.center[1], (double)eyes.center[2]};
    oracle *one = oracle_of_eye(middle);
    KIT_CHECK(said <= (int)oracle_box(one, &object, &occluder), "not from the middle");
    oracle_free(one);
    occ_box none = {{1e6f, 0, 0}, {{0}}};
    bool touches = judge_single_from(&eyes, &none, &occluder, true) == JUDGE_SEEN;
    KIT_CHECK(said == least || (said == JUDGE_SEEN && touches), "%d is not %d", said, least);
    counts[said]++;
}

START_TEST(a_box_of_eyes_as_the_oracle_has_its_corners)
{
    kit_random random = {12};
    unsigned counts[3] = {0, 0, 0};
    for (int i = 0; i < WORLD_SHARE(2000); i++)
        agree_on_eyes(&random, counts);
    for (int i = 0; i < 3; i++)
        ck_assert_uint_gt(counts[i], WORLD_SHARE(20));
}
END_TEST

// --- many occluders ------------------------------------------------------------------------------

// Cut along some of its axes into parts whose numbers are all exact.
static size_t cut_box(kit_random *random, const occ_box *box, occ_box *parts)
{
    size_t count = 1;
    parts[0] = *box;
    for (int k = 0; k < 3; k++) {
        uint32_t times = kit_below(random, 3);
        for (size_t i = 0; times && i < count; i++)
            for (int j = 0; j < 3; j++)
                parts[i].axis[k][j] *= 0.5f;
        for (size_t i = 0; times && i < count; i++) {
            parts[count + i] = parts[i];
            for (int j = 0; j < 3; j++) {
                parts[count + i].center[j] += parts[i].axis[k][j];
                parts[i].center[j] -= parts[i].axis[k][j];
            }
        }
        count *= times ? 2 : 1;
    }
    return count;
}

// Any that is the whole's part may be a part's whole; what the parts hide together is what it
// hides.
static unsigned agree_on_parts(kit_random *random, bool grid)
{
    double eye[3];
    occ_box whole = grid ? grid_box(random, 2, 4) : free_box(random, 1, 4), parts[MOST_BOXES];
    occ_box object = grid ? grid_box(random, 6, 3) : free_box(random, 8, 1.5);
    for (int j = 0; j < 3; j++) // few enough bits for quarters to be exact
        for (int k = 0; k < 3; k++) {
            whole.center[j] = floorf(whole.center[j] * 65536.0f) / 65536.0f;
            whole.axis[k][j] = floorf(whole.axis[k][j] * 65536.0f) / 65536.0f;
        }
    grid_eye(random, 8, eye);
    eye[kit_below(random, 3)] = grid ? 9.0 : 20.0; // outside of the whole
    move_behind(random, eye, &object);
    judge *j = any_judge(kit_below(random, 4) == 0, eye);
    judge_set_occluders(j, &whole, NULL, 1);
    bool seen = judge_sees(j, &object, -1);
    size_t count = cut_box(random, &whole, parts);
    size_t more = cut_box(random, &parts[count - 1], &parts[count - 1]);
    count += more - 1;
    for (int filter = 0; filter < 2; filter++)
        KIT_CHECK(sees(j, filter == 1, &object, parts, count) == seen, "%d parts: not %d",
                  (int)count, (int)seen);
    judge_free(j);
    return count > 1 && !seen;
}

START_TEST(parts_that_abut_hide_what_the_whole_hides)
{
    kit_random random = {13};
    for (int grid = 0; grid < 2; grid++) {
        unsigned hidden = 0;
        for (int i = 0; i < WORLD_SHARE(5000); i++)
            hidden += agree_on_parts(&random, grid == 1);
        ck_assert_uint_gt(hidden, WORLD_SHARE(200));
    }
}
END_TEST

static unsigned agree_without_filter(kit_random *random, bool grid)
{
    double eye[3];
    occ_box boxes[MOST_BOXES];
    grid_eye(random, 6, eye);
    size_t count = 2 + kit_below(random, 10);
    for (size_t i = 0; i < count; i++)
        boxes[i] = grid ? grid_box(random, 2, 5) : free_box(random, 2, 4);
    judge *fast = any_judge(kit_below(random, 4) == 0, eye);
    unsigned hidden = 0;
    for (int i = 0; i < 8; i++) {
        occ_box object = grid ? grid_box(random, 6, 3) : free_box(random, 6, 2);
        bool seen = sees(fast, true, &object, boxes, count);
        double share = judge_share(fast, &object, -1);
        KIT_CHECK((share > 0.0) == seen, "share %g", share);
        KIT_CHECK(sees(fast, false, &object, boxes, count) == seen, "the filter errs");
        hidden += !seen;
    }
    judge_free(fast);
    return hidden;
}

START_TEST(the_filter_changes_no_verdict)
{
    kit_random random = {14};
    for (int grid = 0; grid < 2; grid++) {
        unsigned hidden = 0;
        for (int i = 0; i < WORLD_SHARE(600); i++)
            hidden += agree_without_filter(&random, grid == 1);
        ck_assert_uint_gt(hidden, WORLD_SHARE(200));
    }
}
END_TEST

// Scaled by a power of two and moved by whole numbers, both exactly, a world is what it was.
static unsigned agree_elsewhere(kit_random *random)
{
    static const float factors[] = {0x1p-125f, 0x1p-40f, 0x1p-20f, 0x1p20f, 0x1p44f};
    double eye[3], there[3];
    occ_box boxes[MOST_BOXES], moved[MOST_BOXES];
    float shift[3], factor = factors[kit_below(random, 5)];
    for (int j = 0; j < 3; j++)
        shift[j] = kit_below(random, 2) ? pick_grid(random, 1 << 20) : 0.0f;
    grid_eye(random, 6, eye);
    size_t count = 3 + kit_below(random, 6); // the first is the object
    for (size_t i = 0; i < count; i++) {
        boxes[i] = i ? grid_box(random, 2, 6) : grid_box(random, 4, 2);
        if (i == 0) move_behind(random, eye, boxes);
        moved[i] = boxes[i];
        for (int j = 0; j < 3; j++)
            moved[i].center[j] += shift[j];
        moved[i] = world_scaled(&moved[i], factor);
    }
    for (int j = 0; j < 3; j++)
        there[j] = (eye[j] + (double)shift[j]) * (double)factor;
    judge *here = judge_of_eye(eye), *far_off = judge_of_eye(there);
    bool seen = sees(here, true, boxes, boxes + 1, count - 1);
    for (int filter = 0; filter < 2; filter++)
        KIT_CHECK(sees(far_off, filter == 1, moved, moved + 1, count - 1) == seen, "times %g",
                  (double)factor);
    judge_free(here);
    judge_free(far_off);
    return !seen;
}

START_TEST(scale_and_place_change_no_verdict)
{
    kit_random random = {17};
    unsigned hidden = 0;
    for (int i = 0; i < WORLD_SHARE(4000); i++)
        hidden += agree_elsewhere(&random);
    ck_assert_uint_gt(hidden, WORLD_SHARE(200));
}
END_TEST

// --- cameras -------------------------------------------------------------------------------------

static occ_camera_desc any_camera(kit_random *random)
{
    float eye[3], target[3];
    world_lens lens = {
        .projection = (world_projection)kit_below(random, WORLD_PROJECTIONS),
        .depth = (occ_depth)kit_below(random, 3),
        .near_z = kit_below(random, 2) ? 0.1f : 3.0f,
        .far_z = kit_below(random, 2) ? 1000.0f : 14.0f,
    };
    for (int j = 0; j < 3; j++) {
        eye[j] = kit_between(random, -8, 8);
        target[j] = kit_between(random, -2, 2);
    }
    return world_camera(eye, target, &lens);
}

// A point is seen if the oracle has it inside, and no occluder hides or grazes it.
static void agree_on_points(kit_random *random, unsigned counts[3])
{
    occ_camera_desc camera = any_camera(random);
    occ_box boxes[4];
    for (int i = 0; i < 4; i++)
        boxes[i] = free_box(random, 4, 4);
    static const double given[3] = {1.0 / 3.0, 2, -1};
    if (kit_below(random, 4) == 0) camera.origin = given;
    if (kit_below(random, 4) == 0) camera.eye = given;
    oracle *one = oracle_of_camera(&camera);
    judge *many = judge_of_camera(&camera);
    ck_assert_ptr_nonnull(many);
    for (int i = 0; i < 16; i++) {
        occ_box dot = {{0}, {{0}}};
        double point[3];
        for (int j = 0; j < 3; j++)
            point[j] = (double)(dot.center[j] = kit_between(random, -10, 10));
        bool inside = oracle_holds(one, point), seen = inside;
        for (int k = 0; k < 4 && seen; k++)
            seen = oracle_point(one, point, &boxes[k]) == ORACLE_SEEN;
        for (int filter = 0; filter < 2; filter++) {
            KIT_CHECK(sees(many, filter == 1, &dot, boxes, 4) == seen, "not %d", (int)seen);
            KIT_CHECK((judge_frustum(many, &dot) != JUDGE_OUTSIDE) == inside, "not inside");
        }
        counts[inside + seen]++;
    }
    oracle_free(one);
    judge_free(many);
}

START_TEST(points_in_cameras_as_the_oracle_has_them)
{
    kit_random random = {15};
    unsigned counts[3] = {0, 0, 0};
    for (int i = 0; i < WORLD_SHARE(400); i++)
        agree_on_points(&random, counts);
    for (int i = 0; i < 3; i++)
        ck_assert_uint_gt(counts[i], WORLD_SHARE(100));
}
END_TEST

static void agree_on_places(kit_random *random, unsigned counts[3])
{
    occ_camera_desc camera = any_camera(random);
    oracle *one = oracle_of_camera(&camera);
    judge *many = judge_of_camera(&camera);
    for (int i = 0; i < 16; i++) {
        occ_box object = free_box(random, 12, 6);
        judge_place place = judge_frustum(many, &object);
        judge_filter(many, i % 2 == 0);
        KIT_CHECK(judge_frustum(many, &object) == place, "the filter errs");
        unsigned inside = 0;
        for (unsigned corner = 0; corner < 8; corner++) {
            double at[3];
            world_corner(&object, corner, at);
            inside += oracle_holds(one, at);
        }
        bool outside = oracle_outside(one, &object);
        KIT_CHECK(!outside || place == JUDGE_OUTSIDE, "outside of one plane, but %d", (int)place);
        KIT_CHECK(inside < 8 || place == JUDGE_INSIDE, "all corners inside, but %d", (int)place);
        KIT_CHECK(inside == 8 || place != JUDGE_INSIDE, "%u corners inside", inside);
        judge_set_occluders(many, NULL, NULL, 0);
        KIT_CHECK(judge_sees(many, &object, -1) == (place != JUDGE_OUTSIDE), "place %d",
                  (int)place);
        counts[place]++;
    }
    oracle_free(one);
    judge_free(many);
}

START_TEST(objects_in_frusta_as_the_oracle_has_their_corners)
{
    kit_random random = {16};
    unsigned counts[3] = {0, 0, 0};
    for (int i = 0; i < WORLD_SHARE(400); i++)
        agree_on_places(&random, counts);
    for (int i = 0; i < 3; i++)
        ck_assert_uint_gt(counts[i], WORLD_SHARE(100));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("judge_random");
    TCase *one = tcase_create("one");
    tcase_add_test(one, one_occluder_as_the_oracle_has_it);
    tcase_add_test(one, a_box_of_eyes_as_the_oracle_has_its_corners);
    suite_add_tcase(suite, one);
    TCase *many = tcase_create("many");
    tcase_add_test(many, parts_that_abut_hide_what_the_whole_hides);
    tcase_add_test(many, the_filter_changes_no_verdict);
    tcase_add_test(many, scale_and_place_change_no_verdict);
    suite_add_tcase(suite, many);
    TCase *cameras = tcase_create("cameras");
    tcase_add_test(cameras, points_in_cameras_as_the_oracle_has_them);
    tcase_add_test(cameras, objects_in_frusta_as_the_oracle_has_their_corners);
    suite_add_tcase(suite, cameras);
    return test_run_suite(suite);
}
