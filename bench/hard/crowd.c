// SPDX-License-Identifier: Apache-2.0
// Objects where an occluder might hide them.
#include "stage.h"

#include <math.h>
#include <string.h>

// The point that lies behind `point` as the camera sees it.
static void beyond(const stage *s, const double point[3], double times, double out[3])
{
    for (int j = 0; j < 3; j++) {
        double ahead = 16.0 * (1.0 - times) * s->back[j];
        out[j] = s->parallel ? point[j] + ahead : s->eye[j] + times * (point[j] - s->eye[j]);
    }
}

static double largest_axis(const stage_box *box)
{
    double largest = 0.0;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            if (fabs(box->axis[k][j]) > largest) largest = fabs(box->axis[k][j]);
    return largest;
}

void stage_behind(stage *s, int occluder, double times, world_shape shape)
{
    const stage_box *box = &s->occluders[occluder];
    double point[3], center[3], size = largest_axis(box);
    memcpy(point, box->center, sizeof point);
    for (int k = 0; k < 3; k++) {
        double part = world_between(&s->random, -1, 1);
        for (int j = 0; j < 3; j++)
            point[j] += part * box->axis[k][j];
    }
    beyond(s, point, times, center);
    if (size == 0.0) size = 1.0;
    size *= world_scale(&s->random, 1e-3, 1) * (s->parallel ? 1.0 : fabs(times));
    stage_object(s, stage_any(s, shape, center, size));
}

void stage_on_rim(stage *s, int occluder)
{
    const stage_box *box = &s->occluders[occluder];
    double point[3], there[3], half[3], times = stage_whole(s, 2, 4);
    unsigned corner = steady_below(&s->random, 8);
    stage_corner(box, corner, point);
    beyond(s, point, times, there);
    stage_box object = {{0}, {{0}}};
    uint32_t outside = steady_below(&s->random, 16); // mostly inside in x and y
    for (int j = 0; j < 3; j++) {
        half[j] = stage_chance(s, 6) ? 0.0 : stage_part(s, 0.0625, 1);
        double inward = box->center[j] > point[j] ? 1.0 : -1.0;
        if (outside == (uint32_t)j) inward = -inward;
        if (j == 2) inward = -1.0;
        object.center[j] = there[j] + inward * half[j];
        object.axis[j][j] = half[j];
    }
    stage_object(s, object);
}

// With its front on the occluder's back, or its back on the front, if these are faces across z.
static void touching(stage *s, int occluder)
{
    const stage_box *box = &s->occluders[occluder];
    const double *at = box->center;
    double depth = stage_part(s, 0, 2), reach = fabs(box->axis[2][2]) + depth;
    if (!stage_chance(s, 4)) reach = -reach;
    stage_object(s, stage_any_brick(s, stage_ones(at[0] - 1, at[0] + 1),
                                    stage_ones(at[1] - 1, at[1] + 1), stage_just(at[2] + reach),
                                    stage_parts(0, 2), stage_parts(0, 2), stage_just(depth)));
}

static void anywhere(stage *s, world_shape shape)
{
    double distance = world_scale(&s->random, 1, 100), center[3];
    double spread = s->parallel ? 16.0 : distance;
    for (int j = 0; j < 3; j++)
        center[j] = s->eye[j] - distance * s->back[j] + spread * world_between(&s->random, -1, 1);
    double size = world_scale(&s->random, 0.01, 1) * (s->parallel ? 4.0 : distance);
    stage_object(s, stage_any(s, shape, center, size));
}

void stage_crowd(stage *s, uint32_t count, world_shape shape)
{
    while (s->world->object_count < count) {
        uint32_t kind = steady_below(&s->random, 12), boxes = s->world->occluder_count;
        uint32_t occluders = boxes + s->world->sheet_count;
        if (!occluders || kind == 11) {
            anywhere(s, shape);
            continue;
        }
        int occluder = (int)steady_below(&s->random, occluders);
        if (occluder >= (int)boxes) occluder += FAMILY_OCCLUDERS - (int)boxes;
        if (kind < 6 || (shape != WORLD_SHAPES && kind < 10)) {
            stage_behind(s, occluder, 1.0 + world_scale(&s->random, 0.01, 4), shape);
        } else if (kind < 10) {
            stage_on_rim(s, occluder);
        } else {
            touching(s, occluder);
        }
    }
}
