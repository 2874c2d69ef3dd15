// SPDX-License-Identifier: Apache-2.0
#include "world.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// --- numbers -------------------------------------------------------------------------------------

double world_between(steady_random *random, double low, double high)
{
    return low + steady_unit(random) * (high - low);
}

double world_scale(steady_random *random, double low, double high)
{
    return low * steady_exp(steady_unit(random) * steady_log(high / low));
}

double world_few_bits(double value, int bits)
{
    int exponent;
    double part = frexp(value, &exponent);
    return ldexp(floor(ldexp(part, bits) + 0.5), exponent - bits);
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void world_direction(steady_random *random, double out[3])
{
    double length;
    do {
        for (int j = 0; j < 3; j++)
            out[j] = world_between(random, -1, 1);
        length = length_of(out);
    } while (length > 1.0 || length < 0.1);
    for (int j = 0; j < 3; j++)
        out[j] /= length;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        out[j] = a[p] * b[q] - a[q] * b[p];
    }
}

void world_turn(steady_random *random, double axis[3][3])
{
    double aside[3], length;
    world_direction(random, axis[0]);
    do {
        world_direction(random, aside);
        cross(axis[0], aside, axis[1]);
        length = length_of(axis[1]);
    } while (length < 0.1);
    for (int j = 0; j < 3; j++)
        axis[1][j] /= length;
    cross(axis[0], axis[1], axis[2]);
}

// --- boxes ---------------------------------------------------------------------------------------

static void shape_axes(steady_random *random, world_shape shape, double axis[3][3])
{
    static const double aligned[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    world_turn(random, axis);
    double longer = world_between(random, 0.2, 1), wider = world_between(random, 0.2, 1);
    for (int j = 0; j < 3; j++) {
        if (shape == WORLD_ALIGNED)
            for (int k = 0; k < 3; k++)
                axis[k][j] = aligned[k][j];
        if (shape == WORLD_SHEARED) axis[2][j] += 0.9 * axis[0][j] + 0.3 * axis[1][j];
        if (shape == WORLD_MIRRORED) axis[1][j] = -axis[1][j];
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

// In so few bits that floats hold them, at a power of two; or with a volume that is not zero, but
// far smaller than what rounds off in double.
static double exactly_coplanar(steady_random *random, double axis[3][3], double size)
{
    bool almost = steady_below(random, 2);
    for (int j = 0; j < 3; j++) {
        for (int k = 0; k < 2; k++)
            axis[k][j] = nearbyint(axis[k][j] * 1024.0) / 1024.0;
        if (almost && j == 2) {
            axis[1][2] = nearbyint(axis[0][2] * 256.0) / 512.0;
            axis[0][2] = 1.5 * axis[1][2];
        }
        axis[2][j] = 0.5 * axis[0][j] - 0.75 * axis[1][j];
    }
    if (almost) axis[2][2] = world_scale(random, 1e-24, 1e-15);
    if (almost && steady_below(random, 2)) axis[2][2] = -axis[2][2];
    int exponent;
    frexp(size, &exponent);
    return ldexp(1.0, exponent - 1);
}

occ_box world_box(steady_random *random, world_shape shape, const double center[3], double size)
{
    double axis[3][3];
    shape_axes(random, shape, axis);
    if (shape == WORLD_COPLANAR) size = exactly_coplanar(random, axis, size);
    occ_box box;
    uint32_t first = steady_below(random, 3); // which of the three is the odd one
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

// What clip z and w make of view z: depths run from `low` (near) to `high` (far) after division.
static void depth_range(occ_depth depth, double *low, double *high)
{
    *low = depth == OCC_DEPTH_ONE_TO_ZERO ? 1 : depth == OCC_DEPTH_ZERO_TO_ONE ? 0 : -1;
    *high = depth == OCC_DEPTH_ONE_TO_ZERO ? 0 : 1;
}

static void project_orthographic(const world_lens *lens, double near_z, double far_z,
                                 double clip[4][4])
{
    double half = lens->height > 0.0f ? 0.5 * (double)lens->height : 10.0, low, high;
    depth_range(lens->depth, &low, &high);
    clip[0][0] = 9.0 / (16.0 * half);
    clip[1][1] = 1.0 / half;
    clip[2][2] = (low - high) / (far_z - near_z);
    clip[2][3] = (low * far_z - high * near_z) / (far_z - near_z);
    clip[3][3] = 1.0;
}

static void project_perspective(const world_lens *lens, double near_z, double far_z,
                                double clip[4][4])
{
    double half = lens->height > 0.0f ? 0.5 * (double)lens->height : 0.52359877559829887, low, high;
    double cotangent = steady_cos(half) / steady_sin(half);
    depth_range(lens->depth, &low, &high);
    clip[0][0] = cotangent * 9.0 / 16.0;
    clip[1][1] = cotangent;
    clip[3][2] = -1.0;
    if (lens->projection == WORLD_INFINITE) {
        clip[2][2] = -high;
        clip[2][3] = (low - high) * near_z;
    } else {
        clip[2][2] = (low * near_z - high * far_z) / (far_z - near_z);
        clip[2][3] = (low - high) * near_z * far_z / (far_z - near_z);
    }
    if (lens->projection == WORLD_OFF_CENTRE) {
        clip[0][2] = 0.35;
        clip[1][2] = -0.8;
    } else if (lens->projection == WORLD_JITTERED) {
        clip[0][2] = 0.25 / 960.0;
        clip[1][2] = -0.375 / 540.0;
    }
}

void world_project(const world_lens *lens, double clip[4][4])
{
    double near_z = lens->near_z > 0.0f ? (double)lens->near_z : 0.1;
    double far_z = lens->far_z > 0.0f ? (double)lens->far_z : 1000.0;
    memset(clip, 0, 4 * sizeof *clip);
    if (lens->projection == WORLD_ORTHOGRAPHIC) {
        project_orthographic(lens, near_z, far_z, clip);
    } else {
        project_perspective(lens, near_z, far_z, clip);
    }
}

// Rows of the rotation to view space, and the translation, in double and then in float.
static void look_at(const float eye[3], const float target[3], float view[4][4])
{
    bool vertical = eye[0] == target[0] && eye[2] == target[2];
    const double sky[3] = {0, vertical ? 0 : 1, vertical ? 1 : 0};
    double row[3][3];
    for (int j = 0; j < 3; j++)
        row[2][j] = (double)eye[j] - (double)target[j];
    cross(sky, row[2], row[0]);
    cross(row[2], row[0], row[1]);
    memset(view, 0, 4 * sizeof *view);
    view[3][3] = 1.0f;
    for (int r = 0; r < 3; r++) {
        double length = length_of(row[r]), along = 0.0;
        for (int j = 0; j < 3; j++) {
            view[r][j] = (float)(row[r][j] / length);
            along += row[r][j] / length * (double)eye[j];
        }
        view[r][3] = (float)-along;
    }
}

occ_camera_desc world_camera(const float eye[3], const float target[3], const world_lens *lens)
{
    static const world_lens plain;
    double clip[4][4];
    float view[4][4];
    if (!lens) lens = &plain;
    world_project(lens, clip);
    look_at(eye, target, view);
    occ_camera_desc camera = {.depth = lens->depth};
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            float sum = (float)clip[r][0] * view[0][c];
            for (int k = 1; k < 4; k++)
                sum += (float)clip[r][k] * view[k][c];
            camera.view_projection[4 * c + r] = sum;
        }
    return camera;
}

occ_camera_desc world_skewed_camera(steady_random *random, double reach)
{
    occ_camera_desc desc = {.depth = (occ_depth)steady_below(random, 3)};
    double eye[3], row[4][3];
    world_direction(random, eye);
    double nearness = steady_below(random, 2) ? world_scale(random, 1e-9, 1) : 1.0;
    uint32_t from = steady_below(random, 4), to = (from + 1 + steady_below(random, 3)) % 4;
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
    bool begins_at_eye = steady_below(random, 2) == 0; // else the near plane spares no box close by
    for (int c = 0; c < 4 && begins_at_eye; c++)
        desc.view_projection[4 * c + 2] = 0.5f * desc.view_projection[4 * c + 3];
    return desc;
}
