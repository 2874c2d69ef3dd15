// SPDX-License-Identifier: Apache-2.0
// The test of the open ranges. A work-group takes a range and each of its work-items an object,
// whose corner rays it tests against the visible faces and silhouettes of the range's occluders, as
// the planes of their shadows (verdict.h). The answers of a range are four words.
#include "fusion.h"

// A row of the box table, relative to the eye.
inline occ_relative_box relative_row(__global const float *boxes, uint stride, uint row,
                                     __global const occ_eye *eye)
{
    occ_relative_box box;
    for (uint j = 0; j < 3; j++) {
        float coordinate = boxes[j * (size_t)stride + row];
        box.t[j] = OCC_RELATIVE(coordinate, eye->high[j], eye->low[j]);
    }
    for (uint k = 0; k < 9; k++)
        box.a[k] = boxes[(3 + k) * (size_t)stride + row];
    box.e = occ_box_slack(&box, eye->slack_floor);
    return box;
}

inline uint verdict_of(__global const float *boxes, uint stride, __global const occ_eye *eye,
                       __global const occ_shadow *shadows, __global const occ_range *range,
                       __global const uint *candidates, uint row)
{
    occ_relative_box box = relative_row(boxes, stride, row, eye);
    if (occ_box_outside(&box, eye->plane[0], range->frustum)) return OCC_OUTSIDE;
    __global const uint *list = candidates + range->candidates;
    if (range->fused) {
        return occ_box_fused(&box, eye, range->frustum, shadows, list, range->candidate_count, row)
                   ? OCC_HIDDEN
                   : OCC_VISIBLE;
    }
    for (uint c = 0; c < range->candidate_count; c++) {
        __global const occ_shadow *shadow = &shadows[list[c]];
        if (shadow->owner == row) continue;
        if (occ_box_in_shadow(&box, shadow->plane[0], shadow->planes)) return OCC_HIDDEN;
    }
    return OCC_VISIBLE;
}

__kernel __attribute__((reqd_work_group_size(OCC_RANGE_OBJECTS, 1, 1))) void
occ_test(__global const float *boxes, uint stride, __global const occ_eye *eye,
         __global const occ_shadow *shadows, __global const occ_range *ranges,
         __global const uint *candidates, __global uint *verdicts)
{
    __local uint word[4]; // as in occ_verdict: visible, visible, outside, outside
    uint item = (uint)get_local_id(0), group = (uint)get_group_id(0);
    if (item < 4) word[item] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    __global const occ_range *range = &ranges[group];
    if (item < range->count) {
        uint known =
            verdict_of(boxes, stride, eye, shadows, range, candidates, range->first + item);
        uint bit = 1u << (item & 31u);
        if (known == OCC_VISIBLE) atomic_or(&word[item >> 5], bit);
        if (known == OCC_OUTSIDE) atomic_or(&word[2 + (item >> 5)], bit);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < 4) verdicts[4 * (size_t)group + item] = word[item];
}
