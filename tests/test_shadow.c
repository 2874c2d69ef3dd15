// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// timeout: 120
// Shadows of single occluders against the exact judge: never a verdict of "hidden" that the judge
// does not share, and none left out that is clear.
#include "oracle.h"

#include "support.h"
#include "verdicts.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// --- one object, one occluder --------------------------------------------------------------------

static bool hides_from(double x, double y, double z, const occ_box *occluder, const occ_box *object)
{
    const double eye[3] = {x, y, z};
    occ_frame frame = verdict_frame_at(eye);
    return verdict_hides(&frame, occluder, object);
}

static uint32_t planes_from(double x, double y, double z, const occ_box *occluder)
{
    const double eye[3] = {x, y, z};
    occ_frame frame = verdict_frame_at(eye);
    return verdict_planes(&frame, occluder);
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

// An aligned box that holds the object with room to spare on every side.
static occ_box with_margin(const occ_box *object, const double eye[3], double part)
{
    occ_box wide = {.axis = {{0}}};
    double center[3], reach = 0.0;
    for (int j = 0; j < 3; j++) {
        wide.center[j] = object->center[j];
        center[j] = (double)object->center[j];
        for (int k = 0; k < 3; k++)
            wide.axis[j][j] += fabsf(object->axis[k][j]);
        reach += (double)wide.axis[j][j];
    }
    float more = (float)((distance(center, eye) + reach) * part);
    for (int j = 0; j < 3; j++)
        wide.axis[j][j] += more;
    return wide;
}

// --- random duels --------------------------------------------------------------------------------

typedef struct duel {
    double eye[3];
    occ_box occluder, object;
} duel;

// A point of the occluder, as often as not on its rim or on a face.
static void pick_point(kit_random *random, const occ_box *box, double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = (double)box->center[j];
    for (int k = 0; k < 3; k++) {
        double u = world_between(random, -1, 1);
        if (kit_below(random, 2)) u = u < 0.0 ? -1.0 : 1.0;
        for (int j = 0; j < 3; j++)
            out[j] += u * (double)box->axis[k][j];
    }
}

// An object with one corner next to the line from the eye through a point of the occluder, and the
// others nearer to the shadow's middle: behind it by up to `most` of the distance.
static void place_object(kit_random *random, duel *d, double most)
{
    double rim[3], corner[3], inward[3], nothing[3] = {0, 0, 0};
    pick_point(random, &d->occluder, rim);
    double factor = 1.0 + world_scale(random, 1e-7, most);
    for (int j = 0; j < 3; j++) {
        corner[j] = d->eye[j] + factor * (rim[j] - d->eye[j]);
        double middle = d->eye[j] + factor * ((double)d->occluder.center[j] - d->eye[j]);
        inward[j] = middle - corner[j];
    }
    double nudge = world_scale(random, 1e-9, 1) * (kit_below(random, 4) ? 1.0 : -1.0);
    double size = distance(corner, d->eye) * most * world_scale(random, 1e-7, 0.03);
    world_shape shape = (world_shape)kit_below(random, WORLD_SHAPES);
    d->object = world_box(random, shape, nothing, size);
    for (int j = 0; j < 3; j++)
        corner[j] += nudge * inward[j];
    for (int k = 0; k < 3; k++) {
        double along = 0.0;
        for (int j = 0; j < 3; j++)
            along += (double)d->object.axis[k][j] * inward[j];
        for (int j = 0; j < 3; j++)
            corner[j] += (along < 0.0 ? -1.0 : 1.0) * (double)d->object.axis[k][j];
    }
    for (int j = 0; j < 3; j++)
        d->object.center[j] = (float)corner[j];
}

// A long thin object that lies, but for some roundings, in the plane through the eye and an edge:
// large numbers go into a small one.
static void place_along_edge(kit_random *random, duel *d)
{
    double rim[3], factor = 1.0 + world_scale(random, 1e-3, 10);
    uint32_t along = kit_below(random, 3);
    double u[3], nudge = world_scale(random, 1e-9, 1e-5) * (kit_below(random, 8) ? 1.0 : -1.0);
    for (uint32_t k = 0; k < 3; k++)
        u[k] = k == along ? world_between(random, -1, 1) : kit_below(random, 2) ? 1.0 : -1.0;
    double p = world_between(random, -0.4, 0.4), q = world_between(random, -0.5, 0.5);
    for (int j = 0; j < 3; j++) {
        rim[j] = (double)d->occluder.center[j];
        for (int k = 0; k < 3; k++)
            rim[j] += u[k] * (double)d->occluder.axis[k][j];
        double ray = rim[j] - d->eye[j], edge = (double)d->occluder.axis[along][j];
        double middle = (double)d->occluder.center[j] - rim[j];
        d->object.center[j] = (float)(d->eye[j] + factor * (ray + nudge * middle));
        d->object.axis[0][j] = (float)(factor * (p * ray + q * edge));
        d->object.axis[1][j] = d->object.axis[2][j] = 0.0f;
    }
}

// An occluder about as far from the eye as it is large, and an object behind it.
static void make_duel(kit_random *random, duel *d, double scale)
{
    double aside[3], center[3];
    world_direction(random, aside);
    double away = scale * world_scale(random, 0.1, 30);
    for (int j = 0; j < 3; j++)
        center[j] = d->eye[j] + away * aside[j];
    world_shape shape = (world_shape)kit_below(random, WORLD_SHAPES);
    d->occluder = world_box(random, shape, center, scale);
    place_object(random, d, 10);
    if (kit_below(random, 2)) place_along_edge(random, d);
}

// As often as not the eye is special: level with a face, or in line with an edge.
static void make_duel_anywhere(kit_random *random, duel *d)
{
    double scale = world_scale(random, 1e-6, 1e6), there[3];
    double offset = kit_below(random, 3) ? world_scale(random, 0.01 * scale, 1e7) : 0.0;
    world_direction(random, there);
    for (int j = 0; j < 3; j++) {
        d->eye[j] = offset * there[j];
        if (kit_below(random, 4) == 0) d->eye[j] = (double)(float)d->eye[j];
    }
    make_duel(random, d, scale);
    for (int k = 0; k < 3 && kit_below(random, 4) == 0; k++)
        for (int j = 0; j < 3; j++) {
            double level = (double)d->occluder.center[j] + (double)d->occluder.axis[k][j];
            if (kit_below(random, 2)) d->eye[j] = level;
        }
    place_object(random, d, 10);
    if (kit_below(random, 2)) place_along_edge(random, d);
}

typedef struct tally {
    unsigned hidden, clear, missed;
} tally;

static void fight(const duel *d, const occ_frame *frame, oracle *judge, unsigned number, tally *sum)
{
    bool hidden = verdict_hides(frame, &d->occluder, &d->object);
    sum->hidden += hidden;
    ck_assert_msg(!hidden || oracle_box(judge, &d->object, &d->occluder) == ORACLE_HIDDEN,
                  "duel %u: hidden, but it can be seen", number);
    occ_box wide = with_margin(&d->object, d->eye, 1e-4);
    bool clear = oracle_box(judge, &wide, &d->occluder) == ORACLE_HIDDEN;
    sum->clear += clear;
    sum->missed += clear && !hidden;
}

enum { DUELS = 30000, DUELS_PER_CAMERA = 10 };

static void check_tally(const tally *sum, unsigned duels, unsigned least_part)
{
    printf("%u duels: %u hidden, %u clearly so, %u of these missed\n", duels, sum->hidden,
           sum->clear, sum->missed);
    ck_assert_uint_gt(sum->hidden, duels / least_part);
    ck_assert_uint_gt(sum->clear, duels / least_part);
}

START_TEST(no_shadow_holds_what_can_be_seen_and_clear_cases_are_found)
{
    kit_random random = {(uint64_t)_i + 1};
    tally sum = {0, 0, 0};
    for (unsigned i = 0; i < WORLD_SHARE(DUELS); i++) {
        duel d;
        make_duel_anywhere(&random, &d);
        occ_frame frame = verdict_frame_at(d.eye);
        oracle *judge = oracle_of_eye(d.eye);
        fight(&d, &frame, judge, i, &sum);
        oracle_free(judge);
    }
    check_tally(&sum, WORLD_SHARE(DUELS), 10);
    ck_assert_uint_le(sum.missed * 400, sum.clear);
}
END_TEST

// The judge's eye is where the matrix puts it, the library's is what double makes of that.
START_TEST(no_shadow_from_a_derived_eye_holds_what_can_be_seen)
{
    kit_random random = {(uint64_t)_i + 11};
    tally sum = {0, 0, 0};
    for (unsigned i = 0; i < WORLD_SHARE(DUELS) / DUELS_PER_CAMERA; i++) {
        double reach = world_scale(&random, 1e-3, 1e5);
        occ_camera_desc desc = world_skewed_camera(&random, reach);
        const double origin[3] = {-reach, 1e-3, 3 * reach};
        if (kit_below(&random, 4) == 0) desc.origin = origin;
        occ_frame frame = {.hooks = NULL};
        const char *reason;
        if (occ_camera_init(&frame.camera, &desc, &reason)) continue;
        oracle *judge = oracle_of_camera(&desc);
        for (unsigned k = 0; k < DUELS_PER_CAMERA; k++) {
            duel d;
            memcpy(d.eye, frame.camera.eye, sizeof d.eye);
            make_duel(&random, &d, reach * world_scale(&random, 1e-7, 1));
            fight(&d, &frame, judge, i * DUELS_PER_CAMERA + k, &sum);
        }
        oracle_free(judge);
    }
    check_tally(&sum, WORLD_SHARE(DUELS), 50); // near planes and doubtful eyes cost the rest
}
END_TEST

// Its near plane, from which all is measured, lies behind all that there is.
static occ_camera_desc parallel_camera(kit_random *random, double scale)
{
    static const double nowhere[3];
    occ_camera_desc desc = {.depth = (occ_depth)kit_below(random, 3)};
    occ_box rows = world_box(random, WORLD_TURNED, nowhere, 0.02 / scale);
    float slant = kit_between(random, -0.3f, 0.3f);
    for (int r = 0; r < 3; r++)
        for (int j = 0; j < 3; j++)
            desc.view_projection[4 * j + r] = rows.axis[r][j] + slant * rows.axis[(r + 1) % 3][j];
    desc.view_projection[14] = desc.depth == OCC_DEPTH_ZERO_TO_ONE ? 1.0f : 0.0f;
    desc.view_projection[15] = 1.0f;
    return desc;
}

START_TEST(no_parallel_shadow_holds_what_can_be_seen_and_clear_cases_are_found)
{
    kit_random random = {(uint64_t)_i + 21};
    tally sum = {0, 0, 0};
    for (unsigned i = 0; i < WORLD_SHARE(DUELS) / DUELS_PER_CAMERA; i++) {
        double scale = world_scale(&random, 1e-6, 1e6);
        occ_camera_desc desc = parallel_camera(&random, scale);
        occ_frame frame = verdict_frame(&desc);
        oracle *judge = oracle_of_camera(&desc);
        for (unsigned k = 0; k < DUELS_PER_CAMERA; k++) {
            duel d;
            const double center[3] = {scale, -scale, 0.3 * scale};
            for (int j = 0; j < 3; j++) // far off in the direction, to aim from
                d.eye[j] = center[j] + 1e4 * scale * frame.camera.toward[j];
            d.occluder =
                world_box(&random, (world_shape)kit_below(&random, WORLD_SHAPES), center, scale);
            place_object(&random, &d, 1e-3);
            memcpy(d.eye, frame.camera.eye, sizeof d.eye);
            fight(&d, &frame, judge, i * DUELS_PER_CAMERA + k, &sum);
        }
        oracle_free(judge);
    }
    check_tally(&sum, WORLD_SHARE(DUELS), 20);
    ck_assert_uint_le(sum.missed * 400, sum.clear);
}
END_TEST

// --- by hand -------------------------------------------------------------------------------------

static const occ_box cube = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const occ_box sheet = {{0, 0, 0}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

START_TEST(a_shadow_has_5_planes_for_one_face_8_for_two_and_9_for_three)
{
    ck_assert_uint_eq(planes_from(5, 0, 0, &cube), 5);
    ck_assert_uint_eq(planes_from(5, 0.999, -0.999, &cube), 5);
    ck_assert_uint_eq(planes_from(5, 5, 0, &cube), 8);
    ck_assert_uint_eq(planes_from(5, 5, 5, &cube), 9);
    ck_assert_uint_eq(planes_from(-5, 5, -5, &cube), 9);
    ck_assert_uint_eq(planes_from(5, 5, 5, &sheet), 5);
}
END_TEST

// Every place of the eye on, above and beside the faces of a cube, from inside to outside.
START_TEST(an_eye_in_or_on_an_occluder_has_no_shadow)
{
    const double places[] = {-1, -0.5, 0, 0.5, 1};
    for (int i = 0; i < 125; i++)
        ck_assert_uint_eq(planes_from(places[i % 5], places[i / 5 % 5], places[i / 25], &cube), 0);
    ck_assert_uint_eq(planes_from(0, 0.5, 0.5, &sheet), 0);
    ck_assert_uint_eq(planes_from(0, 1, 1, &sheet), 0);
}
END_TEST

START_TEST(an_eye_level_with_a_face_loses_that_face_alone)
{
    occ_box behind = kit_cube(-8, 0, 0, 0.25f), below = kit_cube(-3, -3, 0, 0.25f);
    ck_assert_uint_eq(planes_from(5, 1, 0, &cube), 5);
    ck_assert_uint_eq(planes_from(5, 1 + 1e-9, 0, &cube), 8);
    ck_assert(hides_from(5, 1, 0, &cube, &(occ_box){{-8, -1, 0}, {{0}}}));
    ck_assert(!hides_from(5, 1, 0, &cube, &(occ_box){{-8, 1, 0}, {{0}}})); // in the face's plane
    ck_assert(!hides_from(5, 1, 0, &cube, &below));
    ck_assert(hides_from(5, 0, 0, &cube, &behind));
    ck_assert(hides_from(3, 3, 0, &cube, &below));
}
END_TEST

START_TEST(an_eye_in_line_with_an_edge_or_next_to_a_corner_still_has_a_shadow)
{
    ck_assert_uint_eq(planes_from(5, 1, 1, &cube), 5);
    ck_assert(hides_from(5, 1, 1, &cube, &(occ_box){{-8, -0.5f, -0.5f}, {{0}}}));
    ck_assert(!hides_from(5, 1, 1, &cube, &(occ_box){{-8, 1, 1}, {{0}}}));
    ck_assert_uint_eq(planes_from(1 + 1e-6, 1 + 1e-6, 1 + 1e-6, &cube), 9);
    ck_assert(hides_from(1 + 1e-6, 1 + 1e-6, 1 + 1e-6, &cube, &(occ_box){{-2, -2, -2}, {{0}}}));
}
END_TEST

START_TEST(a_sheet_hides_from_both_sides_and_nothing_edge_on)
{
    occ_box left = kit_cube(-8, 0, 0, 0.5f), right = kit_cube(8, 0, 0, 0.5f);
    ck_assert(hides_from(5, 0, 0, &sheet, &left));
    ck_assert(hides_from(-5, 0, 0, &sheet, &right));
    ck_assert(!hides_from(5, 0, 0, &sheet, &right));
    ck_assert_uint_eq(planes_from(0, 5, 0, &sheet), 0);
    ck_assert_uint_eq(planes_from(0, -3, 7, &sheet), 0);
    ck_assert_uint_eq(planes_from(1e-12, 5, 0, &sheet), 5);
}
END_TEST

START_TEST(zero_axes_in_any_place_make_the_same_sheet)
{
    occ_box behind = kit_cube(-8, 0, 0, 0.5f), beside = kit_cube(-8, 2.5f, 0, 0.5f);
    for (int k = 0; k < 3; k++) {
        occ_box turned = {{0, 0, 0}, {{0}}};
        turned.axis[(k + 1) % 3][1] = 1;
        turned.axis[(k + 2) % 3][2] = -1;
        ck_assert_uint_eq(planes_from(5, 0, 0, &turned), 5);
        ck_assert(hides_from(5, 0, 0, &turned, &behind));
        ck_assert(!hides_from(5, 0, 0, &turned, &beside));
    }
}
END_TEST

START_TEST(segments_and_points_cast_no_shadow)
{
    const occ_box segment = {{0, 0, 0}, {{0, 1, 0}, {0, 2, 0}, {0, 0, 0}}};
    const occ_box point = {{0, 0, 0}, {{0}}};
    ck_assert_uint_eq(planes_from(5, 1, 2, &segment), 0);
    ck_assert_uint_eq(planes_from(5, 1, 2, &point), 0);
}
END_TEST

// At half way it spans |y|, |z| and |y - z| up to 2.
START_TEST(three_axes_in_one_plane_hide_what_their_hexagon_hides)
{
    const occ_box hexagon = {{0, 0, 0}, {{0, 1, 0}, {0, 0, 1}, {0, 1, 1}}};
    for (int i = 0; i < 400; i++) {
        int column = i % 20, line = i / 20;
        float y = 0.5f * (float)column - 5, z = 0.5f * (float)line - 5;
        float most = fmaxf(fmaxf(fabsf(y), fabsf(z)), fabsf(y - z));
        occ_box object = kit_cube(-5, y, z, 0.01f);
        ck_assert_msg(hides_from(5, 0, 0, &hexagon, &object) == (most < 4), "%g, %g", (double)y,
                      (double)z);
    }
}
END_TEST

START_TEST(mirrored_and_sheared_boxes_hide_as_what_they_are)
{
    const occ_box mirrored = {{0, 0, 0}, {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const occ_box sheared = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {3, 0, 1}}}; // x - 3z in [-1, 1]
    occ_box aslant = kit_cube(-5, -4, -3, 0.5f), behind = kit_cube(-20, 0, 0, 0.5f);
    const occ_box bounds = {{0, 0, 0}, {{4, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    occ_box below = kit_cube(2, -5, -0.8f, 0.1f);
    ck_assert(hides_from(5, 4, 3, &mirrored, &aslant));
    ck_assert(hides_from(20, 0, 0, &sheared, &behind));
    ck_assert(!hides_from(2, 9, -0.8, &sheared, &below)); // past its slope
    ck_assert(hides_from(2, 9, -0.8, &bounds, &below));
}
END_TEST

START_TEST(what_lies_in_the_surface_of_an_occluder_stays_visible)
{
    const occ_box decal = {{1, 0, 0}, {{0, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}}};
    const occ_box within = {{0.5f, 0, 0}, {{0, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}}};
    const occ_box flush = {{0.5f, 0, 0}, {{0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}}};
    ck_assert(!hides_from(5, 0, 0, &cube, &decal));
    ck_assert(!hides_from(5, 0, 0, &cube, &flush));
    ck_assert(!hides_from(5, 0, 0, &cube, &cube));
    ck_assert(!hides_from(5, 0, 0, &sheet, &sheet));
    ck_assert(hides_from(5, 0, 0, &cube, &within));
}
END_TEST

// A wall of 2 km next to the eye: a millionth of it is more than what its bound has to spare.
START_TEST(a_large_occluder_next_to_the_eye_ends_where_it_ends)
{
    const occ_box wall = {{0, 0, 0}, {{1000, 0, 0}, {0, 1000, 0}, {0, 0, 1000}}};
    for (int i = 0; i < 2; i++) { // before and behind
        float more = i ? -0x1p-11f : 0x1p-11f;
        occ_box by_its_face = {{1000 + more, 0, 0}, {{0}}};
        occ_box by_its_edge = {{999, 1001 + more, 0}, {{0}}};
        ck_assert(hides_from(1001, 0, 0, &wall, &by_its_face) == (i == 1));
        ck_assert(hides_from(1001, 999, 0, &wall, &by_its_edge) == (i == 1));
    }
}
END_TEST

// Where products of doubles lose their sign, a sheet shows neither side for certain.
START_TEST(an_eye_of_denormal_doubles_casts_no_false_shadow)
{
    kit_random random = {31};
    for (int i = 0; i < WORLD_SHARE(5000); i++) {
        duel d;
        const double nothing[3] = {0, 0, 0};
        double size = world_scale(&random, 1e-38, 1e-30);
        d.occluder = world_box(&random, WORLD_SHEET, nothing, size);
        double share[3], product = world_scale(&random, 1e-322, 1e-310);
        double along = product / (size * size * size);
        for (int k = 0; k < 3; k++)
            share[k] = world_between(&random, -along, along);
        for (int j = 0; j < 3; j++) { // in the sheet, as far as doubles can tell
            d.eye[j] = 0.0;
            for (int k = 0; k < 3; k++)
                d.eye[j] += share[k] * (double)d.occluder.axis[k][j];
        }
        d.object = world_box(&random, WORLD_POINT, nothing, 1);
        for (int j = 0; j < 3; j++)
            d.object.center[j] = kit_between(&random, -1, 1);
        occ_frame frame = verdict_frame_at(d.eye);
        if (!verdict_hides(&frame, &d.occluder, &d.object)) continue;
        oracle *judge = oracle_of_eye(d.eye);
        ck_assert_int_eq(oracle_box(judge, &d.object, &d.occluder), ORACLE_HIDDEN);
        oracle_free(judge);
    }
}
END_TEST

// Where floats are denormal nothing is proportional any more: the bound's floor has to do, and
// leaves all visible.
START_TEST(no_shadow_of_denormal_boxes_holds_what_can_be_seen)
{
    kit_random random = {41};
    tally sum = {0, 0, 0};
    for (unsigned i = 0; i < WORLD_SHARE(DUELS / 4); i++) {
        duel d = {.eye = {0, 0, 0}};
        make_duel(&random, &d, world_scale(&random, 1e-44, 1e-36));
        occ_frame frame = verdict_frame_at(d.eye);
        oracle *judge = oracle_of_eye(d.eye);
        fight(&d, &frame, judge, i, &sum);
        oracle_free(judge);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shadow");
    TCase *duels = tcase_create("duels");
    tcase_add_loop_test(duels, no_shadow_holds_what_can_be_seen_and_clear_cases_are_found, 0, 4);
    tcase_add_loop_test(duels, no_shadow_from_a_derived_eye_holds_what_can_be_seen, 0, 2);
    tcase_add_loop_test(duels, no_parallel_shadow_holds_what_can_be_seen_and_clear_cases_are_found,
                        0, 2);
    suite_add_tcase(suite, duels);
    TCase *by_hand = tcase_create("by hand");
    tcase_add_test(by_hand, a_shadow_has_5_planes_for_one_face_8_for_two_and_9_for_three);
    tcase_add_test(by_hand, an_eye_in_or_on_an_occluder_has_no_shadow);
    tcase_add_test(by_hand, an_eye_level_with_a_face_loses_that_face_alone);
    tcase_add_test(by_hand, an_eye_in_line_with_an_edge_or_next_to_a_corner_still_has_a_shadow);
    tcase_add_test(by_hand, a_sheet_hides_from_both_sides_and_nothing_edge_on);
    tcase_add_test(by_hand, zero_axes_in_any_place_make_the_same_sheet);
    tcase_add_test(by_hand, segments_and_points_cast_no_shadow);
    tcase_add_test(by_hand, three_axes_in_one_plane_hide_what_their_hexagon_hides);
    tcase_add_test(by_hand, mirrored_and_sheared_boxes_hide_as_what_they_are);
    tcase_add_test(by_hand, what_lies_in_the_surface_of_an_occluder_stays_visible);
    tcase_add_test(by_hand, a_large_occluder_next_to_the_eye_ends_where_it_ends);
    tcase_add_test(by_hand, an_eye_of_denormal_doubles_casts_no_false_shadow);
    tcase_add_test(by_hand, no_shadow_of_denormal_boxes_holds_what_can_be_seen);
    suite_add_tcase(suite, by_hand);
    return test_run_suite(suite);
}
