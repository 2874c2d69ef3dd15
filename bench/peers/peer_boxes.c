// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "peer_boxes.h"

#include "peer_lanes.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CHUNK = 64 }; // blocks that a thread takes at once

// --- the camera ----------------------------------------------------------------------------------

static void set_planes(peer_camera *camera)
{
    for (int p = 0; p < 6; p++) // the rows w + x, w - x, w + y, ... of the matrix
        for (int c = 0; c < 4; c++) {
            float row = camera->matrix[4 * c + p / 2], w = camera->matrix[4 * c + 3];
            camera->planes[p][c] = p & 1 ? w - row : w + row;
        }
}

peer_camera peer_camera_of(const obs_frame *frame)
{
    peer_camera camera = {0};
    obs_view_projection(frame, camera.matrix);
    set_planes(&camera);
    for (int k = 0; k < 3; k++) {
        camera.eye[k] = frame->eye[k];
        camera.right[k] = frame->view[4 * k];
        camera.up[k] = frame->view[4 * k + 1];
        camera.forward[k] = -frame->view[4 * k + 2];
    }
    for (int k = 0; k < 2; k++) {
        camera.scale[k] = frame->proj[5 * k];
        camera.shift[k] = frame->proj[8 + k];
    }
    camera.near_depth = frame->proj[14] / (frame->proj[10] - 1.0f);
    float far_depth = frame->proj[14] / (frame->proj[10] + 1.0f);
    camera.far_depth = far_depth > camera.near_depth ? far_depth : FLT_MAX;
    // Embree stops the program over a ray that is not a number or begins behind its origin.
    camera.is_perspective = frame->proj[11] == -1.0f && frame->proj[15] == 0.0f &&
                            camera.near_depth > 0 && isfinite(camera.near_depth) &&
                            isnormal(camera.scale[0]) && isnormal(camera.scale[1]);
    return camera;
}

// --- the objects ---------------------------------------------------------------------------------

static void set_bounds(peer_block *block, size_t slot, const occ_box *box)
{
    for (int k = 0; k < 3; k++) {
        block->center[k][slot] = box->center[k];
        block->half[k][slot] =
            fabsf(box->axis[0][k]) + fabsf(box->axis[1][k]) + fabsf(box->axis[2][k]);
    }
}

bool peer_boxes_open(peer_boxes *boxes, const obs_scene *scene)
{
    size_t count = ((size_t)scene->object_count + PEER_BLOCK - 1) / PEER_BLOCK;
    void *memory = NULL;
    if (posix_memalign(&memory, 64, (count + 1) * sizeof(peer_block)) != 0) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    *boxes = (peer_boxes){.scene = scene, .blocks = memory, .block_count = count};
    for (size_t i = 0; i < count * PEER_BLOCK; i++) { // the last object fills up its block
        size_t object = i < scene->object_count ? i : scene->object_count - 1u;
        set_bounds(&boxes->blocks[i / PEER_BLOCK], i % PEER_BLOCK, &scene->objects[object]);
    }
    return true;
}

void peer_boxes_close(peer_boxes *boxes)
{
    free(boxes->blocks);
    *boxes = (peer_boxes){0};
}

uint64_t peer_boxes_bytes(const peer_boxes *boxes)
{
    return (uint64_t)boxes->block_count * sizeof *boxes->blocks;
}

// --- the frustum ---------------------------------------------------------------------------------

// Bits of the objects in the block that no plane leaves wholly outside; `cut` gets those of them
// that are not wholly inside.
PEER_INLINE uint32_t test_bounds(const peer_block *block, const peer_camera *camera, uint32_t *cut)
{
    uint32_t kept = UINT32_MAX, whole = UINT32_MAX;
    for (int p = 0; p < 6 && kept != 0; p++) {
        const float *plane = camera->planes[p];
        float far_side[PEER_BLOCK], near_side[PEER_BLOCK];
        for (int i = 0; i < PEER_BLOCK; i++) {
            float middle = plane[0] * block->center[0][i] + plane[1] * block->center[1][i] +
                           plane[2] * block->center[2][i] + plane[3];
            float reach = fabsf(plane[0]) * block->half[0][i] +
                          fabsf(plane[1]) * block->half[1][i] + fabsf(plane[2]) * block->half[2][i];
            far_side[i] = middle + reach;
            near_side[i] = middle - reach;
        }
        kept &= peer_lanes_not_negative(far_side);
        whole &= peer_lanes_not_negative(near_side);
    }
    *cut = kept & ~whole;
    return kept;
}

PEER_LANES_VARIANTS(uint32_t, test_bounds,
                    (const peer_block *block, const peer_camera *camera, uint32_t *cut),
                    (block, camera, cut))

static bool box_meets_frustum(const occ_box *box, const peer_camera *camera)
{
    for (int p = 0; p < 6; p++) {
        const float *n = camera->planes[p];
        float sum = n[3];
        for (int k = 0; k < 3; k++)
            sum += n[k] * box->center[k];
        for (int a = 0; a < 3; a++)
            sum += fabsf(n[0] * box->axis[a][0] + n[1] * box->axis[a][1] + n[2] * box->axis[a][2]);
        if (sum < 0) return false;
    }
    return true;
}

uint32_t peer_boxes_in_frustum(const peer_boxes *boxes, const peer_camera *camera, size_t block)
{
    uint32_t cut, kept = test_bounds_best(&boxes->blocks[block], camera, &cut);
    size_t first = block * PEER_BLOCK, count = boxes->scene->object_count - first;
    if (count < PEER_BLOCK) kept &= (UINT32_C(1) << count) - 1;
    for (cut &= kept; cut != 0; cut &= cut - 1) {
        int slot = __builtin_ctz(cut);
        if (!box_meets_frustum(&boxes->scene->objects[first + (size_t)slot], camera))
            kept &= ~(UINT32_C(1) << slot);
    }
    return kept;
}

// --- all of them ---------------------------------------------------------------------------------

static uint32_t test_chunk(const peer_boxes *boxes, const peer_camera *camera, size_t first,
                           peer_test *test, const void *state, uint32_t *mask)
{
    uint32_t in_frustum = 0;
    size_t end = first + CHUNK < boxes->block_count ? first + CHUNK : boxes->block_count;
    for (size_t block = first; block < end; block++) {
        mask[block] = peer_boxes_in_frustum(boxes, camera, block);
        in_frustum += (uint32_t)__builtin_popcount(mask[block]);
    }
    if (in_frustum > 0 && camera->is_perspective) test(state, camera, first, end, mask);
    return in_frustum;
}

uint32_t peer_boxes_test(const peer_boxes *boxes, const peer_camera *camera, int threads,
                         peer_test *test, const void *state, uint32_t *mask)
{
    long long chunks = (long long)((boxes->block_count + CHUNK - 1) / CHUNK);
    uint32_t in_frustum = 0;
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)                   \
    reduction(+ : in_frustum)
    for (long long i = 0; i < chunks; i++)
        in_frustum += test_chunk(boxes, camera, (size_t)i * CHUNK, test, state, mask);
    return in_frustum;
}
