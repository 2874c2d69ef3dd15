// SPDX-License-Identifier: Apache-2.0
// Method embree-depth: a small depth buffer filled by rays, as Godot 4 does it (MIT licence), read
// in modules/raycast/raycast_occlusion_cull.cpp of github.com/godotengine/godot at
// 015903472e7580b422f14e4baa19d85124ac7c87, with depths along the ray as Godot 4.5 has them again
// since its pull request 108347. The code is ours; docs/peers.md says where it differs.
#include "peer_batch.h"
#include "peer_embree.h"
#include "peer_lanes.h"
#include "peer_pyramid.h"
#include "timing.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TILE = 4, PACKET = TILE * TILE }; // pixels on a side, rays

typedef struct depth_state {
    peer_tree tree;
    peer_boxes boxes;
    peer_pyramid pyramid;
    int threads;
} depth_state;

void *peer_depth_open(const obs_scene *scene, const peer_options *options, peer_info *info)
{
    depth_state *state = calloc(1, sizeof *state);
    if (!state || !peer_pyramid_open(&state->pyramid, options->rays_width, options->rays_height)) {
        fputs("occlude-bench: not enough memory\n", stderr);
        free(state);
        return NULL;
    }
    state->threads = (int)options->threads;
    if (!peer_boxes_open(&state->boxes, scene) || !peer_tree_open(&state->tree, scene, false)) {
        peer_depth_close(state);
        return NULL;
    }
    peer_tree_tell(&state->tree, info);
    info->bytes += peer_boxes_bytes(&state->boxes) + state->pyramid.size * sizeof(float);
    return state;
}

void peer_depth_close(void *state)
{
    depth_state *depth = state;
    peer_tree_close(&depth->tree);
    peer_boxes_close(&depth->boxes);
    peer_pyramid_close(&depth->pyramid);
    free(depth);
}

// --- rays ----------------------------------------------------------------------------------------

// Rays through the centers of a tile's pixels, from the near plane to the far plane.
PEER_INLINE void make_rays(struct RTCRayHit16 *packet, const peer_camera *camera,
                           const float across[TILE], const float upward[TILE])
{
    struct RTCRay16 *ray = &packet->ray;
    for (int i = 0; i < PACKET; i++) {
        float a = across[i % TILE], b = upward[i / TILE];
        float length = sqrtf(1 + a * a + b * b), share = 1 / length;
        ray->org_x[i] = camera->eye[0];
        ray->org_y[i] = camera->eye[1];
        ray->org_z[i] = camera->eye[2];
        ray->dir_x[i] = (camera->forward[0] + a * camera->right[0] + b * camera->up[0]) * share;
        ray->dir_y[i] = (camera->forward[1] + a * camera->right[1] + b * camera->up[1]) * share;
        ray->dir_z[i] = (camera->forward[2] + a * camera->right[2] + b * camera->up[2]) * share;
        ray->tnear[i] = camera->near_depth * length;
        ray->tfar[i] = camera->far_depth * length;
        ray->time[i] = 0;
        ray->mask[i] = UINT32_MAX;
        ray->flags[i] = 0;
        packet->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
}

// Where a pixel's center is, along the screen, at depth 1.
static float place_of(const peer_camera *camera, int k, int pixel, int side)
{
    float ndc = 2 * ((float)pixel + 0.5f) / (float)side - 1;
    return (ndc + camera->shift[k]) / camera->scale[k];
}

static void trace_tile(depth_state *state, const peer_camera *camera, int left, int bottom)
{
    const peer_level *level = &state->pyramid.levels[0];
    struct RTCRayHit16 packet;
    float across[TILE], upward[TILE];
    int valid[PACKET] __attribute__((aligned(64)));
    for (int i = 0; i < TILE; i++) {
        across[i] = place_of(camera, 0, left + i, level->width);
        upward[i] = place_of(camera, 1, bottom + i, level->height);
    }
    make_rays(&packet, camera, across, upward);
    for (int i = 0; i < PACKET; i++)
        valid[i] = left + i % TILE < level->width && bottom + i / TILE < level->height ? -1 : 0;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, state->tree.scene, &context, &packet);
    for (int i = 0; i < PACKET; i++)
        if (valid[i]) {
            size_t at = (size_t)(bottom + i / TILE) * (size_t)level->width;
            bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            // What no occluder covers hides nothing, however far.
            level->depth[at + (size_t)(left + i % TILE)] = hit ? packet.ray.tfar[i] : FLT_MAX;
        }
}

static void trace_rows(depth_state *state, const peer_camera *camera, int tile_row)
{
    unsigned control = peer_float_flush();
    for (int left = 0; left < state->pyramid.levels[0].width; left += TILE)
        trace_tile(state, camera, left, tile_row * TILE);
    peer_float_restore(control);
}

static void trace(depth_state *state, const peer_camera *camera)
{
    int rows = (state->pyramid.levels[0].height + TILE - 1) / TILE;
#pragma omp parallel for schedule(dynamic) num_threads(state->threads) if (state->threads > 1)
    for (int row = 0; row < rows; row++)
        trace_rows(state, camera, row);
    peer_pyramid_update(&state->pyramid);
}

// --- objects -------------------------------------------------------------------------------------

static void test_batch(const depth_state *state, const peer_camera *camera, peer_batch *batch,
                       uint32_t *mask)
{
    uint32_t left = peer_batch_project(batch, camera);
    for (; left != 0; left &= left - 1) {
        int i = __builtin_ctz(left);
        const float rectangle[4] = {batch->rectangle[0][i], batch->rectangle[1][i],
                                    batch->rectangle[2][i], batch->rectangle[3][i]};
        uint32_t object = batch->objects[i];
        if (peer_pyramid_covers(&state->pyramid, rectangle, batch->depth[i]))
            mask[object / 32] &= ~(UINT32_C(1) << object % 32);
    }
    batch->count = 0;
}

static void test_blocks(const void *state, const peer_camera *camera, size_t first, size_t end,
                        uint32_t *mask)
{
    const depth_state *depth = state;
    peer_batch batch;
    batch.count = 0;
    for (size_t block = first; block < end; block++)
        for (uint32_t left = mask[block]; left != 0; left &= left - 1) {
            size_t object = block * PEER_BLOCK + (size_t)__builtin_ctz(left);
            peer_batch_add(&batch, (uint32_t)object, &depth->boxes.scene->objects[object]);
            if (batch.count == PEER_BATCH) test_batch(depth, camera, &batch, mask);
        }
    if (batch.count > 0) test_batch(depth, camera, &batch, mask);
}

void peer_depth_cull(void *state, const obs_frame *frame, uint32_t *mask, occ_view_stats *stats)
{
    depth_state *depth = state;
    double start = timing_now();
    peer_camera camera = peer_camera_of(frame);
    if (camera.is_perspective) trace(depth, &camera);
    double traced = timing_now();
    stats->tested =
        peer_boxes_test(&depth->boxes, &camera, depth->threads, test_blocks, depth, mask);
    stats->walk_ms = traced - start;
    stats->test_ms = timing_now() - traced;
}
