// SPDX-License-Identifier: Apache-2.0
// Method embree-rays: eight rays to an object's corners against the occluders' triangles. Exact for
// one convex occluder; a union of them may block all corners and leave the middle open.
#include "peer_boxes.h"
#include "peer_embree.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 8 };

// Rays end a little before their corner, so that a surface which the corner lies in does not count
// as in front of it.
static const float NEARLY_THERE = 1 - 1e-5f;

typedef struct rays_state {
    peer_tree tree;
    peer_boxes boxes;
    uint32_t *owning; // bits of the objects that own an occluder
    int threads;
} rays_state;

static uint32_t *find_owning(const obs_scene *scene)
{
    uint32_t *bits = calloc(OCC_MASK_WORDS(scene->object_count) + 1, sizeof *bits);
    if (!bits) fputs("occlude-bench: not enough memory\n", stderr);
    for (uint32_t i = 0; bits && i < obs_occluder_total(scene); i++) {
        uint32_t owner = obs_occluder_owner(scene, i);
        if (owner != OBS_NO_OWNER) bits[owner / 32] |= UINT32_C(1) << owner % 32;
    }
    return bits;
}

void *peer_rays_open(const obs_scene *scene, const peer_options *options, peer_info *info)
{
    rays_state *state = calloc(1, sizeof *state);
    if (!state) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return NULL;
    }
    state->threads = (int)options->threads;
    state->owning = find_owning(scene);
    if (!state->owning || !peer_boxes_open(&state->boxes, scene) ||
        !peer_tree_open(&state->tree, scene, true)) {
        peer_rays_close(state);
        return NULL;
    }
    peer_tree_tell(&state->tree, info);
    info->bytes += peer_boxes_bytes(&state->boxes);
    info->bytes += OCC_MASK_WORDS(scene->object_count) * sizeof *state->owning;
    return state;
}

void peer_rays_close(void *state)
{
    rays_state *rays = state;
    peer_tree_close(&rays->tree);
    peer_boxes_close(&rays->boxes);
    free(rays->owning);
    free(rays);
}

// Turns down hits of an occluder that is part of the ray's own object. Rays and hits come as arrays
// of N of each member, in the order of the members of RTCRay and RTCHit.
static void skip_own(const struct RTCFilterFunctionNArguments *args)
{
    enum { MEMBER_PRIM_ID = 5, MEMBER_ID = 10 };
    const uint32_t *owners = args->geometryUserPtr;
    const unsigned *ids = (const unsigned *)args->ray + (size_t)MEMBER_ID * args->N;
    const unsigned *triangles = (const unsigned *)args->hit + (size_t)MEMBER_PRIM_ID * args->N;
    for (unsigned i = 0; i < args->N; i++)
        if (args->valid[i] && owners[triangles[i]] == ids[i]) args->valid[i] = 0;
}

// The rays to an object's corners. Returns false when a corner is not beyond the near plane.
static bool aim(struct RTCRay8 *rays, const peer_camera *camera, const occ_box *box)
{
    for (int corner = 0; corner < CORNERS; corner++) {
        float to[3], depth = 0;
        for (int k = 0; k < 3; k++) {
            to[k] = box->center[k] - camera->eye[k];
            for (int a = 0; a < 3; a++)
                to[k] += corner >> a & 1 ? box->axis[a][k] : -box->axis[a][k];
            depth += camera->forward[k] * to[k];
        }
        if (!(depth > camera->near_depth)) return false;
        rays->dir_x[corner] = to[0];
        rays->dir_y[corner] = to[1];
        rays->dir_z[corner] = to[2];
        rays->tnear[corner] = camera->near_depth / depth;
        rays->tfar[corner] = NEARLY_THERE;
    }
    return true;
}

static bool is_hidden(const rays_state *state, const peer_camera *camera, struct RTCRay8 *rays,
                      uint32_t object)
{
    static const int valid[CORNERS] __attribute__((aligned(32))) = {-1, -1, -1, -1, -1, -1, -1, -1};
    if (!aim(rays, camera, &state->boxes.scene->objects[object])) return false;
    for (int corner = 0; corner < CORNERS; corner++)
        rays->id[corner] = object;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    if (state->owning[object / 32] >> object % 32 & 1) context.filter = skip_own;
    rtcOccluded8(valid, state->tree.scene, &context, rays);
    bool hidden = true;
    for (int corner = 0; corner < CORNERS; corner++) // blocked: Embree sets it to -infinity
        hidden = hidden && rays->tfar[corner] < 0;
    return hidden;
}

// Rays from the eye.
static struct RTCRay8 rays_from(const peer_camera *camera)
{
    struct RTCRay8 rays;
    memset(&rays, 0, sizeof rays);
    for (int i = 0; i < CORNERS; i++) {
        rays.org_x[i] = camera->eye[0];
        rays.org_y[i] = camera->eye[1];
        rays.org_z[i] = camera->eye[2];
        rays.mask[i] = UINT32_MAX;
    }
    return rays;
}

static void test_blocks(const void *state, const peer_camera *camera, size_t first, size_t end,
                        uint32_t *mask)
{
    unsigned control = peer_float_flush();
    struct RTCRay8 rays = rays_from(camera);
    for (size_t block = first; block < end; block++)
        for (uint32_t left = mask[block]; left != 0; left &= left - 1) {
            uint32_t object = (uint32_t)(block * PEER_BLOCK) + (uint32_t)__builtin_ctz(left);
            if (is_hidden(state, camera, &rays, object)) mask[block] ^= left & (0u - left);
        }
    peer_float_restore(control);
}

void peer_rays_cull(void *state, const obs_frame *frame, uint32_t *mask, occ_view_stats *stats)
{
    rays_state *rays = state;
    double start = timing_now();
    peer_camera camera = peer_camera_of(frame);
    double ready = timing_now();
    stats->tested = peer_boxes_test(&rays->boxes, &camera, rays->threads, test_blocks, rays, mask);
    stats->walk_ms = ready - start;
    stats->test_ms = timing_now() - ready;
}
