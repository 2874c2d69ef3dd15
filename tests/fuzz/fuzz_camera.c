// SPDX-License-Identifier: Apache-2.0
// Bytes as a camera and as knobs: any of them is culled with or refused by name, and the backends
// agree.
#include "bytes.h"

#include <occlude/occlude.h>

enum { OBJECTS = 300, WORDS = (OBJECTS + 31) / 32, VIEWS = 2 };

static occ_scene *scene;
static occ_view *views[VIEWS]; // plain, OpenMP

// Boxes of many sizes in and far around the unit cube, every third an occluder too.
static void make_scene(void)
{
    occ_scene_desc desc = {.leaf_objects = 2};
    FUZZ_CHECK(!occ_scene_create(&desc, &scene));
    uint32_t state = 1;
    for (int i = 0; i < OBJECTS; i++) {
        occ_box box;
        float numbers[12], scale = i % 10 ? 1.0f : 1e6f;
        for (int k = 0; k < 12; k++) {
            state = state * 1664525u + 1013904223u;
            numbers[k] = ((float)(state >> 8) * 0x1p-23f - 1.0f) * (k < 3 ? 5.0f : 0.4f) * scale;
        }
        if (i % 7 == 0) numbers[3 + i % 9] = 0.0f;
        memcpy(&box, numbers, sizeof box);
        occ_object object;
        FUZZ_CHECK(!occ_scene_add(scene, &box, &object));
        if (i % 3) continue;
        FUZZ_CHECK(!occ_scene_add_occluder(scene, &box, object, NULL));
    }
    FUZZ_CHECK(!occ_scene_commit(scene));
    for (int v = 0; v < VIEWS; v++) {
        occ_view_desc view = {.backend = v ? OCC_BACKEND_OPENMP : OCC_BACKEND_PLAIN, .threads = 2};
        FUZZ_CHECK(!occ_view_create(&view, &views[v]));
    }
}

static void read_camera(fuzz_bytes *from, occ_camera_desc *camera, double eye[3], double origin[3])
{
    uint8_t flags = fuzz_byte(from);
    camera->depth = (occ_depth)(flags % 4);
    for (int k = 0; k < 16; k++)
        camera->view_projection[k] = fuzz_float(from);
    camera->eye = flags & 4 ? eye : NULL;
    camera->origin = flags & 8 ? origin : NULL;
    for (int j = 0; j < 3; j++) {
        eye[j] = camera->eye ? fuzz_double(from) : 0.0;
        origin[j] = camera->origin ? fuzz_double(from) : 0.0;
    }
}

static occ_cull_desc read_knobs(fuzz_bytes *from)
{
    occ_cull_desc knobs = {.method = (occ_method)(fuzz_byte(from) % 4)};
    knobs.grain = fuzz_byte(from);
    knobs.max_occluders = fuzz_byte(from);
    knobs.min_area = fuzz_float(from);
    knobs.max_splits = fuzz_byte(from);
    knobs.preset = (occ_preset)(fuzz_byte(from) % 4);
    knobs.tolerance = (float)fuzz_byte(from) * (0.1f / 250.0f);
    return knobs;
}

static void read_mask(const occ_view *view, uint32_t *mask)
{
    size_t count;
    FUZZ_CHECK(!occ_view_read_mask(view, mask, WORDS, &count) && count == WORDS);
    occ_view_stats s;
    FUZZ_CHECK(!occ_view_get_stats(view, &s) && s.objects == OBJECTS);
    FUZZ_CHECK(s.objects == s.walk_outside + s.walk_hidden + s.tested);
    FUZZ_CHECK(s.tested == s.test_outside + s.test_hidden + s.visible);
}

// What the frustum leaves is all that can be visible.
static void check_against_frustum(const occ_camera_desc *camera, const occ_cull_desc *knobs,
                                  const uint32_t *mask)
{
    occ_cull_desc frustum = *knobs;
    uint32_t all[WORDS];
    frustum.method = OCC_METHOD_FRUSTUM;
    FUZZ_CHECK(!occ_cull(views[0], scene, camera, &frustum));
    read_mask(views[0], all);
    for (int w = 0; w < WORDS; w++)
        FUZZ_CHECK(!(mask[w] & ~all[w]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!scene) make_scene();
    fuzz_bytes from = {data, size};
    occ_camera_desc camera;
    double eye[3], origin[3];
    read_camera(&from, &camera, eye, origin);
    occ_cull_desc knobs = read_knobs(&from);
    uint32_t masks[VIEWS][WORDS];
    occ_result result = occ_cull(views[0], scene, &camera, &knobs);
    FUZZ_CHECK(occ_cull(views[1], scene, &camera, &knobs) == result);
    if (result) {
        FUZZ_CHECK(result == OCC_ERROR_NOT_FINITE || result == OCC_ERROR_OUT_OF_RANGE ||
                   result == OCC_ERROR_INVALID_ARGUMENT || result == OCC_ERROR_DEGENERATE_CAMERA);
        FUZZ_CHECK(occ_view_read_mask(views[0], masks[0], WORDS, NULL) == OCC_ERROR_NO_RESULT);
        return 0;
    }
    read_mask(views[0], masks[0]);
    read_mask(views[1], masks[1]);
    FUZZ_CHECK(!memcmp(masks[0], masks[1], sizeof masks[0]));
    if (knobs.method == OCC_METHOD_SINGLE) check_against_frustum(&camera, &knobs, masks[0]);
    return 0;
}
