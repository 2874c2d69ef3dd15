// SPDX-License-Identifier: Apache-2.0
#include "mini.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// --- cameras -------------------------------------------------------------------------------------

occ_camera_desc mini_view_of(const mini *m)
{
    occ_camera_desc desc = {.depth = m->camera.depth};
    obs_view_projection(&m->camera.frame, desc.view_projection);
    if (m->camera.eye_given) desc.eye = m->camera.eye;
    return desc;
}

bool mini_is_orthographic(const mini *m)
{
    return m->camera.frame.proj[11] == 0.0f;
}

void mini_set_eye(mini *m, const double eye[3])
{
    obs_frame *frame = &m->camera.frame;
    for (int r = 0; r < 3; r++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++)
            sum += (double)frame->view[4 * j + r] * eye[j];
        frame->view[12 + r] = (float)-sum;
    }
    for (int j = 0; j < 3; j++) {
        m->camera.eye[j] = eye[j];
        frame->eye[j] = (float)eye[j];
        frame->dir[j] = -frame->view[4 * j + 2];
    }
}

void mini_set_rows(mini *m, const float rows[3][3])
{
    float *view = m->camera.frame.view;
    memset(view, 0, 16 * sizeof *view);
    view[15] = 1.0f;
    for (int r = 0; r < 3; r++)
        for (int j = 0; j < 3; j++)
            view[4 * j + r] = rows[r][j];
    const double eye[3] = {m->camera.eye[0], m->camera.eye[1], m->camera.eye[2]};
    mini_set_eye(m, eye);
}

// The row of clip z: a * z + b, with z < 0 ahead, for a clip w of -z or of 1.
static void depth_row(occ_depth depth, bool orthographic, double n, double f, double *a, double *b)
{
    bool infinite = f == 0.0;
    double low = depth == OCC_DEPTH_MINUS_ONE_TO_ONE ? -1.0 : 0.0, high = 1.0;
    if (depth == OCC_DEPTH_ONE_TO_ZERO) {
        low = 1.0;
        high = 0.0;
    }
    if (orthographic) {
        *a = (low - high) / (f - n);
        *b = low + *a * n;
    } else if (infinite) {
        *a = -high;
        *b = (low - high) * n;
    } else {
        *a = (low * n - high * f) / (f - n);
        *b = (low - high) * n * f / (f - n);
    }
}

void mini_set_lens(mini *m, bool orthographic, const double scale[2], double near_z, double far_z)
{
    double a, b;
    depth_row(m->camera.depth, orthographic, near_z, far_z, &a, &b);
    float *proj = m->camera.frame.proj;
    memset(proj, 0, 16 * sizeof *proj);
    proj[0] = (float)scale[0];
    proj[5] = (float)scale[1];
    proj[10] = (float)a;
    proj[11] = orthographic ? 0.0f : -1.0f;
    proj[14] = (float)b;
    proj[15] = orthographic ? 1.0f : 0.0f;
}

void mini_scale(mini *m, float factor)
{
    for (uint32_t i = 0; i < m->object_count; i++)
        m->objects[i] = world_scaled(&m->objects[i], factor);
    for (uint32_t k = 0; k < m->occluder_count; k++)
        m->occluders[k].box = world_scaled(&m->occluders[k].box, factor);
    obs_frame *frame = &m->camera.frame;
    bool orthographic = mini_is_orthographic(m);
    for (int j = 0; j < 3; j++) {
        m->camera.eye[j] *= (double)factor;
        frame->eye[j] *= factor;
        frame->view[12 + j] *= factor;
        if (orthographic) frame->proj[5 * j] /= factor;
    }
    if (!orthographic) frame->proj[14] *= factor;
}

static void move_box(occ_box *box, const double by[3])
{
    for (int j = 0; j < 3; j++)
        box->center[j] = (float)((double)box->center[j] + by[j]);
}

void mini_move(mini *m, const double by[3])
{
    double eye[3];
    for (int j = 0; j < 3; j++)
        eye[j] = m->camera.eye[j] + by[j];
    for (uint32_t i = 0; i < m->object_count; i++)
        move_box(&m->objects[i], by);
    for (uint32_t k = 0; k < m->occluder_count; k++)
        move_box(&m->occluders[k].box, by);
    mini_set_eye(m, eye);
}

// --- files ---------------------------------------------------------------------------------------

const char *mini_not_for_files(const mini *m)
{
    if (m->camera.depth != OCC_DEPTH_MINUS_ONE_TO_ONE) return "a depth range that is not -1 to 1";
    for (int j = 0; j < 3 && m->camera.eye_given; j++)
        if (m->camera.eye[j] != (double)m->camera.frame.eye[j]) return "an eye between the floats";
    for (uint32_t k = 0; k < m->occluder_count; k++)
        if (m->occluders[k].owner < 0) return "an occluder that nobody owns";
    return NULL;
}

void mini_embody(mini *m)
{
    for (uint32_t k = 0; k < m->occluder_count && m->object_count < MINI_OBJECTS; k++) {
        if (m->occluders[k].owner >= 0) continue;
        m->occluders[k].owner = (int)m->object_count;
        m->objects[m->object_count++] = m->occluders[k].box;
    }
}

bool mini_write(const mini *m, const char *path)
{
    obs_scene file = {0};
    for (uint32_t i = 0; i < m->object_count; i++)
        obs_add_object(&file, &m->objects[i]);
    for (uint32_t k = 0; k < m->occluder_count; k++)
        obs_add_occluder(&file, &m->occluders[k].box, (uint32_t)m->occluders[k].owner);
    obs_add_frame(&file, &m->camera.frame);
    bool written = obs_write(path, &file);
    obs_free(&file);
    return written;
}

static bool take_file(mini *m, const obs_scene *file, uint32_t frame)
{
    if (file->object_count > MINI_OBJECTS || file->occluder_count > MINI_OCCLUDERS) return false;
    if (file->sheet_count > 0) return false; // boxes alone
    if (frame >= file->frame_count) return false;
    *m = (mini){.object_count = file->object_count, .occluder_count = file->occluder_count};
    m->camera.frame = file->frames[frame];
    for (int j = 0; j < 3; j++)
        m->camera.eye[j] = (double)m->camera.frame.eye[j];
    for (uint32_t i = 0; i < file->object_count; i++)
        m->objects[i] = file->objects[i];
    for (uint32_t k = 0; k < file->occluder_count; k++)
        m->occluders[k] = (world_occluder){file->occluders[k].box, (int)file->occluders[k].owner};
    return true;
}

bool mini_read(mini *m, const char *path, uint32_t frame, uint32_t *frames)
{
    obs_scene file;
    if (!obs_read(path, &file)) return false;
    *frames = file.frame_count;
    bool taken = take_file(m, &file, frame);
    if (!taken)
        fprintf(stderr, "%s: more than %d objects or %d occluders, or no frame %u\n", path,
                MINI_OBJECTS, MINI_OCCLUDERS, frame);
    obs_free(&file);
    return taken;
}

static void print_numbers(FILE *file, const char *what, const float *numbers, int count)
{
    fputs(what, file);
    for (int i = 0; i < count; i++)
        fprintf(file, " %a", (double)numbers[i]);
    fputc('\n', file);
}

bool mini_write_text(const mini *m, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file) return false;
    const mini_camera *camera = &m->camera;
    fprintf(file, "depth %d\neye %a %a %a %s\n", (int)camera->depth, camera->eye[0], camera->eye[1],
            camera->eye[2], camera->eye_given ? "given" : "derived");
    print_numbers(file, "view", camera->frame.view, 16);
    print_numbers(file, "proj", camera->frame.proj, 16);
    float numbers[12];
    for (uint32_t i = 0; i < m->object_count; i++) {
        memcpy(numbers, &m->objects[i], sizeof numbers);
        print_numbers(file, "object", numbers, 12);
    }
    for (uint32_t k = 0; k < m->occluder_count; k++) {
        memcpy(numbers, &m->occluders[k].box, sizeof numbers);
        fprintf(file, "owner %d ", m->occluders[k].owner);
        print_numbers(file, "occluder", numbers, 12);
    }
    return fclose(file) == 0;
}
