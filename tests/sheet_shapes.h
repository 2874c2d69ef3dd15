// SPDX-License-Identifier: Apache-2.0
// Sheets of every shape, and eyes in every awkward place.
#ifndef OCC_TEST_SHEET_SHAPES_H
#define OCC_TEST_SHEET_SHAPES_H

#include "kit_sheets.h"
#include "sheet.h"
#include "sheet_sight.h"
#include "vector.h"
#include "verdicts.h"
#include "worlds.h"

typedef enum sheet_kind {
    KIND_FLAT,   // convex, flat but for what the floats round
    KIND_BENT,   // its corners lie about a plane
    KIND_NOTCH,  // flat, not convex
    KIND_TANGLE, // any points
    KIND_REPEAT, // flat, some corners twice
    KIND_PLANE,  // a parallelogram, exactly
    KINDS
} sheet_kind;

static inline occ_sheet any_sheet(kit_random *random, sheet_kind kind, double size)
{
    float center[3], across[3];
    uint32_t corners = 3 + kit_below(random, 6);
    if (kind == KIND_PLANE) {
        occ_box box = kit_flat_box(random, 10, 1);
        box = world_scaled(&box, exp2f(rintf(log2f((float)size))));
        return kit_sheet_of_box(&box);
    }
    for (int j = 0; j < 3; j++) {
        center[j] = (float)(size * world_between(random, -10, 10));
        across[j] = (float)(size * world_scale(random, 1e-6, 0.3));
    }
    if (kind == KIND_NOTCH && corners == 3) corners = 4;
    occ_sheet sheet = kit_round_sheet(random, corners, center, (float)size);
    uint32_t chosen = kit_below(random, corners), next = (chosen + 1) % corners;
    for (uint32_t i = 0; i < corners; i++)
        for (int j = 0; j < 3; j++) {
            float *at = &sheet.corner[i][j];
            if (kind == KIND_BENT) *at += kit_between(random, -1, 1) * across[j];
            if (kind == KIND_TANGLE) *at = center[j] + kit_between(random, -1, 1) * (float)size;
            if (kind == KIND_NOTCH && i == chosen) *at = 0.8f * center[j] + 0.2f * *at;
            if (kind == KIND_REPEAT && i == next) *at = sheet.corner[chosen][j];
        }
    if (kit_below(random, 2)) sheet.sides = OCC_SIDES_FRONT;
    return sheet;
}

// What the sheet is seen from: from anywhere, next to its plane, next to the line of an edge, or in
// its plane but for rounding.
static inline occ_frame any_view(kit_random *random, const occ_sheet *sheet, double size,
                                 sight_from *from)
{
    double normal[3], eye[3], along[3], length;
    uint32_t kind = kit_below(random, 5), n = sheet->corner_count, edge = kit_below(random, n);
    occ_sheet_normal(sheet, normal);
    length = sqrt(occ_dot(normal, normal)) + 1e-300;
    world_direction(random, along);
    double away = size * world_scale(random, 0.1, 1e3), off = size * world_scale(random, 1e-14, 1);
    for (int j = 0; j < 3; j++) {
        double at = (double)sheet->corner[edge][j];
        double step = (double)sheet->corner[(edge + 1) % n][j] - at;
        eye[j] = at + away * along[j];
        if (kind == 1) eye[j] -= away * along[j] * (1.0 - 1e-3) - off * normal[j] / length;
        if (kind == 2) eye[j] = at + 7.0 * step + off * along[j];
        if (kind == 3) eye[j] = at - 3.0 * step + along[0] * ((double)sheet->corner[0][j] - at);
    }
    *from = (sight_from){.direction = kit_below(random, 4) == 0};
    occ_frame frame = verdict_frame_at(eye);
    frame.camera.orthographic = from->direction;
    for (int j = 0; j < 3; j++) {
        if (from->direction) frame.camera.toward[j] = eye[j] - (double)sheet->corner[0][j];
        from->at[j] = from->direction ? frame.camera.toward[j] : eye[j];
    }
    return frame;
}

#endif
