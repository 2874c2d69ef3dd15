// SPDX-License-Identifier: Apache-2.0
// Boxes of a mesh at other places: bounds still hold every vertex there, inner boxes are still
// inside, and neither has become much worse.
#include "shapes.h"
#include "support.h"

#include <math.h>
#include <stdio.h>

static shapes mesh, placed;
static kit_log record;
static kit_heap heap;

static occ_soup_work watched(void)
{
    kit_forget(&record);
    heap = (kit_heap){0};
    return (occ_soup_work){.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
}

// --- places --------------------------------------------------------------------------------------

// A turn by quaternion, scaled and moved, at times mirrored or far from the origin.
static void random_place(kit_random *random, float model[16])
{
    double q[4], sum = 0.0;
    for (int i = 0; i < 4; i++) {
        q[i] = (double)kit_between(random, -1, 1);
        sum += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(sum);
    double s = ldexp(1.0 + (double)kit_between(random, 0, 1), (int)kit_below(random, 20) - 10);
    const double turn[3][3] = {{1 - 2 * (q[2] * q[2] + q[3] * q[3]),
                                2 * (q[1] * q[2] - q[0] * q[3]), 2 * (q[1] * q[3] + q[0] * q[2])},
                               {2 * (q[1] * q[2] + q[0] * q[3]),
                                1 - 2 * (q[1] * q[1] + q[3] * q[3]),
                                2 * (q[2] * q[3] - q[0] * q[1])},
                               {2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
                                1 - 2 * (q[1] * q[1] + q[2] * q[2])}};
    float reach = (float)s * ldexpf(1.0f, (int)kit_below(random, 12));
    double mirror = kit_below(random, 4) ? 1.0 : -1.0;
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++)
            model[4 * c + r] = r == 3   ? (c == 3 ? 1.0f : 0.0f)
                               : c == 3 ? kit_between(random, -reach, reach)
                                        : (float)(s * (c == 0 ? mirror : 1.0) * turn[r][c]);
}

// What whoever draws the mesh does: floats all the way.
static void place_mesh(const float model[16])
{
    placed = mesh;
    for (uint32_t i = 0; i < 3 * mesh.triangles; i++)
        for (int r = 0; r < 3; r++) {
            const float *p = mesh.at[i];
            placed.at[i][r] =
                model[r] * p[0] + model[4 + r] * p[1] + model[8 + r] * p[2] + model[12 + r];
        }
}

static void make_mesh(kit_random *random)
{
    shapes_reset(&mesh);
    uint32_t kind = kit_below(random, 3);
    if (kind == 0) shapes_round(&mesh, 5 + (int)kit_below(random, 6), 0.0f);
    if (kind == 1) shapes_round(&mesh, 5 + (int)kit_below(random, 4), 0.3f);
    float low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = -kit_between(random, 0.1f, 1);
        high[k] = kit_between(random, 0.1f, 1);
    }
    if (kind == 2) shapes_box(&mesh, low, high);
}

static double measure(const occ_box *box)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const float *a = box->axis[1], *b = box->axis[2];
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double minor = (double)a[i] * (double)b[j] - (double)a[j] * (double)b[i];
        sum += (double)box->axis[0][k] * minor;
    }
    return fabs(sum);
}

// --- bounds --------------------------------------------------------------------------------------

START_TEST(bounds_hold_every_vertex_where_it_was_put)
{
    kit_random random = {31};
    double carried_sum = 0.0;
    uint32_t naive = 0;
    enum { ROUNDS = 300 };
    for (int round = 0; round < ROUNDS; round++) {
        float model[16];
        occ_box bounds, box, best;
        make_mesh(&random);
        random_place(&random, model);
        place_mesh(model);
        occ_soup local = shapes_soup(&mesh), world = shapes_soup(&placed);
        ck_assert(!occ_bounds_of_soup(&local, NULL, &bounds));
        ck_assert(!occ_bounds_of_instance(&world, model, &bounds, NULL, &box));
        KIT_CHECK(!occ_verify_bounds(&world, &box, NULL, NULL), "round %d: outside", round);
        ck_assert(!occ_bounds_of_soup(&world, NULL, &best));
        double ratio = measure(&box) / measure(&best);
        KIT_CHECK(ratio < 1.1, "round %d: %.3f times as large", round, ratio);
        carried_sum += ratio;
        // What is carried without looking at the vertices does not hold them.
        float min[3], max[3];
        for (int k = 0; k < 3; k++) {
            min[k] = INFINITY;
            max[k] = -INFINITY;
            for (uint32_t i = 0; i < 3 * mesh.triangles; i++) {
                min[k] = fminf(min[k], mesh.at[i][k]);
                max[k] = fmaxf(max[k], mesh.at[i][k]);
            }
        }
        ck_assert(!occ_box_from_model(model, min, max, &box));
        naive += occ_verify_bounds(&world, &box, NULL, NULL) != OCC_SUCCESS;
    }
    printf("bounds carried: %.4f of those found anew; without a look %u of %d leave vertices out\n",
           carried_sum / ROUNDS, naive, ROUNDS);
    ck_assert_double_le(carried_sum / ROUNDS, 1.01);
    ck_assert_uint_ge(naive, ROUNDS / 2);
}
END_TEST

START_TEST(flat_thin_and_pointlike_meshes_have_bounds_everywhere)
{
    static const float corner[4][3][3] = {{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}},
                                          {{0, 0, 0}, {3, 1, 0}, {6, 2, 0}},
                                          {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}},
                                          {{0, 0, 0}, {1, 0, 1e-6f}, {0, 1, 0}}};
    kit_random random = {32};
    for (int round = 0; round < 800; round++) {
        float model[16];
        occ_box bounds, box;
        shapes_reset(&mesh);
        const float(*c)[3] = corner[round % 4];
        shapes_triangle(&mesh, c[0], c[1], c[2]);
        random_place(&random, model);
        if (round % 5 == 0) // flattened, sheared
            model[round % 3] = model[4 + round % 3] = 0.0f;
        place_mesh(model);
        occ_soup local = shapes_soup(&mesh), world = shapes_soup(&placed);
        ck_assert(!occ_bounds_of_soup(&local, NULL, &bounds));
        ck_assert(!occ_bounds_of_instance(&world, model, &bounds, NULL, &box));
        KIT_CHECK(!occ_verify_bounds(&world, &box, NULL, NULL), "round %d", round);
    }
}
END_TEST

// --- inner boxes ---------------------------------------------------------------------------------

enum { BOXES = 6 };

START_TEST(inner_boxes_are_inside_wherever_the_mesh_is_put)
{
    kit_random random = {33};
    uint32_t had = 0, kept = 0, naive = 0;
    for (int round = 0; round < 250; round++) {
        float model[16];
        size_t count, carried;
        occ_inner_box boxes[BOXES], there[BOXES];
        occ_inner_desc desc = {.max_cells = 8192, .threads = 1};
        make_mesh(&random);
        random_place(&random, model);
        place_mesh(model);
        occ_soup local = shapes_soup(&mesh), world = shapes_soup(&placed);
        ck_assert(!occ_inner_find(&local, &desc, boxes, BOXES, &count, NULL));
        ck_assert(!occ_inner_of_instance(&world, model, boxes, count, &desc, there, &carried));
        KIT_CHECK(!occ_verify_inner(&world, there, carried, &desc, NULL), "round %d", round);
        had += (uint32_t)count;
        kept += (uint32_t)carried;
        for (size_t i = 0; i < carried; i++)
            KIT_CHECK(there[i].closed && there[i].gain > 0.0f, "round %d: box %zu", round, i);
        // Boxes as large as their solid: rounding alone would put triangles into some.
        static const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
        for (size_t i = 0; i < count; i++) {
            float local_to_world[16] = {[15] = 1.0f};
            for (int c = 0; c < 4; c++)
                for (int r = 0; r < 3; r++) {
                    const float *v = c < 3 ? boxes[i].box.axis[c] : boxes[i].box.center;
                    local_to_world[4 * c + r] = model[r] * v[0] + model[4 + r] * v[1] +
                                                model[8 + r] * v[2] +
                                                (c < 3 ? 0.0f : model[12 + r]);
                }
            occ_inner_box moved = boxes[i];
            ck_assert(!occ_box_from_model(local_to_world, low, high, &moved.box));
            naive += occ_verify_inner(&world, &moved, 1, &desc, NULL) != OCC_SUCCESS;
        }
    }
    printf("inner boxes: %u of %u carried; without a look %u are wrong\n", kept, had, naive);
    ck_assert_uint_ge(had, 500);
    ck_assert_uint_ge(kept, had - had / 50);
    ck_assert_uint_ge(naive, had / 20);
}
END_TEST

START_TEST(eye_in_a_room_of_an_instance_leaves_it_empty)
{
    static const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    static const float model[16] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1};
    static const float eye[3] = {10.5f, 20.5f, 30.5f}, outside[3] = {0, 0, 0};
    occ_inner_box box, there;
    size_t count, carried;
    shapes_reset(&mesh);
    shapes_box(&mesh, low, high);
    place_mesh(model);
    occ_soup local = shapes_soup(&mesh), world = shapes_soup(&placed);
    ck_assert(!occ_inner_find(&local, NULL, &box, 1, &count, NULL));
    ck_assert_uint_eq(count, 1);
    occ_inner_desc desc = {.free_points = outside, .free_count = 1};
    ck_assert(!occ_inner_of_instance(&world, model, &box, 1, &desc, &there, &carried));
    ck_assert_uint_eq(carried, 1);
    ck_assert_float_gt((float)measure(&there.box), 7.9f);
    desc.free_points = eye;
    ck_assert(!occ_inner_of_instance(&world, model, &box, 1, &desc, &there, &carried));
    ck_assert_uint_eq(carried, 0);
    // A mesh that is open where it stands has none.
    world.triangle_count--;
    ck_assert(!occ_inner_of_instance(&world, model, &box, 1, NULL, &there, &carried));
    ck_assert_uint_eq(carried, 0);
}
END_TEST

// --- what is refused or fails --------------------------------------------------------------------

static const float still[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1};

static void make_cube(void)
{
    shapes_reset(&mesh);
    shapes_box(&mesh, (float[3]){-1, -1, -1}, (float[3]){1, 1, 1});
}

static void check_refused(const float *model, occ_result want, const char *reason)
{
    occ_box bounds = kit_cube(0, 0, 0, 1), box = bounds;
    occ_inner_box inner = {.box = kit_cube(0, 0, 0, 0.5f)}, there;
    size_t carried = 5;
    occ_soup soup = shapes_soup(&mesh);
    occ_soup_work work = watched();
    ck_assert_int_eq(occ_bounds_of_instance(&soup, model, &bounds, &work, &box), want);
    ck_assert_msg(kit_logged(&record, reason), "%s", record.text);
    occ_inner_desc desc = {.work = watched()};
    ck_assert_int_eq(occ_inner_of_instance(&soup, model, &inner, 1, &desc, &there, &carried), want);
    ck_assert_msg(kit_logged(&record, reason), "%s", record.text);
    ck_assert_uint_eq(carried, 5);
    ck_assert_uint_eq(heap.blocks, 0);
}

START_TEST(bad_matrices_and_boxes_are_refused)
{
    float model[16];
    make_cube();
    check_refused(NULL, OCC_ERROR_INVALID_ARGUMENT, "the matrix is NULL");
    memcpy(model, still, sizeof model);
    model[7] = 0.5f;
    check_refused(model, OCC_ERROR_INVALID_ARGUMENT, "last row");
    model[7] = 0.0f;
    model[13] = NAN;
    check_refused(model, OCC_ERROR_NOT_FINITE, "the matrix: number 13 is nan");
    mesh.at[4][2] = INFINITY;
    check_refused(still, OCC_ERROR_NOT_FINITE, "vertex 4 of triangle 1");
    make_cube();
    occ_soup soup = shapes_soup(&mesh);
    occ_box bounds = kit_cube(0, 0, 0, 1), box;
    bounds.axis[0][1] = NAN;
    occ_soup_work work = watched();
    ck_assert_int_eq(occ_bounds_of_instance(&soup, still, &bounds, &work, &box),
                     OCC_ERROR_NOT_FINITE);
    ck_assert_int_eq(occ_bounds_of_instance(&soup, still, NULL, &work, &box),
                     OCC_ERROR_INVALID_ARGUMENT);
    size_t carried = 5;
    ck_assert_int_eq(occ_inner_of_instance(&soup, still, NULL, 1, NULL, NULL, &carried),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_inner_of_instance(&soup, still, NULL, 0, NULL, NULL, &carried),
                     OCC_SUCCESS);
    ck_assert_uint_eq(carried, 0);
    // Where a box would be beyond what coordinates may be, there is none.
    occ_inner_box inner = {.box = kit_cube(0, 0, 0, 0.5f)}, there;
    memcpy(model, still, sizeof model);
    model[12] = 2e15f;
    ck_assert_int_eq(occ_inner_of_instance(&soup, model, &inner, 1, NULL, &there, &carried),
                     OCC_SUCCESS);
    ck_assert_uint_eq(carried, 0);
}
END_TEST

START_TEST(every_failed_allocation_is_told_and_nothing_leaks)
{
    occ_inner_box box, there;
    size_t count, carried = 5;
    make_cube();
    occ_soup soup = shapes_soup(&mesh);
    ck_assert(!occ_inner_find(&soup, NULL, &box, 1, &count, NULL));
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    uint64_t fail;
    for (fail = 1; result; fail++) {
        occ_inner_desc desc = {.work = watched(), .threads = 1};
        heap.fail_at = fail;
        result = occ_inner_of_instance(&soup, still, &box, 1, &desc, &there, &carried);
        ck_assert(result == OCC_SUCCESS || result == OCC_ERROR_OUT_OF_MEMORY);
        ck_assert(!result || (carried == 5 && kit_logged(&record, "OCC_ERROR_OUT_OF_MEMORY")));
        ck_assert_uint_eq(heap.blocks, 0);
    }
    ck_assert_uint_ge(fail, 10);
    ck_assert_uint_eq(carried, 1);
}
END_TEST

static bool stop(float done, void *user_data)
{
    (void)done;
    (void)user_data;
    return false;
}

START_TEST(carrying_can_be_stopped)
{
    occ_inner_box box = {.box = kit_cube(0, 0, 0, 0.5f)}, there;
    size_t carried = 5;
    occ_box bounds = kit_cube(0, 0, 0, 1), out;
    make_cube();
    occ_soup soup = shapes_soup(&mesh);
    occ_inner_desc desc = {.work = watched()};
    desc.work.progress = stop;
    ck_assert_int_eq(occ_inner_of_instance(&soup, still, &box, 1, &desc, &there, &carried),
                     OCC_ERROR_CANCELLED);
    ck_assert_uint_eq(carried, 5);
    ck_assert_uint_eq(heap.blocks, 0);
    ck_assert_int_eq(occ_bounds_of_instance(&soup, still, &bounds, &desc.work, &out),
                     OCC_ERROR_CANCELLED);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("instances");
    TCase *c = tcase_create("bounds");
    tcase_add_test(c, bounds_hold_every_vertex_where_it_was_put);
    tcase_add_test(c, flat_thin_and_pointlike_meshes_have_bounds_everywhere);
    suite_add_tcase(suite, c);
    c = tcase_create("inner");
    tcase_add_test(c, inner_boxes_are_inside_wherever_the_mesh_is_put);
    tcase_add_test(c, eye_in_a_room_of_an_instance_leaves_it_empty);
    suite_add_tcase(suite, c);
    c = tcase_create("input");
    tcase_add_test(c, bad_matrices_and_boxes_are_refused);
    tcase_add_test(c, every_failed_allocation_is_told_and_nothing_leaks);
    tcase_add_test(c, carrying_can_be_stopped);
    suite_add_tcase(suite, c);
    return test_run_suite(suite);
}
