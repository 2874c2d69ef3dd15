// SPDX-License-Identifier: Apache-2.0
// Seen from the eye, boxes and sheets are intervals of x / w and y / w, whose ends are at corners,
// and of depth. A segment from the eye to a point has the point's x / w and y / w and no greater
// depth, so an occluder whose intervals are apart from the object's never meets one.
#include "settle_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of the magnitudes that enter it, what the value of a row at a corner may have lost: four
// roundings in the corner and four in the value, 2^-53 each, and as much again.
#define LOSS 0x1p-49

enum { X, Y, W, DEPTH, VALUES };

// The corners of a box or a sheet in the camera's coordinates, and what these may have lost.
typedef struct sighting {
    int count;
    double at[8][VALUES], loss[VALUES];
} sighting;

typedef char sheet_fits_a_sighting[OCC_SHEET_CORNERS <= 8 ? 1 : -1];

// `reach` is the magnitude of what the corners are computed from.
static void sight_corners(const truth_view *view, double (*corner)[3], const double reach[3],
                          sighting *s)
{
    const double *rows[VALUES] = {view->row[0], view->row[1], view->row[2], view->depth};
    for (int i = 0; i < VALUES; i++) {
        const double *row = rows[i];
        const double size[3] = {fabs(row[0]), fabs(row[1]), fabs(row[2])};
        s->loss[i] = LOSS * (truth_dot(size, reach) + fabs(row[3]));
        for (int c = 0; c < s->count; c++)
            s->at[c][i] = truth_value(row, corner[c]);
    }
}

static void sight_sheet(const truth_view *view, const occ_sheet *sheet, sighting *s)
{
    double corner[8][3], reach[3];
    s->count = (int)sheet->corner_count;
    for (int j = 0; j < 3; j++) {
        reach[j] = 0.0;
        for (int c = 0; c < s->count; c++) {
            corner[c][j] = (double)sheet->corner[c][j] - view->eye[j];
            reach[j] = fmax(reach[j], fabs((double)sheet->corner[c][j]) + fabs(view->eye[j]));
        }
    }
    sight_corners(view, corner, reach, s);
}

static void sight_box(const truth_view *view, const occ_box *box, sighting *s)
{
    double corner[8][3], reach[3];
    s->count = 8;
    for (int j = 0; j < 3; j++) {
        reach[j] = fabs((double)box->center[j]) + fabs(view->eye[j]);
        for (int k = 0; k < 3; k++)
            reach[j] += fabs((double)box->axis[k][j]);
        for (int c = 0; c < 8; c++) {
            corner[c][j] = (double)box->center[j] - view->eye[j];
            for (int k = 0; k < 3; k++)
                corner[c][j] += (c >> k & 1 ? 1.0 : -1.0) * (double)box->axis[k][j];
        }
    }
    sight_corners(view, corner, reach, s);
}

// Takes in a point whose w is more than what it may have lost.
static void widen(settle_extent *extent, const double at[VALUES], const double loss[VALUES])
{
    for (int i = 0; i < 2; i++) {
        double ratio = at[i] / at[W];
        double more = (loss[i] + fabs(ratio) * loss[W]) / (at[W] - loss[W]);
        more = 1.001 * more + 0x1p-50 * fabs(ratio);
        extent->low[i] = fmin(extent->low[i], ratio - more);
        extent->high[i] = fmax(extent->high[i], ratio + more);
    }
}

// Of what is partly before `least`: the corners beyond, and all lines between corners cut about
// there, the edges among them. A cut that roundings put beside the plane is still a point of the
// edge whose w is between 0 and four times `least`, which is enough.
static void widen_beyond(settle_extent *extent, const sighting *s, double least)
{
    double loss[VALUES];
    for (int i = 0; i < VALUES; i++)
        loss[i] = 8.0 * s->loss[i];
    for (int c = 0; c < s->count; c++) {
        const double *from = s->at[c];
        if (from[W] < least) continue;
        widen(extent, from, loss);
        for (int k = 0; k < s->count; k++) {
            const double *to = s->at[k];
            if (to[W] >= least) continue;
            double t = (from[W] - least) / (from[W] - to[W]), cut[VALUES];
            for (int i = 0; i < VALUES; i++)
                cut[i] = from[i] + t * (to[i] - from[i]);
            widen(extent, cut, loss);
        }
    }
}

// False if all of it is surely outside the frustum.
static bool find_extent(const settle_frame *frame, const sighting *s, settle_extent *extent)
{
    double nearest = INFINITY, farthest = -INFINITY;
    for (int i = 0; i < 3; i++) {
        extent->low[i] = INFINITY;
        extent->high[i] = -INFINITY;
    }
    for (int c = 0; c < s->count; c++) {
        nearest = fmin(nearest, s->at[c][W]);
        farthest = fmax(farthest, s->at[c][W]);
        extent->low[2] = fmin(extent->low[2], s->at[c][DEPTH] - s->loss[DEPTH]);
        extent->high[2] = fmax(extent->high[2], s->at[c][DEPTH] + s->loss[DEPTH]);
    }
    double least = frame->least_depth;
    if (farthest + s->loss[W] < least) return false;
    if (nearest > fmax(least, 16.0 * s->loss[W])) {
        for (int c = 0; c < s->count; c++)
            widen(extent, s->at[c], s->loss);
    } else if (least > 16.0 * s->loss[W]) {
        widen_beyond(extent, s, least);
    } else {
        for (int i = 0; i < 2; i++) {
            extent->low[i] = -INFINITY;
            extent->high[i] = INFINITY;
        }
    }
    return extent->low[X] <= 1.0 && extent->high[X] >= -1.0 && extent->low[Y] <= 1.0 &&
           extent->high[Y] >= -1.0;
}

static bool find_occluder_extent(const settle_frame *frame, uint32_t number, settle_extent *extent)
{
    sighting s;
    const occ_sheet *sheet = obs_occluder_sheet(frame->scene, number);
    if (sheet)
        sight_sheet(&frame->view, sheet, &s);
    else
        sight_box(&frame->view, &frame->scene->occluders[number].box, &s);
    return find_extent(frame, &s, extent);
}

// A quarter of the near corners' least depth, if these are what is nearest in the frustum, and far
// enough to be more than the rounding of the eye.
static double find_least_depth(const truth_view *view)
{
    bool is_perspective = view->row[2][3] == 0.0;
    double least = INFINITY, size = 0.0;
    for (int c = 0; c < 4; c++)
        least = fmin(least, truth_value(view->row[2], view->near_corner[c]));
    for (int j = 0; j < 3; j++)
        size += fabs(view->row[2][j] * view->eye[j]);
    bool is_nearest = is_perspective && view->plane[TRUTH_NEAR][3] < 0.0;
    return is_nearest && least > 0x1p-20 * size ? 0.25 * least : 0.0;
}

// A Morton code of 2 x 8 bits (G. M. Morton, 1966), of what is in the viewport.
static uint32_t find_place(const settle_extent *extent)
{
    uint32_t place = 0, at[2];
    for (int i = 0; i < 2; i++) {
        double middle = 0.5 * (fmax(extent->low[i], -1.0) + fmin(extent->high[i], 1.0));
        at[i] = (uint32_t)(127.5 * (middle + 1.0));
    }
    for (int bit = 0; bit < 8; bit++)
        place |= (at[0] >> bit & 1u) << 2 * bit | (at[1] >> bit & 1u) << (2 * bit + 1);
    return place;
}

static int compare_place(const void *a, const void *b)
{
    const settle_extent *x = a, *y = b;
    return (x->place > y->place) - (x->place < y->place);
}

static void bound_runs(settle_frame *frame)
{
    for (uint32_t e = 0; e < frame->count; e++) {
        settle_extent *run = &frame->runs[e / SETTLE_RUN];
        const settle_extent *extent = &frame->extents[e];
        if (e % SETTLE_RUN == 0) *run = *extent;
        for (int i = 0; i < 3; i++) {
            run->low[i] = fmin(run->low[i], extent->low[i]);
            run->high[i] = fmax(run->high[i], extent->high[i]);
        }
    }
}

const char *settle_frame_make(settle_frame *frame, const obs_scene *scene, uint32_t index)
{
    size_t occluders = obs_occluder_total(scene);
    *frame = (settle_frame){.scene = scene};
    if (!truth_view_make(&frame->view, &scene->frames[index], 1, 1))
        return "its camera has no eye or no direction of view";
    frame->least_depth = find_least_depth(&frame->view);
    frame->extents = malloc((occluders + 1) * sizeof *frame->extents);
    frame->runs = malloc((occluders / SETTLE_RUN + 1) * sizeof *frame->runs);
    if (!frame->extents || !frame->runs) return "not enough memory";
    for (uint32_t i = 0; i < occluders; i++) {
        settle_extent *extent = &frame->extents[frame->count];
        if (!find_occluder_extent(frame, i, extent)) continue;
        extent->occluder = i;
        extent->place = find_place(extent);
        frame->count++;
    }
    qsort(frame->extents, frame->count, sizeof *frame->extents, compare_place);
    bound_runs(frame);
    return NULL;
}

void settle_frame_free(settle_frame *frame)
{
    free(frame->extents);
    free(frame->runs);
    *frame = (settle_frame){0};
}

// --- selecting -----------------------------------------------------------------------------------

// How much of b's interval a covers.
static double cover(const settle_extent *a, const settle_extent *b, int i)
{
    double common = fmin(a->high[i], b->high[i]) - fmax(a->low[i], b->low[i]);
    double whole = b->high[i] - b->low[i];
    return whole > 0.0 ? common / whole : 1.0;
}

static bool is_better(const settle_candidate *a, const settle_candidate *b)
{
    return a->cover > b->cover || (a->cover == b->cover && a->occluder < b->occluder);
}

static void swap(settle_candidate *a, settle_candidate *b)
{
    settle_candidate kept = *a;
    *a = *b;
    *b = kept;
}

// Brings the best to the front, in order.
static void rank(settle_candidate *list, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        uint32_t at = i < SETTLE_BEST ? i : SETTLE_BEST - 1;
        if (at < i && is_better(&list[i], &list[at])) swap(&list[i], &list[at]);
        for (; at > 0 && is_better(&list[at], &list[at - 1]); at--)
            swap(&list[at], &list[at - 1]);
    }
}

// Whether an occluder, or some of a run, can be before the object and over it.
static bool can_cover(const settle_extent *other, const settle_extent *object)
{
    return other->low[2] <= object->high[2] && other->low[X] <= object->high[X] &&
           other->high[X] >= object->low[X] && other->low[Y] <= object->high[Y] &&
           other->high[Y] >= object->low[Y];
}

uint32_t settle_frame_select(const settle_frame *frame, uint32_t object, settle_candidate *list)
{
    sighting s;
    settle_extent extent;
    uint32_t found = 0;
    sight_box(&frame->view, &frame->scene->objects[object], &s);
    if (!find_extent(frame, &s, &extent)) return 0;
    for (int i = 0; i < 2; i++) {
        extent.low[i] = fmax(extent.low[i], -1.0);
        extent.high[i] = fmin(extent.high[i], 1.0);
    }
    for (uint32_t e = 0; e < frame->count; e++) {
        const settle_extent *other = &frame->extents[e];
        if (e % SETTLE_RUN == 0 && !can_cover(&frame->runs[e / SETTLE_RUN], &extent))
            e += SETTLE_RUN - 1;
        else if (can_cover(other, &extent) &&
                 obs_occluder_owner(frame->scene, other->occluder) != object)
            list[found++] = (settle_candidate){cover(other, &extent, X) * cover(other, &extent, Y),
                                               other->occluder};
    }
    rank(list, found);
    return found;
}
