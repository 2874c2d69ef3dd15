// SPDX-License-Identifier: Apache-2.0
#include "worlds.h"

#include <cglm/cglm.h>
#include <cglm/clipspace/ortho_rh_no.h>
#include <cglm/clipspace/ortho_rh_zo.h>
#include <cglm/clipspace/persp_rh_no.h>
#include <cglm/clipspace/persp_rh_zo.h>
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- numbers and boxes ---------------------------------------------------------------------------

double world_between(kit_random *random, double low, double high)
{
    return low + (double)(kit_next(random) >> 11) * 0x1p-53 * (high - low);
}

double world_scale(kit_random *random, double low, double high)
{
    return exp(world_between(random, log(low), log(high)));
}

void world_direction(kit_random *random, double out[3])
{
    double squared;
    do {
        squared = 0.0;
        for (int j = 0; j < 3; j++) {
            out[j] = world_between(random, -1, 1);
            squared += out[j] * out[j];
        }
    } while (squared > 1.0 || squared < 0.01);
    for (int j = 0; j < 3; j++)
        out[j] /= sqrt(squared);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        out[j] = a[p] * b[q] - a[q] * b[p];
    }
}

// Three axes at right angles.
static void turned_axes(kit_random *random, double axis[3][3])
{
    double aside[3], length;
    world_direction(random, axis[0]);
    do {
        world_direction(random, aside);
        cross(axis[0], aside, axis[1]);
        length = sqrt(axis[1][0] * axis[1][0] + axis[1][1] * axis[1][1] + axis[1][2] * axis[1][2]);
    } while (length < 0.1);
    for (int j = 0; j < 3; j++)
        axis[1][j] /= length;
    cross(axis[0], axis[1], axis[2]);
}

static void shape_axes(kit_random *random, world_shape shape, double axis[3][3])
{
    static const double aligned[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    turned_axes(random, axis);
    double longer = world_between(random, 0.2, 1), wider = world_between(random, 0.2, 1);
    for (int j = 0; j < 3; j++) {
        if (shape == WORLD_ALIGNED)
            for (int k = 0; k < 3; k++)
                axis[k][j] = aligned[k][j];
        if (shape == WORLD_SHEARED) axis[2][j] += 0.9 * axis[0][j] + 0.3 * axis[1][j];
        if (shape == WORLD_MIRRORED) axis[1][j] = -axis[1][j];
        if (shape == WORLD_COPLANAR) axis[2][j] = 0.5 * axis[0][j] - 0.7 * axis[1][j];
        if (shape == WORLD_SHEET) axis[2][j] = 0.0;
        if (shape == WORLD_PLATE) axis[2][j] *= 1e-7;
        if (shape == WORLD_SEGMENT || shape == WORLD_POINT) axis[1][j] = axis[2][j] = 0.0;
        if (shape == WORLD_POINT) axis[0][j] = 0.0;
        if (shape == WORLD_NEEDLE) axis[1][j] *= 1e-6;
        if (shape == WORLD_NEEDLE) axis[2][j] *= 1e-6;
        axis[0][j] *= longer;
        axis[1][j] *= wider;
    }
}

occ_box world_box(kit_random *random, world_shape shape, const double center[3], double size)
{
    double axis[3][3];
    shape_axes(random, shape, axis);
    occ_box box;
    uint32_t first = kit_below(random, 3); // which of the three is the odd one
    for (int j = 0; j < 3; j++) {
        box.center[j] = (float)center[j];
        for (uint32_t k = 0; k < 3; k++)
            box.axis[(k + first) % 3][j] = (float)(size * axis[k][j]);
    }
    return box;
}

void world_corner(const occ_box *box, unsigned corner, double out[3])
{
    for (int j = 0; j < 3; j++) {
        out[j] = (double)box->center[j];
        for (int k = 0; k < 3; k++)
            out[j] += (corner >> k & 1u ? 1.0 : -1.0) * (double)box->axis[k][j];
    }
}

occ_box world_scaled(const occ_box *box, float factor)
{
    occ_box scaled;
    for (int j = 0; j < 3; j++) {
        scaled.center[j] = box->center[j] * factor;
        for (int k = 0; k < 3; k++)
            scaled.axis[k][j] = box->axis[k][j] * factor;
    }
    return scaled;
}

// --- cameras -------------------------------------------------------------------------------------

// Clip z runs from 0 to 1 between the distances `zero` and `one`.
static void project_orthographic(const world_lens *lens, float near_z, float far_z, mat4 out)
{
    float y = lens->height > 0.0f ? 0.5f * lens->height : 10.0f, x = y * 16.0f / 9.0f;
    bool reversed = lens->depth == OCC_DEPTH_ONE_TO_ZERO;
    float zero = reversed ? far_z : near_z, one = reversed ? near_z : far_z;
    if (lens->depth == OCC_DEPTH_MINUS_ONE_TO_ONE) {
        glm_ortho_rh_no(-x, x, -y, y, near_z, far_z, out);
    } else {
        glm_ortho_rh_zo(-x, x, -y, y, zero, one, out);
    }
}

static void project_perspective(const world_lens *lens, float near_z, float far_z, mat4 out)
{
    float height = lens->height > 0.0f ? lens->height : 1.0471976f, aspect = 16.0f / 9.0f;
    bool reversed = lens->depth == OCC_DEPTH_ONE_TO_ZERO;
    float zero = reversed ? far_z : near_z, one = reversed ? near_z : far_z;
    if (lens->depth == OCC_DEPTH_MINUS_ONE_TO_ONE) {
        glm_perspective_rh_no(height, aspect, near_z, far_z, out);
    } else {
        glm_perspective_rh_zo(height, aspect, zero, one, out);
    }
    switch (lens->projection) {
    case WORLD_INFINITE: // the limit of the above
        out[2][2] = lens->depth == OCC_DEPTH_ONE_TO_ZERO ? 0.0f : -1.0f;
        out[3][2] = lens->depth == OCC_DEPTH_MINUS_ONE_TO_ONE ? -2.0f * near_z : -near_z;
        if (lens->depth == OCC_DEPTH_ONE_TO_ZERO) out[3][2] = near_z;
        break;
    case WORLD_OFF_CENTRE:
        out[2][0] = 0.35f;
        out[2][1] = -0.8f;
        break;
    case WORLD_JITTERED:
        out[2][0] = 0.25f / 960.0f;
        out[2][1] = -0.375f / 540.0f;
        break;
    default:
        break;
    }
}

occ_camera_desc world_camera(const float eye[3], const float target[3], const world_lens *lens)
{
    static const world_lens plain;
    if (!lens) lens = &plain;
    float near_z = lens->near_z > 0.0f ? lens->near_z : 0.1f;
    float far_z = lens->far_z > 0.0f ? lens->far_z : 1000.0f;
    vec3 from = {eye[0], eye[1], eye[2]}, to = {target[0], target[1], target[2]};
    vec3 up = {0.0f, 1.0f, 0.0f};
    if (eye[0] == target[0] && eye[2] == target[2]) {
        up[1] = 0.0f;
        up[2] = 1.0f;
    }
    mat4 view, projection, product;
    glm_lookat(from, to, up, view);
    if (lens->projection == WORLD_ORTHOGRAPHIC) {
        project_orthographic(lens, near_z, far_z, projection);
    } else {
        project_perspective(lens, near_z, far_z, projection);
    }
    glm_mat4_mul(projection, view, product);
    occ_camera_desc camera = {.depth = lens->depth};
    memcpy(camera.view_projection, product, sizeof camera.view_projection);
    return camera;
}

occ_camera_desc world_skewed_camera(kit_random *random, double reach)
{
    occ_camera_desc desc = {.depth = (occ_depth)kit_below(random, 3)};
    double eye[3], row[4][3];
    world_direction(random, eye);
    double nearness = kit_below(random, 2) ? world_scale(random, 1e-9, 1) : 1.0;
    uint32_t from = kit_below(random, 4), to = (from + 1 + kit_below(random, 3)) % 4;
    for (int r = 0; r < 4; r++)
        world_direction(random, row[r]);
    for (int r = 0; r < 4; r++) {
        double weight = world_scale(random, 1e-3, 1e3), d = 0.0;
        for (int j = 0; j < 3; j++) {
            if (r == (int)to) row[r][j] = row[from][j] + nearness * row[r][j];
            desc.view_projection[4 * j + r] = (float)(weight * row[r][j]);
            d -= (double)desc.view_projection[4 * j + r] * reach * eye[j];
        }
        desc.view_projection[12 + r] = (float)d + (r == 2 ? (float)weight * 0.1f : 0.0f);
    }
    bool begins_at_eye = kit_below(random, 2) == 0; // else the near plane spares no box close by
    for (int c = 0; c < 4 && begins_at_eye; c++)
        desc.view_projection[4 * c + 2] = 0.5f * desc.view_projection[4 * c + 3];
    return desc;
}

// --- scenes --------------------------------------------------------------------------------------

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
