// SPDX-License-Identifier: Apache-2.0
// The scenes of the error report: scaled, cut, told apart.
#include "error_scene.h"
#include "kit_obs.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

// Every fourth occluder is a sheet in the middle of its box instead.
static obs_scene made(const char *kind, uint32_t count)
{
    static const float sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    obs_scene scene;
    ck_assert(scenes_make(kind, count, 7, &scene));
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene.occluder_count; i++) {
        const obs_occluder *from = &scene.occluders[i];
        occ_sheet sheet = {.corner_count = 4, .sides = (occ_sides)(i / 4 % 2)};
        for (int c = 0; c < 4; c++)
            for (int k = 0; k < 3; k++)
                sheet.corner[c][k] = from->box.center[k] + sign[c][0] * from->box.axis[0][k] +
                                     sign[c][1] * from->box.axis[1][k];
        if (i % 4)
            scene.occluders[kept++] = *from;
        else
            obs_add_sheet(&scene, &sheet, from->owner);
    }
    scene.occluder_count = kept;
    ck_assert(scene.sheet_count > 0 && !scene.out_of_memory);
    return scene;
}

static obs_scene scaled_by(const obs_scene *scene, double factor)
{
    obs_scene result;
    ck_assert(error_scene_scale(scene, factor, &result));
    return result;
}

// The mask of a frame, by every occluder.
static void cull(const obs_scene *scene, const obs_frame *frame, uint32_t *mask, size_t words)
{
    occ_scene *built = kit_obs_scene(scene, NULL, NULL, NULL);
    double eye[3];
    occ_camera_desc camera = kit_obs_camera(frame, eye);
    const occ_view_desc plain = {.backend = OCC_BACKEND_PLAIN};
    const occ_cull_desc all = {.method = OCC_METHOD_PAIRWISE};
    occ_view *view;
    size_t count;
    ck_assert_int_eq(occ_view_create(&plain, &view), OCC_SUCCESS);
    ck_assert_int_eq(occ_cull(view, built, &camera, &all), OCC_SUCCESS);
    ck_assert_int_eq(occ_view_read_mask(view, mask, words, &count), OCC_SUCCESS);
    ck_assert_uint_eq(count, words);
    occ_view_destroy(view);
    occ_scene_destroy(built);
}

static void assert_times(float value, double factor, float scaled)
{
    ck_assert_msg((double)scaled == (double)value * factor, "%a times %a became %a", (double)value,
                  factor, (double)scaled);
}

START_TEST(power_of_two_scales_every_length_exactly)
{
    obs_scene scene = made("city", 200), large = scaled_by(&scene, 128);
    ck_assert_uint_eq(large.object_count, scene.object_count);
    ck_assert_uint_eq(large.occluder_count, scene.occluder_count);
    ck_assert_uint_eq(large.frame_count, scene.frame_count);
    for (uint32_t i = 0; i < scene.object_count; i++)
        for (int k = 0; k < 3; k++) {
            assert_times(scene.objects[i].center[k], 128, large.objects[i].center[k]);
            for (int a = 0; a < 3; a++)
                assert_times(scene.objects[i].axis[a][k], 128, large.objects[i].axis[a][k]);
        }
    for (uint32_t i = 0; i < scene.occluder_count; i++) {
        ck_assert_uint_eq(large.occluders[i].owner, scene.occluders[i].owner);
        assert_times(scene.occluders[i].box.center[1], 128, large.occluders[i].box.center[1]);
        assert_times(scene.occluders[i].box.axis[2][2], 128, large.occluders[i].box.axis[2][2]);
    }
    ck_assert_uint_eq(large.sheet_count, scene.sheet_count);
    for (uint32_t i = 0; i < scene.sheet_count; i++) {
        const obs_sheet *from = &scene.sheets[i], *to = &large.sheets[i];
        ck_assert_uint_eq(to->owner, from->owner);
        ck_assert_int_eq(to->sheet.sides, from->sheet.sides);
        ck_assert_uint_eq(to->sheet.corner_count, 4);
        for (int k = 0; k < 12; k++)
            assert_times(from->sheet.corner[k / 3][k % 3], 128, to->sheet.corner[k / 3][k % 3]);
    }
    const obs_frame *before = &scene.frames[9], *after = &large.frames[9];
    for (int k = 0; k < 3; k++) {
        assert_times(before->eye[k], 128, after->eye[k]);
        assert_times(before->dir[k], 1, after->dir[k]);
        assert_times(before->view[12 + k], 128, after->view[12 + k]);
        assert_times(before->view[4 * k], 1, after->view[4 * k]);
    }
    for (int i = 0; i < 16; i++)
        assert_times(before->proj[i], i == 14 ? 128 : 1, after->proj[i]);
    obs_free(&scene);
    obs_free(&large);
}
END_TEST

START_TEST(scaled_scene_is_seen_as_before)
{
    obs_scene scene = made("soup", 300);
    const double factors[] = {1.0 / 128, 128};
    size_t words = OCC_MASK_WORDS(scene.object_count);
    uint32_t *before = calloc(words, sizeof *before), *after = calloc(words, sizeof *after);
    for (int f = 0; f < 2; f++) {
        obs_scene scaled = scaled_by(&scene, factors[f]);
        for (uint32_t frame = 0; frame < scene.frame_count; frame += 13) {
            cull(&scene, &scene.frames[frame], before, words);
            cull(&scaled, &scaled.frames[frame], after, words);
            ck_assert_mem_eq(before, after, words * sizeof *before);
        }
        obs_free(&scaled);
    }
    free(before);
    free(after);
    obs_free(&scene);
}
END_TEST

START_TEST(orthographic_camera_keeps_its_picture)
{
    obs_scene scene = made("soup", 300);
    obs_frame frame = scene.frames[0];
    memset(frame.proj, 0, sizeof frame.proj);
    frame.proj[0] = 0.0625f;
    frame.proj[5] = 0.125f;
    frame.proj[10] = -0.03125f;
    frame.proj[14] = -1.0f;
    frame.proj[15] = 1.0f;
    scene.frames[0] = frame;
    obs_scene scaled = scaled_by(&scene, 64);
    float before[16], after[16];
    obs_view_projection(&scene.frames[0], before);
    obs_view_projection(&scaled.frames[0], after);
    for (int i = 0; i < 16; i++) // what it does to a length is divided by 64, the rest stays
        assert_times(before[i], i < 12 && i % 4 != 3 ? 1.0 / 64 : 1, after[i]);
    obs_free(&scene);
    obs_free(&scaled);
}
END_TEST

START_TEST(identity_is_of_the_content)
{
    obs_scene scene = made("city", 100), again = made("city", 100);
    uint64_t identity = error_scene_identity(&scene);
    ck_assert_uint_eq(identity, error_scene_identity(&again));
    float *places[] = {&again.objects[50].center[0],
                       &again.objects[160].axis[2][2],
                       &again.occluders[3].box.axis[1][0],
                       &again.sheets[2].sheet.corner[0][0],
                       &again.sheets[2].sheet.corner[3][2],
                       &again.frames[59].eye[2],
                       &again.frames[0].dir[0],
                       &again.frames[7].view[15],
                       &again.frames[7].proj[0]};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        float before = *places[i];
        *places[i] += 1;
        ck_assert_msg(error_scene_identity(&again) != identity, "place %zu does not count", i);
        *places[i] = before;
    }
    again.occluders[0].owner ^= 1;
    ck_assert_uint_ne(identity, error_scene_identity(&again));
    again.occluders[0].owner ^= 1;
    ck_assert_uint_eq(identity, error_scene_identity(&again));
    uint32_t *numbers[] = {&again.sheets[1].owner, &again.sheets[1].sheet.corner_count,
                           &again.sheet_count};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        --*numbers[i];
        ck_assert_msg(error_scene_identity(&again) != identity, "number %zu does not count", i);
        ++*numbers[i];
    }
    again.sheets[0].sheet.sides = OCC_SIDES_FRONT;
    ck_assert_uint_ne(identity, error_scene_identity(&again));
    again.sheets[0].sheet.sides = OCC_SIDES_BOTH;
    ck_assert_uint_eq(identity, error_scene_identity(&again));
    again.frame_count--;
    ck_assert_uint_ne(identity, error_scene_identity(&again));
    again.frame_count++;
    obs_free(&scene);
    obs_free(&again);
}
END_TEST

// On every machine, byte order and compiler: published figures hang on it.
START_TEST(identity_is_the_same_everywhere)
{
    obs_scene scene = {0};
    const occ_box box = {{1, 2, 3}, {{1, 0, 0}, {0, 0.5f, 0}, {0, 0, -0.0f}}};
    ck_assert_uint_eq(obs_add_object(&scene, &box), 0);
    ck_assert_uint_eq(obs_add_occluder(&scene, &box, 0), 0);
    ck_assert_uint_eq(error_scene_identity(&scene), UINT64_C(0x3dde4c6930079895));
    obs_free(&scene);
}
END_TEST

START_TEST(cut_scene_has_the_frames_asked_for)
{
    obs_scene scene = made("city", 100), part;
    const uint32_t frames[] = {0, 20, 59};
    ck_assert(error_scene_cut(&scene, frames, 3, &part));
    ck_assert_uint_eq(part.frame_count, 3);
    ck_assert_ptr_eq(part.objects, scene.objects);
    for (int i = 0; i < 3; i++)
        ck_assert_mem_eq(&part.frames[i], &scene.frames[frames[i]], sizeof(obs_frame));
    free(part.frames);
    obs_free(&scene);
}
END_TEST

START_TEST(scene_is_made_where_no_folder_has_it)
{
    obs_scene scene, same;
    ck_assert_int_eq(error_scene_load(NULL, "city_1000", &scene), ERROR_LOADED);
    ck_assert(scenes_make("city", 1000, 2, &same));
    ck_assert_uint_eq(error_scene_identity(&scene), error_scene_identity(&same));
    obs_free(&scene);
    ck_assert_int_eq(error_scene_load("/absent", "city_1000", &scene), ERROR_LOADED);
    ck_assert_uint_eq(error_scene_identity(&scene), error_scene_identity(&same));
    obs_free(&scene);
    obs_free(&same);
    ck_assert_int_eq(error_scene_load(NULL, "sponza", &scene), ERROR_ABSENT);
    ck_assert_int_eq(error_scene_load("/absent", "nameless", &scene), ERROR_ABSENT);
    for (const error_source *source = error_sources; source->name; source++)
        ck_assert(!source->kind || scenes_find(source->kind));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("error_scene");
    TCase *scale = tcase_create("scale");
    tcase_add_test(scale, power_of_two_scales_every_length_exactly);
    tcase_add_test(scale, scaled_scene_is_seen_as_before);
    tcase_add_test(scale, orthographic_camera_keeps_its_picture);
    suite_add_tcase(suite, scale);
    TCase *parts = tcase_create("parts");
    tcase_add_test(parts, identity_is_of_the_content);
    tcase_add_test(parts, identity_is_the_same_everywhere);
    tcase_add_test(parts, cut_scene_has_the_frames_asked_for);
    tcase_add_test(parts, scene_is_made_where_no_folder_has_it);
    suite_add_tcase(suite, parts);
    return test_run_suite(suite);
}
