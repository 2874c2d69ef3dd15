// SPDX-License-Identifier: Apache-2.0
// A box without triangles in its interior lies in one region of space, so that what is true of its
// middle is true of all of it. The middle is a point of floats: its mark is exact. Where the mark
// does not do and the caller allows holes, the middle must be in a cell that a new flood leaves
// dry.
#include "soup/inner.h"

#include "box.h"
#include "log.h"
#include "soup/grow.h"

#include <string.h>

// What is known of a box so far.
typedef struct verdict {
    occ_inner_reason reason; // OCC_INNER_OPEN and OCC_INNER_ROOM: unless it proves to be dry
    uint32_t triangle, point;
    bool asked; // the flood of its grid
} verdict;

typedef struct verify_call {
    occ_hooks *hooks;
    const occ_soup *soup;
    const occ_inner_desc *desc;
    const occ_inner_box *boxes;
    size_t count;
    occ_mesh mesh;
    occ_closed closed;
    occ_free_space space;
    verdict *verdicts;
    occ_result result;
} verify_call;

static occ_result judge_box(verify_call *call, const occ_inner_box *box, occ_mark *mark, verdict *v)
{
    occ_ready_box ready;
    *v = (verdict){OCC_INNER_SOUND, UINT32_MAX, UINT32_MAX, true};
    occ_ready_box_make(&box->box, &ready);
    if (ready.flat) {
        v->reason = OCC_INNER_FLAT;
        return OCC_SUCCESS;
    }
    occ_triangles all = {&call->mesh, NULL, call->mesh.triangles};
    uint32_t intruder = occ_find_intruder(&all, &box->box);
    if (intruder != UINT32_MAX) {
        v->reason = OCC_INNER_ENTERED;
        v->triangle = call->mesh.source[intruder];
        return OCC_SUCCESS;
    }
    occ_result result = occ_mark_point(call->hooks, &call->closed, NULL, call->mesh.triangles,
                                       box->box.center, mark);
    if (result || occ_is_closed_off(&call->space, mark, &v->point)) return result;
    v->reason = v->point == UINT32_MAX ? OCC_INNER_OPEN : OCC_INNER_ROOM;
    v->asked = !occ_is_dry_enough(&call->space, mark, 0.0f);
    return OCC_SUCCESS;
}

// --- floods --------------------------------------------------------------------------------------

static bool same_grid(const occ_inner_grid *a, const occ_inner_grid *b)
{
    return !memcmp(a, b, offsetof(occ_inner_grid, hole)); // no padding before it
}

// Floods the grid of a box and answers all boxes that have the same.
static occ_result ask_flood(verify_call *call, size_t first, occ_voxels *voxels, occ_team *team)
{
    const occ_inner_grid *grid = &call->boxes[first].grid;
    bool good = occ_voxels_set(voxels, grid) && voxels->count <= call->desc->max_cells &&
                voxels->grid.hole <= call->desc->max_hole &&
                occ_voxels_are_near(voxels, &call->mesh);
    occ_triangles all = {&call->mesh, NULL, call->mesh.triangles};
    if (good) {
        if (occ_voxels_reserve(call->hooks, voxels)) return OCC_ERROR_OUT_OF_MEMORY;
        occ_voxels_mark(voxels, &all, team);
        bool walled = call->desc->outside_solid && occ_solid_encloses(voxels, &call->mesh);
        occ_solid_flood(voxels, &all, walled, call->desc->free_points, call->space.count);
    }
    for (size_t i = first; i < call->count; i++) {
        if (call->verdicts[i].asked || !same_grid(&call->boxes[i].grid, grid)) continue;
        call->verdicts[i].asked = true;
        occ_ready_box ready;
        occ_ready_box_make(&call->boxes[i].box, &ready);
        if (good && occ_solid_meets(voxels, &ready)) call->verdicts[i].reason = OCC_INNER_SOUND;
    }
    return OCC_SUCCESS;
}

static occ_result judge_boxes(verify_call *call, occ_team *team)
{
    occ_mark mark = OCC_MARK;
    occ_voxels voxels = {0};
    occ_result result = OCC_SUCCESS;
    for (size_t i = 0; !result && i < call->count; i++) {
        result = judge_box(call, &call->boxes[i], &mark, &call->verdicts[i]);
        if (!result)
            result = occ_soup_progress(&call->desc->work, call->hooks,
                                       0.7 * (double)(i + 1) / (double)call->count);
    }
    for (size_t i = 0; !result && i < call->count; i++) {
        if (call->verdicts[i].asked) continue;
        result = ask_flood(call, i, &voxels, team);
        if (!result)
            result = occ_soup_progress(&call->desc->work, call->hooks,
                                       0.7 + 0.3 * (double)(i + 1) / (double)call->count);
    }
    occ_voxels_free(call->hooks, &voxels);
    occ_mark_free(call->hooks, &mark);
    return result;
}

// --- the call ------------------------------------------------------------------------------------

static void verify_boxes(verify_call *call, occ_team *team)
{
    call->result = occ_mesh_build(call->hooks, call->soup, &call->mesh);
    if (!call->result && call->mesh.triangles)
        call->result = occ_closed_build(call->hooks, &call->mesh, &call->closed);
    if (!call->result)
        call->result = occ_free_space_make(call->hooks, &call->closed, call->desc, &call->space);
    if (!call->result) call->result = judge_boxes(call, team);
}

static occ_result check_boxes(const occ_inner_box *boxes, size_t count, const occ_hooks *hooks)
{
    if (count && !boxes) return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "boxes is NULL");
    if (count >= UINT32_MAX) return occ_fail(hooks, OCC_ERROR_LIMIT, "%zu boxes", count);
    for (size_t i = 0; i < count; i++) {
        occ_result result = occ_box_check(&boxes[i].box);
        if (result) return occ_fail(hooks, result, "box %zu has numbers that are no box", i);
    }
    return OCC_SUCCESS;
}

// Tells of the first box that is not sound.
static occ_result report(const verify_call *call, occ_inner_fault *fault)
{
    static const char *const why[] = {"is sound", "has no volume", "is entered by a triangle",
                                      "is not proven to be in solid space",
                                      "is not apart from a point of free space"};
    for (size_t i = 0; i < call->count; i++) {
        const verdict *v = &call->verdicts[i];
        if (v->reason == OCC_INNER_SOUND) continue;
        if (fault) *fault = (occ_inner_fault){v->reason, (uint32_t)i, v->triangle, v->point};
        return occ_fail(call->hooks, OCC_ERROR_NOT_INSIDE, "box %zu %s", i, why[v->reason]);
    }
    return OCC_SUCCESS;
}

// Judges all boxes; `fault` and `reasons` may be NULL. Without `reasons` an unsound one is an
// error.
static occ_result verify(occ_hooks *hooks, const occ_soup *soup, const occ_inner_box *boxes,
                         size_t count, const occ_inner_desc *desc, occ_inner_fault *fault,
                         occ_inner_reason *reasons)
{
    verify_call call = {.hooks = hooks, .soup = soup, .desc = desc, .boxes = boxes, .count = count};
    call.verdicts = occ_alloc(hooks, count * sizeof *call.verdicts);
    if (!call.verdicts) return occ_fail(hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for verdicts");
    occ_team *team;
    call.result = occ_team_create(hooks, occ_threads_offered(desc->threads), &team);
    if (!call.result) {
        occ_team_wake(team);
        verify_boxes(&call, team);
        occ_team_rest(team);
        occ_team_destroy(hooks, team);
    }
    occ_result result = call.result;
    for (size_t i = 0; !result && reasons && i < count; i++)
        reasons[i] = call.verdicts[i].reason;
    if (!result && !reasons) {
        result = report(&call, fault);
    } else if (result == OCC_ERROR_OUT_OF_MEMORY) {
        (void)occ_fail(hooks, result, "no memory to verify %zu boxes", count);
    }
    occ_free_space_free(hooks, &call.space);
    occ_closed_free(hooks, &call.closed);
    occ_mesh_free(hooks, &call.mesh);
    occ_free(hooks, call.verdicts, count * sizeof *call.verdicts);
    return result;
}

occ_result occ_inner_judge(occ_hooks *hooks, const occ_soup *soup, const occ_inner_box *boxes,
                           size_t count, const occ_inner_desc *desc, occ_inner_reason *reasons)
{
    return verify(hooks, soup, boxes, count, desc, NULL, reasons);
}

occ_result occ_verify_inner(const occ_soup *soup, const occ_inner_box *boxes, size_t count,
                            const occ_inner_desc *desc, occ_inner_fault *fault)
{
    occ_hooks hooks;
    occ_inner_desc taken = {0};
    if (desc) taken = *desc;
    if (fault) *fault = (occ_inner_fault){OCC_INNER_SOUND, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    occ_result result = occ_soup_hooks(&taken.work, &hooks);
    if (result) return result;
    result = occ_inner_take_desc(&hooks, &taken);
    if (!result) result = occ_soup_validate(soup, &hooks);
    if (!result) result = check_boxes(boxes, count, &hooks);
    if (result || !count) return result;
    return verify(&hooks, soup, boxes, count, &taken, fault, NULL);
}
