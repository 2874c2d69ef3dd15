// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// timeout: 120
// Whole frames with sheets of every shape: no backend and no instruction set hides what can be seen
// past the sheets' own triangles, all say the same, and can say why.
#include <gmp.h>

#include "kit_sheets.h"
#include "sheet_sight.h"
#include "sheet_stage.h"
#include "support.h"
#include "view_data.h"
#include "worlds.h"

#include <stdlib.h>

static const occ_object nobody = {0, 0};
static kit_crew crew;

static void set_up(void)
{
    kit_crew_gather(&crew);
}

static void tear_down(void)
{
    kit_crew_dismiss(&crew);
}

// --- sheets of every shape -----------------------------------------------------------------------

// Triangles, octagons and what is between, bent by up to a thousandth, some with a notch.
static occ_sheet any_sheet(kit_random *random)
{
    float center[3];
    for (int j = 0; j < 3; j++)
        center[j] = kit_between(random, -90, 90);
    uint32_t corners = 3 + kit_below(random, 6);
    occ_sheet sheet = kit_round_sheet(random, corners, center, kit_between(random, 5, 45));
    for (uint32_t i = 0; i < corners && kit_below(random, 2); i++)
        for (int j = 0; j < 3; j++)
            sheet.corner[i][j] += kit_between(random, -0.03f, 0.03f);
    if (corners > 3 && !kit_below(random, 4))
        for (int j = 0; j < 3; j++)
            sheet.corner[1][j] = 0.6f * sheet.corner[1][j] + 0.4f * center[j];
    if (kit_below(random, 2)) sheet.sides = OCC_SIDES_FRONT;
    return sheet;
}

typedef struct stand {
    occ_scene *scene;
    occ_object objects[OBJECTS];
    occ_sheet sheets[OCCLUDERS];
    occ_object owners[OCCLUDERS];
    occ_occluder handles[OCCLUDERS];
} stand;

static stand *make_stand(uint64_t seed)
{
    stand *s = calloc(1, sizeof *s);
    ck_assert_ptr_nonnull(s);
    kit_random random = {seed};
    s->scene = stage_scene(seed, s->objects);
    for (int i = 0; i < OCCLUDERS; i++) {
        s->sheets[i] = any_sheet(&random);
        if (i % 4 == 0) s->owners[i] = s->objects[kit_below(&random, OBJECTS)];
    }
    ck_assert_int_eq(occ_scene_add_sheets(s->scene, s->sheets, s->owners, OCCLUDERS, s->handles),
                     OCC_SUCCESS);
    stage_commit(s->scene);
    return s;
}

static void drop_stand(stand *s)
{
    occ_scene_destroy(s->scene);
    free(s);
}

static bool owns(const stand *s, int sheet, uint32_t object)
{
    return s->owners[sheet].index == object + 1;
}

// Whether any sheet of others hides a point, by its own triangles.
static bool point_is_hidden(const stand *s, const sight_from *from, uint32_t object,
                            const double point[3])
{
    for (int k = 0; k < OCCLUDERS; k++)
        if (!owns(s, k, object) && sight_is_hidden(from, &s->sheets[k], 0, point)) return true;
    return false;
}

// Whether a point is in the picture, or may be.
static bool point_is_shown(const occ_view *view, const double point[3])
{
    const occ_camera *camera = &view->frame.camera;
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (!(camera->planes >> p & 1u)) continue;
        double at = camera->plane[p][3], size = fabs(at);
        for (int j = 0; j < 3; j++) {
            double term = camera->plane[p][j] * (point[j] - camera->eye[j]);
            at += term;
            size += fabs(term);
        }
        if (at < size * 1e-6) return false;
    }
    return true;
}

// No point of an object that is not visible can be seen in the picture. Returns how many were
// asked.
static uint32_t look_at(const stand *s, const occ_view *view, uint32_t object, kit_random *random)
{
    const occ_camera *camera = &view->frame.camera;
    sight_from from = {.direction = camera->orthographic};
    memcpy(from.at, from.direction ? camera->toward : camera->eye, sizeof from.at);
    occ_box box;
    uint32_t asked = 0;
    ck_assert_int_eq(occ_scene_box(s->scene, s->objects[object], &box), OCC_SUCCESS);
    for (uint32_t k = 0; k < 14; k++) {
        double point[3];
        for (int j = 0; j < 3; j++)
            point[j] = (double)box.center[j];
        for (uint32_t axis = 0; axis < 3; axis++) {
            double along =
                k < 8 ? (k >> axis & 1u ? -0.9999 : 0.9999) : world_between(random, -1, 1);
            for (int j = 0; j < 3; j++)
                point[j] += along * (double)box.axis[axis][j];
        }
        if (!point_is_shown(view, point)) continue;
        asked++;
        KIT_CHECK(point_is_hidden(s, &from, object, point), "object %u is hidden, but can be seen",
                  object);
    }
    return asked;
}

enum { LOOK_AT = 11 }; // one of so many

START_TEST(what_sheets_hide_cannot_be_seen_past_their_triangles)
{
    occ_cull_desc knobs = stage_knobs[_i];
    kit_random random = {17};
    uint32_t asked = 0;
    knobs.tolerance = 0.0f;
    for (uint64_t seed = 1; seed < 4; seed++) {
        stand *s = make_stand(seed);
        for (uint32_t f = 0; f < FRAMES; f++) {
            occ_camera_desc camera = stage_camera(f);
            uint32_t *mask = kit_crew_cull(&crew, s->scene, &camera, &knobs);
            for (uint32_t i = f % LOOK_AT; i < OBJECTS; i += LOOK_AT)
                if (!(mask[i / 32] >> i % 32 & 1u)) asked += look_at(s, crew.view[0], i, &random);
            free(mask);
        }
        drop_stand(s);
    }
    ck_assert_uint_gt(asked, 1500 / OCC_TEST_SLOWNESS);
}
END_TEST

START_TEST(frames_with_sheets_are_the_same_in_every_instruction_set)
{
    stand *s = make_stand((uint64_t)_i + 5);
    for (uint32_t v = 0; occ_lanes_get(v); v++) {
        occ_view *view = NULL;
        occ_view_desc desc = {.backend = OCC_BACKEND_OPENMP, .threads = 2};
        ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
        view->frame.lanes = occ_lanes_get(v);
        view->backend->ops->destroy(view->backend);
        ck_assert_int_eq(
            occ_backend_openmp_create(&view->hooks, 2, occ_lanes_get(v), &view->backend),
            OCC_SUCCESS);
        for (uint32_t f = 0; f < FRAMES; f++)
            for (int k = 0; k < KNOBS; k++) {
                occ_camera_desc camera = stage_camera(f);
                kit_cull(crew.view[0], s->scene, &camera, &stage_knobs[k]);
                kit_cull(view, s->scene, &camera, &stage_knobs[k]);
                kit_same_answers(crew.view[0], view, occ_lanes_get(v)->name);
            }
        occ_view_destroy(view);
    }
    drop_stand(s);
}
END_TEST

// --- explanations --------------------------------------------------------------------------------

// A scene with the same objects, and of the sheets only these.
static bool hidden_by(const stand *s, const occ_occluder *named, size_t count, uint64_t seed,
                      const occ_camera_desc *camera, uint32_t object, bool *own)
{
    static occ_object objects[OBJECTS];
    const occ_cull_desc knobs = {.method = OCC_METHOD_PAIRWISE};
    occ_scene *scene = stage_scene(seed, objects);
    *own = false;
    for (size_t n = 0; n < count; n++)
        for (int k = 0; k < OCCLUDERS; k++) {
            if (!kit_same_bits(&named[n], &s->handles[k], sizeof *named)) continue;
            *own = *own || owns(s, k, object);
            ck_assert_int_eq(occ_scene_add_sheet(scene, &s->sheets[k], nobody, NULL), OCC_SUCCESS);
        }
    stage_commit(scene);
    kit_cull(crew.view[1], scene, camera, &knobs);
    occ_scene_destroy(scene);
    return !occ_view_is_visible(crew.view[1], objects[object]);
}

START_TEST(explanation_names_the_sheets)
{
    const uint64_t seed = 2;
    const occ_cull_desc knobs = {.method = OCC_METHOD_SINGLE};
    stand *s = make_stand(seed);
    uint32_t explained = 0;
    for (uint32_t f = 0; f < FRAMES; f++) {
        occ_camera_desc camera = stage_camera(f);
        kit_cull(crew.view[0], s->scene, &camera, &knobs);
        for (uint32_t i = 0; i < OBJECTS; i += 37) {
            occ_occluder named[8];
            size_t count = 0;
            occ_fate fate;
            bool own;
            ck_assert_int_eq(
                occ_view_explain(crew.view[0], s->scene, s->objects[i], &fate, named, 8, &count),
                OCC_SUCCESS);
            if (fate != OCC_FATE_HIDDEN) continue;
            explained++;
            KIT_CHECK(count && hidden_by(s, named, count, seed, &camera, i, &own) && !own,
                      "object %u is not hidden by what is named", i);
        }
    }
    ck_assert_uint_gt(explained, 20);
    drop_stand(s);
}
END_TEST

static TCase *shapes(void)
{
    TCase *tcase = tcase_create("shapes");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_loop_test(tcase, what_sheets_hide_cannot_be_seen_past_their_triangles, 0, KNOBS);
    tcase_add_test(tcase, explanation_names_the_sheets);
    return tcase;
}

static TCase *vectors(void)
{
    TCase *tcase = tcase_create("vectors");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_loop_test(tcase, frames_with_sheets_are_the_same_in_every_instruction_set, 0, 2);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("sheet_frames");
    suite_add_tcase(suite, shapes());
    suite_add_tcase(suite, vectors());
    return test_run_suite(suite);
}
