// SPDX-License-Identifier: Apache-2.0
#include "peer_batch.h"

#include "peer_lanes.h"

#include <float.h>
#include <math.h>

void peer_batch_add(peer_batch *batch, uint32_t object, const occ_box *box)
{
    uint32_t slot = batch->count++;
    batch->objects[slot] = object;
    for (int k = 0; k < 3; k++) {
        batch->center[k][slot] = box->center[k];
        for (int a = 0; a < 3; a++)
            batch->axis[a][k][slot] = box->axis[a][k];
    }
}

// The nearest point of the bounds is never farther than that of the box. The distance along the
// ray, not along the view, is what the buffer holds.
PEER_INLINE void find_distances(peer_batch *batch, const peer_camera *camera)
{
    for (int i = 0; i < PEER_BATCH; i++) {
        float square = 0, depth = 0;
        for (int k = 0; k < 3; k++) {
            float offset = batch->center[k][i] - camera->eye[k];
            float half = fabsf(batch->axis[0][k][i]) + fabsf(batch->axis[1][k][i]) +
                         fabsf(batch->axis[2][k][i]);
            float gap = fabsf(offset) - half;
            gap = gap > 0 ? gap : 0;
            square += gap * gap;
            depth += camera->forward[k] * (offset < 0 ? -gap : gap);
        }
        batch->depth[i] = depth > camera->near_depth ? sqrtf(square) : -1;
    }
}

// Row r of the matrix times the center and times the axes.
typedef struct clip_row {
    float center[PEER_BATCH], axis[3][PEER_BATCH];
} clip_row;

PEER_INLINE void find_row(clip_row *out, const peer_batch *batch, const float *matrix, int r)
{
    for (int i = 0; i < PEER_BATCH; i++)
        out->center[i] = matrix[r] * batch->center[0][i] + matrix[4 + r] * batch->center[1][i] +
                         matrix[8 + r] * batch->center[2][i] + matrix[12 + r];
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < PEER_BATCH; i++)
            out->axis[a][i] = matrix[r] * batch->axis[a][0][i] +
                              matrix[4 + r] * batch->axis[a][1][i] +
                              matrix[8 + r] * batch->axis[a][2][i];
}

PEER_INLINE float corner_of(const clip_row *row, int corner, int i)
{
    float sum = row->center[i];
    for (int a = 0; a < 3; a++)
        sum += corner >> a & 1 ? row->axis[a][i] : -row->axis[a][i];
    return sum;
}

PEER_INLINE void find_rectangles(peer_batch *batch, const peer_camera *camera)
{
    clip_row x, y, w;
    float least_w[PEER_BATCH];
    find_row(&x, batch, camera->matrix, 0);
    find_row(&y, batch, camera->matrix, 1);
    find_row(&w, batch, camera->matrix, 3);
    for (int i = 0; i < PEER_BATCH; i++) {
        least_w[i] = batch->rectangle[0][i] = batch->rectangle[1][i] = FLT_MAX;
        batch->rectangle[2][i] = batch->rectangle[3][i] = -FLT_MAX;
    }
    for (int corner = 0; corner < 8; corner++)
        for (int i = 0; i < PEER_BATCH; i++) {
            float depth = corner_of(&w, corner, i), scale = 0.5f / depth;
            float at_x = corner_of(&x, corner, i) * scale + 0.5f;
            float at_y = corner_of(&y, corner, i) * scale + 0.5f;
            least_w[i] = depth < least_w[i] ? depth : least_w[i];
            batch->rectangle[0][i] = at_x < batch->rectangle[0][i] ? at_x : batch->rectangle[0][i];
            batch->rectangle[1][i] = at_y < batch->rectangle[1][i] ? at_y : batch->rectangle[1][i];
            batch->rectangle[2][i] = at_x > batch->rectangle[2][i] ? at_x : batch->rectangle[2][i];
            batch->rectangle[3][i] = at_y > batch->rectangle[3][i] ? at_y : batch->rectangle[3][i];
        }
    for (int i = 0; i < PEER_BATCH; i++)
        for (int k = 0; k < 2; k++) { // the whole screen where a corner is before the near plane
            float least = batch->rectangle[k][i], most = batch->rectangle[2 + k][i];
            bool all = least_w[i] < camera->near_depth;
            batch->rectangle[k][i] = all || least < 0 ? 0 : least;
            batch->rectangle[2 + k][i] = all || most > 1 ? 1 : most;
        }
}

PEER_INLINE uint32_t project(peer_batch *batch, const peer_camera *camera)
{
    uint32_t bits = 0;
    find_distances(batch, camera);
    find_rectangles(batch, camera);
    for (uint32_t i = 0; i < PEER_BATCH; i++)
        bits |= (uint32_t)(batch->depth[i] >= 0) << i;
    return bits;
}

PEER_LANES_VARIANTS(uint32_t, project, (peer_batch * batch, const peer_camera *camera),
                    (batch, camera))

uint32_t peer_batch_project(peer_batch *batch, const peer_camera *camera)
{
    for (uint32_t i = batch->count; i < PEER_BATCH; i++) // no garbage in the lanes that are free
        for (int k = 0; k < 3; k++) {
            batch->center[k][i] = camera->eye[k];
            for (int a = 0; a < 3; a++)
                batch->axis[a][k][i] = 0;
        }
    return project_best(batch, camera);
}
