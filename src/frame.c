// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include "box.h"

void occ_frame_init(occ_frame *frame, occ_hooks *hooks, const occ_lanes *lanes)
{
    *frame = (occ_frame){.hooks = hooks, .lanes = lanes};
    frame->shadows = OCC_ARRAY(occ_shadow);
    frame->wide = OCC_ARRAY(occ_wide_shadow);
    frame->sources = OCC_ARRAY(occ_occluder);
    frame->rects = OCC_ARRAY(occ_rect_block);
    frame->queue.entries = OCC_ARRAY(occ_walk_entry);
    frame->closing.entries = OCC_ARRAY(occ_walk_entry);
    frame->ranges = OCC_ARRAY(occ_range);
    frame->candidates = OCC_ARRAY(uint32_t);
    frame->verdicts = OCC_ARRAY(occ_verdict);
}

void occ_frame_free(occ_frame *frame)
{
    occ_array *arrays[] = {&frame->shadows,         &frame->wide,          &frame->sources,
                           &frame->rects,           &frame->queue.entries, &frame->open,
                           &frame->closing.entries, &frame->ranges,        &frame->candidates,
                           &frame->verdicts};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (arrays[i]->element) occ_array_free(frame->hooks, arrays[i]);
}

void *occ_frame_extend(occ_frame *frame, occ_array *array, size_t more)
{
    bool moves = more > array->capacity - array->count;
    if (moves) occ_team_settle(frame->team);
    void *place = occ_array_extend(frame->hooks, array, more);
    if (moves) occ_frame_set_job(frame);
    return place;
}

void occ_frame_set_job(occ_frame *frame)
{
    frame->set = occ_occluders_so_far(frame);
    frame->job = (occ_test_job){.scene = frame->scene,
                                .eye = &frame->camera.constants,
                                .screen = &frame->camera.screen,
                                .set = &frame->set,
                                .ranges = frame->ranges.data,
                                .range_count = frame->ranges.count,
                                .candidates = frame->candidates.data,
                                .candidate_count = frame->candidates.count,
                                .verdicts = frame->verdicts.data};
}

float occ_frame_nearness(const occ_frame *frame, const float t[3], const float h[3])
{
    const occ_camera *camera = &frame->camera;
    float sum = 0.0f;
    for (int j = 0; j < 3; j++) {
        float gap = fabsf(t[j]) - h[j];
        if (camera->orthographic) {
            float toward = (float)camera->toward[j];
            sum -= toward * t[j] + fabsf(toward) * h[j];
        } else if (gap > 0.0f) {
            sum += gap * gap;
        }
    }
    return sum;
}

float occ_frame_farness(const occ_frame *frame, const float t[3], const float h[3])
{
    const occ_camera *camera = &frame->camera;
    float sum = 0.0f;
    for (int j = 0; j < 3; j++) {
        float far = fabsf(t[j]) + h[j], toward = (float)camera->toward[j];
        sum += camera->orthographic ? fabsf(toward) * h[j] - toward * t[j] : far * far;
    }
    return sum;
}

occ_relative_box occ_frame_relative(const occ_frame *frame, const occ_box *box)
{
    return occ_box_relative(box, &frame->camera.constants);
}

occ_relative_box occ_frame_relative_node(const occ_frame *frame, const occ_node *node)
{
    const occ_eye *eye = &frame->camera.constants;
    occ_relative_box box = {{0}, {0}, 0.0f};
    for (int j = 0; j < 3; j++) {
        float min = OCC_RELATIVE(node->min[j], eye->high[j], eye->low[j]);
        float max = OCC_RELATIVE(node->max[j], eye->high[j], eye->low[j]);
        box.t[j] = OCC_MIDDLE(min, max);
        box.a[4 * j] = OCC_HALF(min, max);
    }
    box.e = occ_box_slack(&box, eye->slack_floor);
    return box;
}
