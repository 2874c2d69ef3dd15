// SPDX-License-Identifier: Apache-2.0
#include "knobs.h"

// What a knob that is left 0 stands for.
static const occ_cull_desc presets[] = {
    [OCC_PRESET_BALANCED] = {.min_area = 3e-4f,
                             .max_occluders = 1024,
                             .grain = 64,
                             .max_splits = 48},
    [OCC_PRESET_FAST] = {.min_area = 1e-3f, .max_occluders = 1024, .grain = 64, .max_splits = 16},
    [OCC_PRESET_THOROUGH] = {.min_area = 5e-5f,
                             .max_occluders = 4096,
                             .grain = 64,
                             .max_splits = 256},
};

static occ_result check_knobs(const occ_cull_desc *knobs, const occ_hooks *hooks)
{
    const occ_result wrong = OCC_ERROR_INVALID_ARGUMENT;
    if ((unsigned)knobs->method > OCC_METHOD_SINGLE)
        return occ_fail(hooks, wrong, "there is no method %d", (int)knobs->method);
    if ((unsigned)knobs->preset > OCC_PRESET_THOROUGH)
        return occ_fail(hooks, wrong, "there is no preset %d", (int)knobs->preset);
    if (!(knobs->min_area >= 0.0f)) return occ_fail(hooks, wrong, "min_area is negative or NaN");
    if (!(knobs->tolerance >= 0.0f && knobs->tolerance <= OCC_MAX_TOLERANCE))
        return occ_fail(hooks, wrong, "tolerance is not between 0 and %g radians",
                        (double)OCC_MAX_TOLERANCE);
    return OCC_SUCCESS;
}

occ_result occ_knobs_init(occ_cull_desc *knobs, const occ_cull_desc *desc, const occ_hooks *hooks)
{
    static const occ_cull_desc defaults;
    *knobs = desc ? *desc : defaults;
    occ_result result = check_knobs(knobs, hooks);
    if (result) return result;
    const occ_cull_desc *preset = &presets[knobs->preset];
    if (knobs->min_area == 0.0f) knobs->min_area = preset->min_area;
    if (!knobs->max_occluders) knobs->max_occluders = preset->max_occluders;
    if (!knobs->grain) knobs->grain = preset->grain;
    if (!knobs->max_splits) knobs->max_splits = preset->max_splits;
    return OCC_SUCCESS;
}
