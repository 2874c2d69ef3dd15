// SPDX-License-Identifier: Apache-2.0
// The set of occluders that a frame has found so far.
#include "frame.h"

#include "shadow.h"
#include "sheet.h"
#include "vector.h"

#include <string.h>

_Static_assert(OCC_NO_SLOT == OCC_NOBODY, "an owner's row is what a shadow knows of it");

void occ_occluders_clear(occ_frame *frame)
{
    frame->shadows.count = frame->wide.count = frame->sources.count = frame->rects.count = 0;
}

void occ_occluders_prepare(occ_frame *frame)
{
    const occ_camera *camera = &frame->camera;
    occ_selection *choice = &frame->selection;
    *choice = (occ_selection){
        .eye = &camera->constants, .screen = &camera->screen, .orthographic = camera->orthographic};
    choice->least = frame->knobs.min_area;
    choice->scale = 1.0f;
    for (int j = 0; j < 3; j++)
        choice->toward[j] = (float)camera->toward[j];
    if (!camera->orthographic) return;
    if (camera->view_area > 0.0) {
        choice->scale = (float)(1.0 / sqrt(camera->view_area));
    } else {
        choice->least = 0.0f;
    }
}

bool occ_occluder_may_be_large(const occ_frame *frame, float reach, float key)
{
    const occ_camera *camera = &frame->camera;
    double area = camera->orthographic ? camera->view_area : (double)key * (1.0 - 1e-5);
    return (double)reach >= (double)frame->knobs.min_area * area;
}

bool occ_occluder_sheet_is_large(const occ_frame *frame, const occ_sheet *sheet)
{
    const occ_camera *camera = &frame->camera;
    double normal[3], toward[3], distance = 0.0;
    occ_sheet_normal(sheet, normal);
    for (int j = 0; j < 3; j++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < sheet->corner_count; i++)
            sum += (double)sheet->corner[i][j];
        toward[j] = camera->eye[j] - sum / sheet->corner_count;
        if (camera->orthographic) toward[j] = camera->toward[j];
        distance += toward[j] * toward[j];
    }
    double shown = 0.5 * occ_dot(normal, toward);
    if (sheet->sides == OCC_SIDES_BOTH) shown = fabs(shown);
    double unit = camera->orthographic ? camera->view_area : distance;
    return shown > 0.0 && shown >= (double)frame->selection.least * sqrt(distance) * unit;
}

// How far outside of its bounds on the screen an occluder's shadow may reach. Projections round by
// less than 2^-13; a tolerance turns the shadow's planes outward (shadow.c), its corners by
// less than that angle t. A direction of length 1 that is turned by t moves u = x / w to (x + dx) /
// (w + dw), with |dx| <= t |row 0| and |dw| <= t |row 2|; w is least at a corner of the occluder.
static float room_around(const occ_camera *camera, const occ_projection *seen, int j)
{
    const occ_screen *screen = &camera->screen;
    float most = fmaxf(fabsf(seen->min[j]), fabsf(seen->max[j])), room = (1.0f + most) * 0x1p-10f;
    if (!(camera->tolerance > 0.0) || camera->orthographic) return room;
    const float *x = screen->row[j], *w = screen->row[2];
    float least = INFINITY, t = (float)camera->tolerance;
    for (int k = 0; k < 8; k++) {
        float size = OCC_NORM1(seen->x[k], seen->y[k], seen->z[k]);
        least = fminf(least, (w[0] * seen->x[k] + w[1] * seen->y[k] + w[2] * seen->z[k]) / size);
    }
    float dx = t * OCC_NORM1(x[0], x[1], x[2]), dw = t * OCC_NORM1(w[0], w[1], w[2]);
    return least > dw ? room + 1.01f * (dx + most * dw) / (least - dw) : INFINITY;
}

// Where an occluder is on the screen, with room to spare.
static void put_rect(occ_rect_block *block, uint32_t lane, const occ_camera *camera,
                     const occ_projection *seen, float key)
{
    for (int j = 0; j < 2; j++) {
        float room = room_around(camera, seen, j);
        block->min[j][lane] = seen->min[j] - room;
        block->max[j][lane] = seen->max[j] + room;
    }
    block->key[lane] = key;
}

occ_result occ_occluders_add(occ_frame *frame, uint32_t row, float key, const occ_projection *seen)
{
    const occ_scene *scene = frame->scene;
    uint32_t slot = scene->occluder_rows.slot_of[row], owner = occ_scene_owner_row(scene, row);
    uint32_t lane = frame->shadows.count % OCC_SHADOW_LANES;
    occ_shadow *shadow = occ_frame_extend(frame, &frame->shadows, 1);
    occ_wide_shadow *wide = occ_frame_extend(frame, &frame->wide, 1);
    occ_occluder *source = occ_frame_extend(frame, &frame->sources, 1);
    if (!shadow || !source || !wide) return OCC_ERROR_OUT_OF_MEMORY;
    if (!occ_frame_extend(frame, &frame->rects, 1)) return OCC_ERROR_OUT_OF_MEMORY;
    const occ_box *box = &occ_scene_occluder_boxes(scene)[row];
    const occ_sheet *sheet = occ_scene_sheet(scene, row);
    bool hides = sheet ? occ_shadow_of_sheet(shadow, &frame->camera, sheet, owner)
                       : frame->lanes->shade(shadow, &frame->camera, box, owner);
    if (!hides) return OCC_SUCCESS;
    occ_wide_shadow_set(wide, shadow);
    *source = (occ_occluder){slot + 1, scene->occluders.generation[slot]};
    if (!lane)
        ((occ_rect_block *)frame->rects.data)[frame->rects.count++] =
            (occ_rect_block){.key = {0.0f}};
    put_rect((occ_rect_block *)frame->rects.data + frame->rects.count - 1, lane, &frame->camera,
             seen, key);
    frame->shadows.count++;
    frame->wide.count++;
    frame->sources.count++;
    return OCC_SUCCESS;
}

#define MOST_SORTED 64u // candidates of a range that are sorted

// How much of the screen an occluder takes up.
static float shown_area(const occ_shadow_set *set, uint32_t i)
{
    const occ_rect_block *block = &set->rects[i / OCC_SHADOW_LANES];
    float area = 1.0f;
    for (uint32_t j = 0; j < 2; j++) {
        float min = block->min[j][i % OCC_SHADOW_LANES], max = block->max[j][i % OCC_SHADOW_LANES];
        area *= (max < 1.0f ? max : 1.0f) - (min > -1.0f ? min : -1.0f);
    }
    return area;
}

void occ_occluders_sort(const occ_shadow_set *set, uint32_t *list, uint32_t count)
{
    uint32_t sorted[MOST_SORTED], placed = 0;
    float area[MOST_SORTED], least = 0.0f;
    if (count < 2 || count > MOST_SORTED) return;
    for (uint32_t i = 0; i < count; i++) {
        area[i] = shown_area(set, list[i]);
        least = area[i] > least ? area[i] : least;
    }
    uint64_t waiting = ~(uint64_t)0 >> (MOST_SORTED - count);
    for (uint32_t step = 0; waiting; step++) {
        least = step < 3 ? least * 0.25f : -INFINITY;
        for (uint64_t left = waiting; left; left &= left - 1) {
            uint32_t i = (uint32_t)__builtin_ctzll(left);
            if (area[i] < least) continue; // a NaN goes first
            sorted[placed++] = list[i];
            waiting &= ~((uint64_t)1 << i);
        }
    }
    memcpy(list, sorted, count * sizeof *list);
}

occ_shadow_set occ_occluders_so_far(const occ_frame *frame)
{
    return (occ_shadow_set){frame->shadows.data, frame->wide.data, frame->rects.data,
                            frame->shadows.count};
}
