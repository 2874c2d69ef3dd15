// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

void occ_frame_init(occ_frame *frame, occ_hooks *hooks, const occ_lanes *lanes)
{
    *frame = (occ_frame){.hooks = hooks, .lanes = lanes};
    frame->blocks = OCC_ARRAY(occ_shadow_block);
    frame->shadows = OCC_ARRAY(occ_shadow);
    frame->sources = OCC_ARRAY(occ_occluder);
    frame->pool = OCC_ARRAY(uint32_t);
    frame->inherited = OCC_ARRAY(uint32_t);
    frame->touched = OCC_ARRAY(uint8_t);
    frame->ranges = OCC_ARRAY(occ_range);
    frame->candidates = OCC_ARRAY(uint32_t);
    frame->verdicts = OCC_ARRAY(occ_verdict);
}

void occ_frame_free(occ_frame *frame)
{
    occ_array *arrays[] = {&frame->heap,   &frame->blocks,     &frame->shadows,   &frame->sources,
                           &frame->stack,  &frame->pool,       &frame->inherited, &frame->touched,
                           &frame->ranges, &frame->candidates, &frame->verdicts};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (arrays[i]->element) occ_array_free(frame->hooks, arrays[i]);
}

occ_relative_box occ_frame_relative(const occ_frame *frame, const occ_box *box)
{
    const occ_eye *eye = &frame->camera.constants;
    occ_relative_box relative;
    for (int j = 0; j < 3; j++)
        relative.t[j] = OCC_RELATIVE(box->center[j], eye->high[j], eye->low[j]);
    for (int k = 0; k < 9; k++)
        relative.a[k] = box->axis[k / 3][k % 3];
    relative.e = occ_box_slack(&relative, eye->slack_floor);
    return relative;
}
