// SPDX-License-Identifier: Apache-2.0
#include "thesis.h"

#include <occlude/cull.h>

#include <math.h>
#include <string.h>

static const float AREA_TOLERANCE = 0.01f; // absolute, whatever the scene's scale

static void subtract(float *out, const float *a, const float *b)
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] - b[k];
}

static float inner(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void outer(float *out, const float *a, const float *b)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static float triangle_area(const float *a, const float *b, const float *c)
{
    float ab[3], ac[3], n[3];
    subtract(ab, b, a);
    subtract(ac, c, a);
    outer(n, ab, ac);
    return 0.5f * sqrtf(inner(n, n));
}

static void corners_of(const occ_box *box, float corners[8][3])
{
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) {
            float sum = box->center[k];
            for (int a = 0; a < 3; a++)
                sum += (i >> a & 1) ? box->axis[a][k] : -box->axis[a][k];
            corners[i][k] = sum;
        }
}

// Corner numbers of the faces, each in the order of its outline. Bit a of a number is the side
// along axis a.
static const int box_faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};

static bool point_in_face(const float *point, const float *const outline[4])
{
    float area = triangle_area(outline[0], outline[1], outline[2]) +
                 triangle_area(outline[0], outline[2], outline[3]);
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        sum += triangle_area(point, outline[i], outline[(i + 1) % 4]);
    return fabsf(sum - area) < AREA_TOLERANCE;
}

static bool face_blocks(float (*corners)[3], const int *face, const float *from,
                        const float *direction)
{
    const float *const outline[4] = {corners[face[0]], corners[face[1]], corners[face[2]],
                                     corners[face[3]]};
    float edge_a[3], edge_b[3], normal[3], to_face[3], point[3];
    subtract(edge_a, outline[1], outline[0]);
    subtract(edge_b, outline[3], outline[0]);
    outer(normal, edge_a, edge_b);
    float slope = inner(normal, direction);
    if (slope == 0.0f) return false;
    subtract(to_face, outline[0], from);
    float t = inner(normal, to_face) / slope;
    if (!(t >= 0.0f)) return false; // and t may be beyond the eye
    for (int k = 0; k < 3; k++)
        point[k] = from[k] + t * direction[k];
    return point_in_face(point, outline);
}

bool thesis_hides(const occ_box *blocker, const occ_box *box, const float eye[3])
{
    float faces[8][3], corners[8][3];
    corners_of(blocker, faces);
    corners_of(box, corners);
    for (int i = 0; i < 8; i++) {
        float direction[3];
        bool blocked = false;
        subtract(direction, eye, corners[i]);
        for (int f = 0; f < 6 && !blocked; f++)
            blocked = face_blocks(faces, box_faces[f], corners[i], direction);
        if (!blocked) return false;
    }
    return true;
}

static bool box_meets_frustum(const occ_box *box, const float *m)
{
    for (int p = 0; p < 6; p++) { // the rows w + x, w - x, w + y, ... of the matrix
        double sign = p & 1 ? -1 : 1, plane[4], reach = 0;
        for (int c = 0; c < 4; c++)
            plane[c] = (double)m[4 * c + 3] + sign * (double)m[4 * c + p / 2];
        double offset = plane[3];
        for (int k = 0; k < 3; k++)
            offset += plane[k] * (double)box->center[k];
        for (int a = 0; a < 3; a++)
            reach += fabs(plane[0] * (double)box->axis[a][0] + plane[1] * (double)box->axis[a][1] +
                          plane[2] * (double)box->axis[a][2]);
        if (offset + reach < 0) return false;
    }
    return true;
}

void thesis_frustum(const obs_scene *scene, const obs_frame *frame, uint32_t *mask_words)
{
    float view_projection[16];
    obs_view_projection(frame, view_projection);
    memset(mask_words, 0, OCC_MASK_WORDS(scene->object_count) * sizeof *mask_words);
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (box_meets_frustum(&scene->objects[i], view_projection))
            mask_words[i / 32] |= UINT32_C(1) << i % 32;
}

static bool any_hides(const obs_scene *scene, uint32_t object, const float *eye)
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (i != object && thesis_hides(&scene->objects[i], &scene->objects[object], eye))
            return true;
    return false;
}

void thesis_cull(const obs_scene *scene, const obs_frame *frame, uint32_t *mask_words)
{
    thesis_frustum(scene, frame, mask_words);
    for (uint32_t i = 0; i < scene->object_count; i++) {
        uint32_t bit = UINT32_C(1) << i % 32;
        if (mask_words[i / 32] & bit && any_hides(scene, i, frame->eye)) mask_words[i / 32] ^= bit;
    }
}

void thesis_cull_remembered(thesis_memory *memory, const obs_scene *scene, const obs_frame *frame,
                            uint32_t *mask_words)
{
    bool is_same = memory->holds;
    for (int k = 0; k < 3; k++)
        is_same = is_same && memory->eye[k] == frame->eye[k];
    if (is_same) return;
    thesis_cull(scene, frame, mask_words);
    memcpy(memory->eye, frame->eye, sizeof memory->eye);
    memory->holds = true;
}
