// SPDX-License-Identifier: Apache-2.0
#include "soup/search.h"

#include "log.h"

occ_result occ_free_space_make(occ_hooks *hooks, const occ_closed *closed,
                               const occ_inner_desc *desc, occ_free_space *space)
{
    *space = (occ_free_space){.closed = closed,
                              .count = desc->free_points ? desc->free_count : 0,
                              .facing = desc->facing,
                              .max_hole = desc->max_hole,
                              .outside_solid = desc->outside_solid};
    if (!space->count) return OCC_SUCCESS;
    space->marks = occ_alloc(hooks, space->count * sizeof *space->marks);
    if (!space->marks) {
        space->count = 0;
        return occ_fail(hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for points of free space");
    }
    for (uint32_t i = 0; i < space->count; i++)
        space->marks[i] = OCC_MARK;
    for (uint32_t i = 0; i < space->count; i++) {
        occ_result result = occ_mark_point(hooks, closed, NULL, closed->mesh->triangles,
                                           desc->free_points + 3 * (size_t)i, &space->marks[i]);
        if (result) return occ_fail(hooks, result, "no memory for points of free space");
    }
    return OCC_SUCCESS;
}

void occ_free_space_free(occ_hooks *hooks, occ_free_space *space)
{
    for (uint32_t i = 0; i < space->count; i++)
        occ_mark_free(hooks, &space->marks[i]);
    occ_free(hooks, space->marks, space->count * sizeof *space->marks);
    *space = (occ_free_space){0};
}

bool occ_is_closed_off(const occ_free_space *space, const occ_mark *mark, uint32_t *point)
{
    if (point) *point = UINT32_MAX;
    if (!mark->known || (!mark->bits.count && !space->outside_solid)) return false;
    for (uint32_t i = 0; i < space->count; i++) {
        if (occ_marks_differ(mark, &space->marks[i])) continue;
        if (point) *point = i;
        return false;
    }
    return space->facing == OCC_FACING_ANY || mark->winding > 0;
}

bool occ_is_dry_enough(const occ_free_space *space, const occ_mark *mark, float hole)
{
    if (!(space->max_hole > 0.0f) || !(hole <= space->max_hole)) return false;
    return space->facing == OCC_FACING_ANY || mark->all_winding > 0;
}
