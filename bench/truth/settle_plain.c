// SPDX-License-Identifier: Apache-2.0
// Which occluders leave nothing to argue about. Whatever is not clear in double is not plain.
#include "settle_frame.h"

#include <math.h>

// How much of the magnitudes that enter a difference it must be to be clear.
#define CLEARLY 1e-9

static void normal_of(const occ_box *box, int face, double normal[3])
{
    double u[3], v[3];
    for (int j = 0; j < 3; j++) {
        u[j] = (double)box->axis[(face + 1) % 3][j];
        v[j] = (double)box->axis[(face + 2) % 3][j];
    }
    truth_cross(u, v, normal);
}

// How far a box reaches to both sides of its center along a direction of any length.
static double reach_of(const occ_box *box, const double along[3])
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double axis[3] = {(double)box->axis[k][0], (double)box->axis[k][1],
                                (double)box->axis[k][2]};
        sum += fabs(truth_dot(along, axis));
    }
    return sum;
}

// Where the center is along a direction, counted from the eye, and the magnitude of what that is
// computed from.
static double place_of(const truth_view *view, const occ_box *box, const double along[3],
                       double *size)
{
    double place = 0.0;
    *size = 0.0;
    for (int j = 0; j < 3; j++) {
        place += along[j] * ((double)box->center[j] - view->eye[j]);
        *size += fabs(along[j]) * (fabs((double)box->center[j]) + fabs(view->eye[j]));
    }
    return place;
}

static bool are_apart_along(const truth_view *view, const occ_box *a, const occ_box *b,
                            const double along[3])
{
    double size_a, size_b, reach = reach_of(a, along) + reach_of(b, along);
    double between = place_of(view, a, along, &size_a) - place_of(view, b, along, &size_b);
    return fabs(between) > reach + CLEARLY * (reach + size_a + size_b);
}

static bool are_apart(const truth_view *view, const occ_box *a, const occ_box *b)
{
    for (int k = 0; k < 3; k++) {
        double unit[3] = {0.0, 0.0, 0.0}, normal[3];
        unit[k] = 1.0;
        if (are_apart_along(view, a, b, unit)) return true;
        normal_of(a, k, normal);
        if (are_apart_along(view, a, b, normal)) return true;
        normal_of(b, k, normal);
        if (are_apart_along(view, a, b, normal)) return true;
    }
    return false;
}

static bool is_beyond_near(const truth_view *view, const occ_box *box)
{
    const double *plane = view->plane[TRUTH_NEAR];
    double size, reach = reach_of(box, plane), place = place_of(view, box, plane, &size);
    return place + plane[3] > reach + CLEARLY * (reach + size + fabs(plane[3]));
}

// Whether a face has the box on one side, and on the other the eye with what of the frustum is
// before the near plane.
static bool is_whole(const truth_view *view, const occ_box *box)
{
    bool is_perspective = view->row[2][3] == 0.0;
    if (is_beyond_near(view, box)) return true;
    for (int k = 0; is_perspective && k < 3; k++) {
        double normal[3], size;
        normal_of(box, k, normal);
        double place = place_of(view, box, normal, &size), low = 0.0, high = 0.0;
        for (int c = 0; c < 4; c++) {
            double at = truth_dot(normal, view->near_corner[c]);
            low = fmin(low, at);
            high = fmax(high, at);
        }
        double reach = reach_of(box, normal);
        double margin = reach + CLEARLY * (reach + size + high - low);
        if (place - margin > high || place + margin < low) return true;
    }
    return false;
}

// Whether the object is behind the planes of all faces that look towards the eye, and in none.
static bool is_behind(const truth_view *view, const occ_box *occluder, const occ_box *object)
{
    for (int k = 0; k < 3; k++) {
        double normal[3], size, object_size;
        normal_of(occluder, k, normal);
        if (truth_dot(normal, normal) == 0.0) continue;
        double place = place_of(view, occluder, normal, &size), reach = reach_of(occluder, normal);
        double margin = CLEARLY * (reach + size);
        if (fabs(place) < reach - margin) continue; // neither of the two looks towards the eye
        double side = place > 0.0 ? 1.0 : -1.0;
        double nearest = side * place_of(view, object, normal, &object_size);
        double object_reach = reach_of(object, normal);
        margin += CLEARLY * (object_reach + object_size);
        if (nearest - object_reach <= side * place - reach + margin) return false;
    }
    return true;
}

static bool is_plain_box(const settle_frame *frame, const occ_box *occluder, const occ_box *object)
{
    const truth_view *view = &frame->view;
    bool is_perspective = view->row[2][3] == 0.0;
    truth_solid solids[TRUTH_MAX_SOLIDS];
    return truth_solids_of(view, occluder, solids) > 0 && is_whole(view, occluder) &&
           ((is_perspective && is_behind(view, occluder, object)) ||
            are_apart(view, occluder, object));
}

// --- sheets --------------------------------------------------------------------------------------

// Where a sheet's corners are along a direction, counted from the eye, and the magnitude of what
// that is computed from.
typedef struct span {
    double low, high, size;
} span;

static span span_of(const truth_view *view, const occ_sheet *sheet, const double along[3])
{
    span s = {INFINITY, -INFINITY, 0.0};
    for (uint32_t c = 0; c < sheet->corner_count; c++) {
        double at = 0.0, size = 0.0;
        for (int j = 0; j < 3; j++) {
            at += along[j] * ((double)sheet->corner[c][j] - view->eye[j]);
            size += fabs(along[j]) * (fabs((double)sheet->corner[c][j]) + fabs(view->eye[j]));
        }
        s.low = fmin(s.low, at);
        s.high = fmax(s.high, at);
        s.size = fmax(s.size, size);
    }
    return s;
}

// Clearly between the eye, with all that the near plane takes away, and the object; or clearly
// beside the object.
static bool parts(const truth_view *view, const occ_sheet *sheet, const occ_box *object,
                  const double along[3], bool *is_before)
{
    span s = span_of(view, sheet, along);
    double size, reach = reach_of(object, along), place = place_of(view, object, along, &size);
    double margin = CLEARLY * (reach + size + s.size), low = 0.0, high = 0.0;
    for (int c = 0; c < 4; c++) {
        double at = truth_dot(along, view->near_corner[c]);
        low = fmin(low, at);
        high = fmax(high, at);
    }
    margin += CLEARLY * (high - low);
    bool is_above = place - reach > s.high + margin, is_below = place + reach < s.low - margin;
    *is_before = (is_above && s.low > high + margin) || (is_below && s.high < low - margin);
    return is_above || is_below;
}

// As for boxes; a sheet that is bent has a surface to every triangle.
static bool is_plain_sheet(const settle_frame *frame, const occ_sheet *sheet, const occ_box *object)
{
    const truth_view *view = &frame->view;
    bool is_perspective = view->row[2][3] == 0.0, is_before, is_apart = false, is_whole = true;
    for (uint32_t t = 0; t + 2 < sheet->corner_count; t++) {
        truth_solid solid;
        if (!truth_triangle_of(view, sheet, t, &solid)) return false;
        is_apart = parts(view, sheet, object, solid.normal, &is_before) || is_apart;
        is_whole = is_whole && is_before && is_perspective;
    }
    if (is_whole) return true;
    const double *near_plane = view->plane[TRUTH_NEAR];
    span s = span_of(view, sheet, near_plane);
    if (s.low + near_plane[3] <= CLEARLY * (s.size + fabs(near_plane[3]))) return false;
    for (int k = 0; k < 3; k++) {
        double unit[3] = {0.0, 0.0, 0.0}, normal[3];
        unit[k] = 1.0;
        normal_of(object, k, normal);
        is_apart = parts(view, sheet, object, unit, &is_before) || is_apart;
        is_apart = parts(view, sheet, object, normal, &is_before) || is_apart;
    }
    return is_apart;
}

bool settle_frame_is_plain(const settle_frame *frame, uint32_t occluder, const occ_box *object)
{
    const occ_sheet *sheet = obs_occluder_sheet(frame->scene, occluder);
    return sheet ? is_plain_sheet(frame, sheet, object)
                 : is_plain_box(frame, &frame->scene->occluders[occluder].box, object);
}
