// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_VIEW_DATA_H
#define OCC_VIEW_DATA_H

#include "frame.h"
#include "mask.h"
#include "team.h"

struct occ_view {
    occ_hooks hooks;
    occ_frame frame;
    occ_tester *backend;
    occ_mask mask;   // the latest result
    uint32_t tested; // objects, in the latest frame
    bool has_result;
    uint64_t scene_id, revision; // of which scene, and as of which commit
};

// occ_view_create() with what only opencl.h can name: `cl_desc` is an occ_cl_desc or NULL.
occ_result occ_view_make(const occ_view_desc *desc, const void *cl_desc, occ_view **view);

// Handing out a result. The first sets *count to 0 and says whether there is a result; the second
// sets it to `needed` and says whether the caller's array holds that.
occ_result occ_view_check(const occ_view *view, size_t *count);
occ_result occ_view_fits(const occ_view *view, const void *array, size_t capacity, size_t needed,
                         size_t *count);

#endif
