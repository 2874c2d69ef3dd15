// SPDX-License-Identifier: Apache-2.0
#include "worlds.h"

#include <check.h>
#include <stdlib.h>
#include <string.h>

occ_scene *world_scene(const occ_box *objects, uint32_t object_count,
                       const world_occluder *occluders, uint32_t occluder_count,
                       uint32_t leaf_objects)
{
    occ_scene *scene = NULL;
    occ_scene_desc desc = {.leaf_objects = leaf_objects};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    occ_object *handles = calloc((size_t)object_count + 1, sizeof *handles);
    ck_assert_ptr_nonnull(handles);
    if (object_count)
        ck_assert_int_eq(occ_scene_add_many(scene, objects, object_count, handles), OCC_SUCCESS);
    for (uint32_t i = 0; i < occluder_count; i++) {
        occ_object owner = {0, 0};
        if (occluders[i].owner >= 0) owner = handles[occluders[i].owner];
        ck_assert_int_eq(occ_scene_add_occluder(scene, &occluders[i].box, owner, NULL),
                         OCC_SUCCESS);
    }
    free(handles);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    return scene;
}

static bool must_have_device(void)
{
    const char *names[] = {"CI", "OCC_REQUIRE_OPENCL"};
    for (int i = 0; i < 2; i++) {
        const char *value = getenv(names[i]);
        if (value && value[0] && strcmp(value, "0") != 0 && strcmp(value, "false") != 0)
            return true;
    }
    return false;
}

occ_view *world_view(occ_backend backend, uint32_t threads)
{
    occ_view_desc desc = {.backend = backend, .threads = threads};
    occ_view *view = NULL;
    occ_result result = occ_view_create(&desc, &view);
    bool absent = result == OCC_ERROR_NO_DEVICE || result == OCC_ERROR_UNSUPPORTED;
    if (backend == OCC_BACKEND_OPENCL && absent && !must_have_device()) return NULL;
    ck_assert_msg(result == OCC_SUCCESS, "%s", occ_result_name(result));
    return view;
}

bool world_sees(const occ_view *view, uint32_t object)
{
    occ_object handle = {object + 1u, 0};
    return occ_view_is_visible(view, handle);
}

occ_cull_desc world_knobs(occ_method method)
{
    return (occ_cull_desc){
        .method = method, .min_area = 1e-30f, .max_occluders = 1u << 30, .grain = 8};
}
