// SPDX-License-Identifier: Apache-2.0
// labels: property
// What the judge makes of an object does not depend on the occluders that are left out.
#include "judge.h"
#include "kit.h"
#include "scenes.h"
#include "settle_frame.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    OBJECTS = 24,
    OCCLUDERS = 40,
    SHEETS = 20,
    SCENES = 300,
    KINDS = 5 // of cameras
};

// A quarter of the boxes are large, a quarter flat, a quarter aligned.
static occ_box random_box(kit_random *random, const float middle[3], float reach, float size)
{
    bool is_aligned = kit_below(random, 4) == 0;
    occ_box box = kit_box(random, reach, size * (kit_below(random, 4) == 0 ? 6.0f : 1.0f));
    for (int k = 0; k < 3; k++)
        for (int j = 0; is_aligned && j < 3; j++)
            if (j != k) box.axis[k][j] = 0;
    for (int j = 0; j < 3 && kit_below(random, 4) == 0; j++)
        box.axis[2][j] = 0;
    for (int j = 0; j < 3; j++)
        box.center[j] += middle[j];
    return box;
}

// Perspective; with an infinite far plane; with an oblique near plane; orthographic; seen through
// a keyhole.
static obs_frame random_frame(kit_random *random, const float eye[3], int kind, float scale)
{
    double from[3], direction[3];
    for (int j = 0; j < 3; j++) {
        from[j] = (double)eye[j];
        direction[j] = (double)kit_between(random, -1, 1);
    }
    double near_z = (double)scale * (kit_below(random, 2) ? 0.01 : 1.5);
    obs_frame frame = obs_look(from, direction, kind == 4 ? 8 : 1, 1.5, near_z, 40 * (double)scale);
    if (kind == 1) {
        frame.proj[10] = -1;
        frame.proj[14] = (float)(-2 * near_z);
    }
    if (kind == 2) frame.proj[2] = 0.3f; // so that the near plane leans
    if (kind == 3) {
        memset(frame.proj, 0, sizeof frame.proj);
        frame.proj[0] = frame.proj[5] = 0.125f / scale;
        frame.proj[10] = -0.05f / scale;
        frame.proj[14] = -1.05f;
        frame.proj[15] = 1;
    }
    return frame;
}

// Three to eight corners around a middle, in a plane or bent, in either order.
static occ_sheet random_sheet(kit_random *random, const float middle[3], float reach, float size)
{
    const occ_box frame = random_box(random, middle, reach, size);
    occ_sheet sheet = {.corner_count = 3 + kit_below(random, 6),
                       .sides = (occ_sides)kit_below(random, 2)};
    float bend = kit_below(random, 2) ? 0.0f : 0.25f;
    for (uint32_t c = 0; c < sheet.corner_count; c++) {
        double angle = 6.28 * (c + 0.9 * steady_unit(random)) / sheet.corner_count;
        float u = (float)cos(angle), v = (float)sin(angle), w = bend * kit_between(random, -1, 1);
        for (int j = 0; j < 3; j++)
            sheet.corner[c][j] = frame.center[j] + u * frame.axis[0][j] + v * frame.axis[1][j] +
                                 w * frame.axis[2][j];
    }
    return sheet;
}

// The occluders are around the eye and before it, the objects farther off.
static void make_scene(obs_scene *scene, kit_random *random, int kind)
{
    static const float scales[3] = {1, 0.001f, 1000};
    float scale = scales[kit_below(random, 3)], eye[3], middle[3];
    for (int j = 0; j < 3; j++)
        eye[j] = kit_below(random, 2) ? 0 : kit_between(random, -1e4f, 1e4f) * scale;
    obs_frame frame = random_frame(random, eye, kind, scale);
    obs_add_frame(scene, &frame);
    for (int j = 0; j < 3; j++)
        middle[j] = eye[j] + 12 * scale * frame.dir[j];
    for (int i = 0; i < OBJECTS; i++) {
        occ_box box = random_box(random, middle, (kind == 4 ? 4 : 9) * scale, scale);
        obs_add_object(scene, &box);
    }
    for (int j = 0; j < 3; j++)
        middle[j] = eye[j] + 4 * scale * frame.dir[j];
    for (int i = 0; i < OCCLUDERS; i++) {
        occ_box box = random_box(random, middle, 9 * scale, 1.5f * scale);
        obs_add_occluder(scene, &box, kit_below(random, OBJECTS));
    }
    ck_assert(!scene->out_of_memory);
    for (int i = 0; i < SHEETS; i++) {
        occ_sheet sheet = random_sheet(random, middle, 9 * scale, 1.5f * scale);
        obs_add_sheet(scene, &sheet, kit_below(random, OBJECTS));
    }
}

static judge *judge_of_frame(const obs_frame *frame)
{
    const double eye[3] = {(double)frame->eye[0], (double)frame->eye[1], (double)frame->eye[2]};
    occ_camera_desc camera = {.eye = eye};
    obs_view_projection(frame, camera.view_projection);
    judge *j = judge_of_camera(&camera);
    ck_assert_ptr_nonnull(j);
    return j;
}

// A frame, a judge that has all occluders, and one that is given those chosen.
typedef struct court {
    const obs_scene *scene;
    settle_frame frame;
    judge *all, *some;
    settle_candidate *list;
    occ_box *boxes;
    occ_sheet *sheets;
} court;

static void open_court(court *c, const obs_scene *scene, uint32_t index)
{
    *c = (court){.scene = scene};
    const char *complaint = settle_frame_make(&c->frame, scene, index);
    ck_assert_msg(!complaint, "%s", complaint);
    c->all = judge_of_frame(&scene->frames[index]);
    c->some = judge_of_frame(&scene->frames[index]);
    uint32_t total = obs_occluder_total(scene), boxes = scene->occluder_count;
    int *owners = calloc(total, sizeof *owners);
    c->list = calloc(total, sizeof *c->list);
    c->boxes = calloc(total, sizeof *c->boxes);
    c->sheets = calloc(total, sizeof *c->sheets);
    ck_assert(owners && c->list && c->boxes && c->sheets);
    for (uint32_t i = 0; i < total; i++) {
        if (i < boxes) c->boxes[i] = scene->occluders[i].box;
        if (i >= boxes) c->sheets[i - boxes] = *obs_occluder_sheet(scene, i);
        owners[i] = (int)obs_occluder_owner(scene, i);
    }
    judge_set_occluders(c->all, c->boxes, owners, boxes);
    judge_add_sheets(c->all, c->sheets, owners + boxes, total - boxes);
    free(owners);
}

static void close_court(court *c)
{
    judge_free(c->all);
    judge_free(c->some);
    settle_frame_free(&c->frame);
    free(c->list);
    free(c->boxes);
    free(c->sheets);
}

typedef struct tally {
    uint32_t seen, hidden, partly, objects;
    uint64_t candidates;
} tally;

static void choose_for(court *c, uint32_t object, tally *sum)
{
    uint32_t count = settle_frame_select(&c->frame, object, c->list);
    uint32_t boxes = 0, sheets = 0;
    ck_assert_uint_le(count, obs_occluder_total(c->scene));
    for (uint32_t i = 0; i < count; i++) {
        uint32_t occluder = c->list[i].occluder;
        const occ_sheet *sheet = obs_occluder_sheet(c->scene, occluder);
        ck_assert_uint_ne(obs_occluder_owner(c->scene, occluder), object);
        uint32_t before = i < SETTLE_BEST ? i : SETTLE_BEST;
        ck_assert(i == 0 || c->list[i].cover <= c->list[before - 1].cover);
        if (sheet)
            c->sheets[sheets++] = *sheet;
        else
            c->boxes[boxes++] = c->scene->occluders[occluder].box;
    }
    judge_set_occluders(c->some, c->boxes, NULL, boxes);
    judge_add_sheets(c->some, c->sheets, NULL, sheets);
    sum->candidates += count;
}

static void check_object(court *c, uint32_t object, tally *sum)
{
    const occ_box *box = &c->scene->objects[object];
    choose_for(c, object, sum);
    bool seen = judge_sees(c->all, box, (int)object);
    double share = judge_share(c->all, box, (int)object), without = judge_share(c->some, box, -1);
    ck_assert_msg(judge_sees(c->some, box, -1) == seen, "object %u: seen %d without the others",
                  object, !seen);
    ck_assert_msg(fabs(share - without) < 1e-6, "object %u: %g of it is seen, not %g", object,
                  without, share);
    sum->seen += seen;
    sum->hidden += !seen && judge_frustum(c->all, box) != JUDGE_OUTSIDE;
    sum->partly += seen && share < 0.999;
    sum->objects++;
}

static void check_frame(const obs_scene *scene, uint32_t index, tally *sum)
{
    court c;
    open_court(&c, scene, index);
    for (uint32_t object = 0; object < scene->object_count; object++)
        check_object(&c, object, sum);
    close_court(&c);
}

START_TEST(occluders_left_out_change_no_verdict)
{
    kit_random random = {(uint64_t)_i + 1};
    tally sum = {0};
    for (int i = 0; i < SCENES / KINDS; i++) {
        obs_scene scene = {0};
        make_scene(&scene, &random, _i);
        check_frame(&scene, 0, &sum);
        obs_free(&scene);
    }
    // There was something to see, to hide, and to leave out.
    ck_assert_uint_gt(sum.seen, sum.objects / 50);
    ck_assert_uint_gt(sum.hidden, sum.objects / 20);
    ck_assert_uint_gt(sum.partly, sum.objects / 50);
    ck_assert_uint_lt(sum.candidates, (uint64_t)sum.objects * (OCCLUDERS + SHEETS) / 2);
}
END_TEST

// Scenes as they are measured, a frame of each.
START_TEST(named_scenes_have_few_candidates_and_the_same_verdicts)
{
    static const char *const names[] = {"city", "forest", "soup", "interior", "seedscene"};
    obs_scene scene = {0};
    tally sum = {0};
    ck_assert(scenes_make(names[_i], 1000 / OCC_TEST_SLOWNESS, 7, &scene));
    check_frame(&scene, scene.frame_count / 2, &sum);
    ck_assert_uint_gt(sum.seen, 0);
    ck_assert_uint_gt(sum.hidden, 0);
    ck_assert_uint_lt(sum.candidates, (uint64_t)sum.objects * scene.occluder_count / 4);
    obs_free(&scene);
}
END_TEST

enum { TILES = 48 };

// Where [middle - half, middle + half] is in a view of 90 degrees, from one depth to another.
static void find_interval(float middle, float half, float near_z, float far_z, double out[2])
{
    double low = (double)middle - (double)half, high = (double)middle + (double)half;
    out[0] = fmin(low / (double)near_z, low / (double)far_z);
    out[1] = fmax(high / (double)near_z, high / (double)far_z);
}

// Object 0 is behind a wall of tiles: those before it are candidates, each once, and few others.
static void check_tiles(const settle_frame *frame, settle_candidate *list)
{
    const obs_scene *scene = frame->scene;
    const occ_box *object = &scene->objects[0];
    uint8_t listed[TILES * TILES] = {0};
    double seen[2][2], tile[2][2];
    uint32_t before = 0, count = settle_frame_select(frame, 0, list);
    for (int i = 0; i < 2; i++)
        find_interval(object->center[i], object->axis[i][i], 4, 6, seen[i]);
    for (uint32_t i = 0; i < count; i++)
        listed[list[i].occluder]++;
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        const occ_box *box = &scene->occluders[i].box;
        bool overlaps = true;
        for (int k = 0; k < 2; k++) {
            find_interval(box->center[k], box->axis[k][k], 3, 3, tile[k]);
            overlaps = overlaps && tile[k][0] < seen[k][1] && tile[k][1] > seen[k][0];
        }
        KIT_CHECK(listed[i] <= 1 && listed[i] >= overlaps, "tile %u is listed %u times", i,
                  listed[i]);
        before += overlaps;
    }
    ck_assert_uint_gt(before, 0);
    ck_assert_uint_le(count, before + 8 * TILES);
}

START_TEST(every_occluder_before_the_object_is_a_candidate)
{
    static const double eye[3] = {0, 0, 0}, direction[3] = {0, 0, -1};
    static settle_candidate list[TILES * TILES];
    kit_random random = {11};
    obs_scene scene = {0};
    obs_frame from = obs_look(eye, direction, 1, 1, 0.125, 100);
    settle_frame frame;
    occ_box object = kit_cube(0, 0, -5, 1), owner = kit_cube(0, 0, 90, 1);
    obs_add_frame(&scene, &from);
    obs_add_object(&scene, &object);
    obs_add_object(&scene, &owner);
    for (int i = 0; i < TILES * TILES; i++) {
        int column = i % TILES, row = i / TILES;
        float x = (float)column - 23.5f, y = (float)row - 23.5f;
        const occ_box tile = {{x / 8, y / 8, -3}, {{0.0625f, 0, 0}, {0, 0.0625f, 0}, {0, 0, 0}}};
        obs_add_occluder(&scene, &tile, 1);
    }
    ck_assert_ptr_null(settle_frame_make(&frame, &scene, 0));
    for (int i = 0; i < 300; i++) {
        for (int k = 0; k < 2; k++) {
            scene.objects[0].center[k] = kit_between(&random, -3, 3);
            scene.objects[0].axis[k][k] = kit_between(&random, 0.001f, 0.7f);
        }
        check_tiles(&frame, list);
    }
    settle_frame_free(&frame);
    obs_free(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("settle_frame");
    TCase *choice = tcase_create("choice");
    tcase_add_loop_test(choice, occluders_left_out_change_no_verdict, 0, KINDS);
    tcase_add_loop_test(choice, named_scenes_have_few_candidates_and_the_same_verdicts, 0, 5);
    tcase_add_test(choice, every_occluder_before_the_object_is_a_candidate);
    suite_add_tcase(suite, choice);
    return test_run_suite(suite);
}
