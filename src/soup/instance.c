// SPDX-License-Identifier: Apache-2.0
// Boxes of a mesh at one of its places. Only directions are carried; what is promised is decided by
// the vertices there, exactly.
#include "box.h"
#include "log.h"
#include "rounding.h"
#include "soup/fit.h"
#include "soup/inner.h"
#include "soup/triangles.h"
#include "vector.h"

#include <occlude/instances.h>

#include <math.h>
#include <string.h>

static occ_result check_model(const float *model, const occ_hooks *hooks)
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(model[i]))
            return occ_fail(hooks, OCC_ERROR_NOT_FINITE, "the matrix: number %d is %g", i,
                            (double)model[i]);
    if (model[3] != 0.0f || model[7] != 0.0f || model[11] != 0.0f || model[15] != 1.0f)
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT,
                        "the last row of the matrix is not 0 0 0 1");
    return OCC_SUCCESS;
}

static void carry_direction(const float *model, const float v[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        out[j] = (double)model[j] * (double)v[0] + (double)model[4 + j] * (double)v[1] +
                 (double)model[8 + j] * (double)v[2];
    }
}

// --- bounds --------------------------------------------------------------------------------------

// Makes it a vector of length 1. False if it is none, or too short to have a direction.
static bool normalize(double v[3], double least)
{
    double length = sqrt(occ_dot(v, v));
    if (!(length > least) || !isfinite(length)) return false;
    for (int j = 0; j < 3; j++)
        v[j] /= length;
    return true;
}

// Some direction across one of length 1.
static void find_across(const double v[3], double out[3])
{
    int least = fabs(v[0]) < fabs(v[1]) ? 0 : 1;
    if (fabs(v[2]) < fabs(v[least])) least = 2;
    double unit[3] = {0.0, 0.0, 0.0};
    unit[least] = 1.0;
    occ_cross(v, unit, out);
    (void)normalize(out, 0.0);
}

// The directions of a box's axes at its place, longest first. Axes without length follow from the
// others. False if they are not at right angles there, or all without length.
static bool carry_frame(const float *model, const occ_box *box, occ_frame3 *frame)
{
    double axis[3][3], square[3], longest = 0.0;
    int order[3] = {0, 1, 2}, found = 0;
    for (int k = 0; k < 3; k++) {
        carry_direction(model, box->axis[k], axis[k]);
        square[k] = occ_dot(axis[k], axis[k]);
        longest = occ_larger(longest, square[k]);
    }
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2 - i; k++)
            if (square[order[k]] < square[order[k + 1]]) {
                int kept = order[k];
                order[k] = order[k + 1];
                order[k + 1] = kept;
            }
    for (int i = 0; i < 3; i++) {
        double *to = frame->axis[found];
        memcpy(to, axis[order[i]], sizeof axis[0]);
        if (!normalize(to, sqrt(longest) * 0x1p-20)) break;
        for (int k = 0; k < found; k++)
            if (fabs(occ_dot(to, frame->axis[k])) > 0x1p-12) return false;
        found++;
    }
    if (found == 0) return false;
    if (found == 1) find_across(frame->axis[0], frame->axis[1]);
    // What is left of rounding goes: fitting wants right angles as good as doubles are.
    double lean = occ_dot(frame->axis[0], frame->axis[1]);
    for (int j = 0; j < 3; j++)
        frame->axis[1][j] -= lean * frame->axis[0][j];
    (void)normalize(frame->axis[1], 0.0);
    occ_cross(frame->axis[0], frame->axis[1], frame->axis[2]);
    return true;
}

occ_result occ_bounds_of_instance(const occ_soup *placed, const float *model, const occ_box *bounds,
                                  const occ_soup_work *work, occ_box *box)
{
    occ_hooks hooks;
    occ_frame3 frame;
    occ_result result = occ_soup_hooks(work, &hooks);
    if (result) return result;
    if (!model) return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "the matrix is NULL");
    if (!bounds || !box) return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "a box is NULL");
    result = occ_box_check(bounds);
    if (result) return occ_fail(&hooks, result, "the bounds of the mesh have a bad number");
    result = check_model(model, &hooks);
    if (!result) result = occ_soup_validate(placed, &hooks);
    if (result) return result;
    if (!carry_frame(model, bounds, &frame)) return occ_bounds_of_soup(placed, work, box);
    occ_points corners = {placed->positions, placed->stride ? placed->stride : 3 * sizeof(float),
                          3 * (size_t)placed->triangle_count, placed->indices};
    return occ_fit_points(&corners, &frame, work, &hooks, box);
}

// --- inner boxes ---------------------------------------------------------------------------------

enum { ROUNDS = 4 };

typedef struct carry_call {
    occ_hooks *hooks;
    const occ_soup *placed;
    const float *model;
    const occ_inner_box *boxes; // of the mesh
    const occ_inner_desc *desc;
    occ_inner_box *made; // those that are still to be had
    uint32_t *from;      // which of the mesh each is
    occ_inner_reason *reasons;
    size_t room, count;
} carry_call;

// A box of the mesh at its place, each side drawn in by `less` units in the last place of its
// largest coordinate. False if nothing is left, or if it is beyond what coordinates may be.
static bool carry_box(const carry_call *call, uint32_t which, double less, occ_inner_box *out)
{
    const occ_box *box = &call->boxes[which].box;
    double most = 0.0, at[3], axis[3][3];
    carry_direction(call->model, box->center, at);
    for (int k = 0; k < 3; k++)
        carry_direction(call->model, box->axis[k], axis[k]);
    *out = (occ_inner_box){.gain = call->boxes[which].gain, .closed = true};
    for (int j = 0; j < 3; j++) {
        at[j] += (double)call->model[12 + j];
        most =
            occ_larger(most, fabs(at[j]) + fabs(axis[0][j]) + fabs(axis[1][j]) + fabs(axis[2][j]));
        out->box.center[j] = occ_nearest(at[j]);
    }
    for (int k = 0; k < 3; k++) {
        double length = sqrt(occ_dot(axis[k], axis[k]));
        double factor = 1.0 - less * 0x1p-23 * most / length;
        if (!(factor > 0.25)) return false;
        for (int j = 0; j < 3; j++)
            out->box.axis[k][j] = occ_nearest(axis[k][j] * factor);
    }
    return occ_box_check(&out->box) == OCC_SUCCESS;
}

// Keeps what was accepted, and what is worth another try, drawn in by `less`. Returns how many are.
static size_t sift(carry_call *call, double less)
{
    size_t kept = 0, again = 0;
    for (size_t i = 0; i < call->count; i++) {
        uint32_t from = call->from[i];
        occ_inner_box box = call->made[i];
        bool entered = call->reasons[i] == OCC_INNER_ENTERED;
        if (entered && less > 0.0 && carry_box(call, from, less, &box)) {
            again++;
        } else if (call->reasons[i] != OCC_INNER_SOUND) {
            continue;
        }
        call->made[kept] = box;
        call->from[kept++] = from;
    }
    call->count = kept;
    return again;
}

static occ_result carry_boxes(carry_call *call)
{
    static const double less[ROUNDS] = {4.0, 32.0, 256.0, 0.0};
    for (uint32_t i = 0; i < call->room; i++) {
        call->from[call->count] = i;
        call->count += carry_box(call, i, 0.0, &call->made[call->count]);
    }
    size_t open = call->count;
    for (int round = 0; open && round < ROUNDS; round++) {
        occ_result result = occ_inner_judge(call->hooks, call->placed, call->made, call->count,
                                            call->desc, call->reasons);
        if (result) return result;
        open = sift(call, less[round]);
    }
    return OCC_SUCCESS;
}

static occ_result carry_all(carry_call *call, occ_inner_box *carried, size_t *carried_count)
{
    occ_hooks *hooks = call->hooks;
    size_t room = call->room;
    call->made = occ_alloc(hooks, room * sizeof *call->made);
    call->from = occ_alloc(hooks, room * sizeof *call->from);
    call->reasons = occ_alloc(hooks, room * sizeof *call->reasons);
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    if (call->made && call->from && call->reasons) {
        result = carry_boxes(call);
    } else {
        (void)occ_fail(hooks, result, "no memory to carry %zu boxes", room);
    }
    if (!result) {
        memcpy(carried, call->made, call->count * sizeof *carried);
        *carried_count = call->count;
    }
    occ_free(hooks, call->reasons, room * sizeof *call->reasons);
    occ_free(hooks, call->from, room * sizeof *call->from);
    occ_free(hooks, call->made, room * sizeof *call->made);
    return result;
}

occ_result occ_inner_of_instance(const occ_soup *placed, const float *model,
                                 const occ_inner_box *boxes, size_t count,
                                 const occ_inner_desc *desc, occ_inner_box *carried,
                                 size_t *carried_count)
{
    occ_hooks hooks;
    occ_inner_desc taken = {0};
    if (desc) taken = *desc;
    taken.max_hole = 0.0f; // what a flood found is no longer known at another place
    occ_result result = occ_soup_hooks(&taken.work, &hooks);
    if (result) return result;
    if (!model) return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "the matrix is NULL");
    if (!carried_count || (count && (!boxes || !carried)))
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "boxes or carried is NULL");
    if (count >= UINT32_MAX) return occ_fail(&hooks, OCC_ERROR_LIMIT, "%zu boxes", count);
    result = occ_inner_take_desc(&hooks, &taken);
    if (!result) result = check_model(model, &hooks);
    if (!result) result = occ_soup_validate(placed, &hooks);
    for (size_t i = 0; !result && i < count; i++) {
        result = occ_box_check(&boxes[i].box);
        if (result) return occ_fail(&hooks, result, "box %zu has numbers that are no box", i);
    }
    if (result) return result;
    carry_call call = {.hooks = &hooks,
                       .placed = placed,
                       .model = model,
                       .boxes = boxes,
                       .desc = &taken,
                       .room = count};
    if (count) return carry_all(&call, carried, carried_count);
    *carried_count = 0;
    return OCC_SUCCESS;
}
