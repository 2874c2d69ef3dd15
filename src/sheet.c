// SPDX-License-Identifier: Apache-2.0
// What a scene knows of a sheet beside its corners.
#include "sheet.h"

#include "box.h"
#include "rounding.h"
#include "vector.h"

// Relative to the extent of a sheet: below are the roundings of this file, and sheets without area.
#define NOTHING 0x1p-40

occ_result occ_sheet_check(const occ_sheet *sheet, const char **reason)
{
    *reason = "a sheet has 3 to 8 corners";
    if (sheet->corner_count < 3 || sheet->corner_count > OCC_SHEET_CORNERS) {
        return OCC_ERROR_INVALID_ARGUMENT;
    }
    *reason = "there are no such sides";
    if ((unsigned)sheet->sides > OCC_SIDES_FRONT) return OCC_ERROR_INVALID_ARGUMENT;
    bool in_range = true;
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        for (int j = 0; j < 3; j++) {
            *reason = "a corner is not finite";
            if (!isfinite(sheet->corner[i][j])) return OCC_ERROR_NOT_FINITE;
            in_range = in_range && fabsf(sheet->corner[i][j]) <= OCC_MAX_COORDINATE;
        }
    }
    *reason = "a corner is beyond OCC_MAX_COORDINATE";
    return in_range ? OCC_SUCCESS : OCC_ERROR_OUT_OF_RANGE;
}

occ_sheet occ_sheet_plain(const occ_sheet *sheet)
{
    occ_sheet plain;
    memset(&plain, 0, sizeof plain);
    plain.corner_count = sheet->corner_count;
    plain.sides = sheet->sides;
    memcpy(plain.corner, sheet->corner, sheet->corner_count * sizeof *sheet->corner);
    return plain;
}

// Corner i as seen from a point.
static void corner_from(const occ_sheet *sheet, uint32_t i, const float from[3], double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = (double)sheet->corner[i][j] - (double)from[j];
}

void occ_sheet_normal(const occ_sheet *sheet, double normal[3])
{
    double before[3], here[3], turn[3];
    normal[0] = normal[1] = normal[2] = 0.0;
    corner_from(sheet, 1, sheet->corner[0], before);
    for (uint32_t i = 2; i < sheet->corner_count; i++) {
        corner_from(sheet, i, sheet->corner[0], here);
        occ_cross(before, here, turn);
        for (int j = 0; j < 3; j++) {
            normal[j] += turn[j];
            before[j] = here[j];
        }
    }
}

// --- the proxy -----------------------------------------------------------------------------------

// A frame of three directions, the third across the sheet, and how far the corners reach in it.
typedef struct sheet_frame {
    double axis[3][3];
    double low[3], high[3];
} sheet_frame;

// Sets how far the corners reach, seen from a point. False if the directions span nothing.
static bool measure(sheet_frame *frame, const occ_sheet *sheet, const float from[3])
{
    double dual[3][3];
    for (int k = 0; k < 3; k++) {
        occ_cross(frame->axis[(k + 1) % 3], frame->axis[(k + 2) % 3], dual[k]);
        frame->low[k] = INFINITY;
        frame->high[k] = -INFINITY;
    }
    double volume = occ_dot(dual[2], frame->axis[2]);
    if (!(fabs(volume) > 0.0)) return false;
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        double d[3];
        corner_from(sheet, i, from, d);
        for (int k = 0; k < 3; k++) {
            double at = occ_dot(dual[k], d);
            if (volume < 0.0) at = -at;
            frame->low[k] = at < frame->low[k] ? at : frame->low[k];
            frame->high[k] = at > frame->high[k] ? at : frame->high[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        frame->low[k] /= fabs(volume);
        frame->high[k] /= fabs(volume);
    }
    return true;
}

// Takes the frame if its parallelogram is smaller than that of the best so far.
static void offer(sheet_frame *best, double *least, sheet_frame *frame, const occ_sheet *sheet)
{
    double normal[3];
    if (!measure(frame, sheet, sheet->corner[0])) return;
    occ_cross(frame->axis[0], frame->axis[1], normal);
    double area = (frame->high[0] - frame->low[0]) * (frame->high[1] - frame->low[1]);
    area *= sqrt(occ_dot(normal, normal));
    if (!(area < *least)) return;
    *least = area;
    *best = *frame;
}

// Edge i; all zero if its ends are one.
static void edge_of(const occ_sheet *sheet, uint32_t i, double edge[3])
{
    uint32_t next = i + 1 < sheet->corner_count ? i + 1 : 0;
    corner_from(sheet, next, sheet->corner[i], edge);
}

// The smallest parallelogram around the corners among those that have an edge along one of the
// sheet's, and the other at a right angle or along the next one. False if the sheet is too thin for
// that.
static bool find_frame(sheet_frame *best, const occ_sheet *sheet)
{
    sheet_frame frame;
    double least = INFINITY, normal[3], extent = 0.0;
    *best = (sheet_frame){.low = {0.0}};
    occ_sheet_normal(sheet, normal);
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        edge_of(sheet, i, frame.axis[0]);
        extent = occ_larger(extent, occ_dot(frame.axis[0], frame.axis[0]));
    }
    double twice = sqrt(occ_dot(normal, normal));
    if (!(twice > extent * NOTHING) || !(twice > 1e-60)) return false;
    for (int j = 0; j < 3; j++)
        frame.axis[2][j] = normal[j] / twice;
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        edge_of(sheet, i, frame.axis[0]);
        occ_cross(frame.axis[2], frame.axis[0], frame.axis[1]);
        offer(best, &least, &frame, sheet);
        double turn[3], sizes = occ_dot(frame.axis[0], frame.axis[0]);
        edge_of(sheet, i + 1 < sheet->corner_count ? i + 1 : 0, frame.axis[1]);
        occ_cross(frame.axis[0], frame.axis[1], turn);
        sizes *= occ_dot(frame.axis[1], frame.axis[1]);
        if (occ_dot(turn, turn) > sizes * 0x1p-20) offer(best, &least, &frame, sheet);
    }
    return least < INFINITY;
}

// The box of a frame, in floats.
static occ_box box_of_frame(const sheet_frame *frame, const occ_sheet *sheet)
{
    occ_box box;
    for (int j = 0; j < 3; j++) {
        double center = (double)sheet->corner[0][j];
        for (int k = 0; k < 3; k++)
            center += 0.5 * (frame->low[k] + frame->high[k]) * frame->axis[k][j];
        box.center[j] = occ_nearest(center);
        for (int k = 0; k < 2; k++)
            box.axis[k][j] =
                occ_nearest(0.5 * (frame->high[k] - frame->low[k]) * frame->axis[k][j]);
        box.axis[2][j] = 0.0f;
    }
    return box;
}

// Lets the box hold the corners in spite of what its numbers were rounded by.
static bool widen(occ_box *box, const sheet_frame *fitted, const occ_sheet *sheet)
{
    sheet_frame frame;
    for (int j = 0; j < 3; j++) {
        frame.axis[0][j] = (double)box->axis[0][j];
        frame.axis[1][j] = (double)box->axis[1][j];
        frame.axis[2][j] = fitted->axis[2][j];
    }
    if (!measure(&frame, sheet, box->center)) return false;
    double extent = occ_larger(occ_largest(frame.axis[0]), occ_largest(frame.axis[1]));
    for (int k = 0; k < 3; k++) {
        double reach = occ_larger(-frame.low[k], frame.high[k]);
        if (reach <= (k < 2 ? 1.0 + NOTHING : extent * NOTHING)) continue;
        for (int j = 0; j < 3; j++)
            box->axis[k][j] = occ_nearest(reach * (1.0 + 0x1p-20) * frame.axis[k][j]);
    }
    return !occ_box_check(box);
}

occ_box occ_sheet_proxy(const occ_sheet *sheet)
{
    sheet_frame frame;
    occ_box box;
    if (find_frame(&frame, sheet)) {
        box = box_of_frame(&frame, sheet);
        if (widen(&box, &frame, sheet)) return box;
    }
    if (!occ_box_from_points(&sheet->corner[0][0], sheet->corner_count, 0, &box)) return box;
    box = (occ_box){{0.0f, 0.0f, 0.0f}, {{0.0f}}}; // at the end of the world
    for (int j = 0; j < 3; j++)
        box.axis[j][j] = OCC_MAX_COORDINATE;
    return box;
}
