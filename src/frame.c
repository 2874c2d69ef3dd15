// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include "box.h"

void occ_frame_init(occ_frame *frame, occ_hooks *hooks, const occ_lanes *lanes)
{
    *frame = (occ_frame){.hooks = hooks, .lanes = lanes};
    frame->blocks = OCC_ARRAY(occ_shadow_block);
    frame->shadows = OCC_ARRAY(occ_shadow);
    frame->wide = OCC_ARRAY(occ_wide_shadow);
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
    occ_array *arrays[] = {&frame->heap,    &frame->blocks, &frame->shadows,    &frame->sources,
                           &frame->wide,    &frame->stack,  &frame->pool,       &frame->inherited,
                           &frame->touched, &frame->ranges, &frame->candidates, &frame->verdicts};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (arrays[i]->element) occ_array_free(frame->hooks, arrays[i]);
}

occ_relative_box occ_frame_relative(const occ_frame *frame, const occ_box *box)
{
    return occ_box_relative(box, &frame->camera.constants);
}
