// SPDX-License-Identifier: Apache-2.0
// The test of the open ranges. A work-group takes a range and each of its work-items an object,
// whose corner rays it tests against the visible faces and silhouettes of the range's occluders, as
// the planes of their shadows (verdict.h). The answers of a range are four words.
#include "fusion.h"

inline uint verdict_of(__global const float *boxes, uint stride, __global const occ_sent *sent,
                       __global const occ_range *range, uint row)
{
    __global const occ_eye *eye = &sent->eye;
    __global const occ_shadow *shadows = OCC_SENT_SHADOWS(sent);
    occ_relative_box box;
    occ_row_relative(&box, boxes, stride, row, eye);
    if (occ_box_outside(&box, eye->plane[0], range->frustum)) return OCC_OUTSIDE;
    __global const uint *list = OCC_SENT_CANDIDATES(sent) + range->candidates;
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
occ_test(__global const float *boxes, uint stride, __global const occ_sent *sent,
         __global uint *verdicts)
{
    __local uint word[4]; // as in occ_verdict: visible, visible, outside, outside
    uint item = (uint)get_local_id(0), group = (uint)get_group_id(0);
    if (item < 4) word[item] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    __global const occ_range *range = OCC_SENT_RANGES(sent) + group;
    if (item < range->count) {
        uint known = verdict_of(boxes, stride, sent, range, range->first + item);
        uint bit = 1u << (item & 31u);
        if (known == OCC_VISIBLE) atomic_or(&word[item >> 5], bit);
        if (known == OCC_OUTSIDE) atomic_or(&word[2 + (item >> 5)], bit);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < 4) verdicts[4 * (size_t)group + item] = word[item];
}
