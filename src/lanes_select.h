// SPDX-License-Identifier: Apache-2.0
// Which occluders are worth looking at.
#ifndef OCC_LANES_SELECT_H
#define OCC_LANES_SELECT_H

#include "lanes_objects.h"

// As load_objects(), of boxes one after the other. Lanes beyond the last repeat it.
static inline void load_occluders(object_lanes *o, const occ_box *boxes, uint32_t count,
                                  const occ_eye *eye)
{
    float column[12][OCC_WIDTH];
    for (uint32_t l = 0; l < OCC_WIDTH; l++) {
        const occ_box *box = &boxes[l < count ? l : count - 1];
        for (uint32_t j = 0; j < 3; j++) {
            column[j][l] = box->center[j];
            for (uint32_t k = 0; k < 3; k++)
                column[3 + 3 * k + j][l] = box->axis[k][j];
        }
    }
    for (uint32_t j = 0; j < 3; j++)
        o->t[j] = OCC_RELATIVE(load_wide(column[j]), eye->high[j], eye->low[j]);
    for (uint32_t k = 0; k < 9; k++)
        o->a[k] = load_wide(column[3 + k]);
    set_bounds(o, eye);
}

// |a . (b x c)|
static inline fwide volume_of(const fwide *a, const fwide *b, const fwide c[3])
{
    fwide sum = (a[1] * b[2] - a[2] * b[1]) * c[0];
    sum += (a[2] * b[0] - a[0] * b[2]) * c[1];
    sum += (a[0] * b[1] - a[1] * b[0]) * c[2];
    return OCC_FABS(sum);
}

// Whether the area that a box shows suffices: squared, and relative to its distance, so that
// nothing overflows and little vanishes.
static inline uint32_t large_enough(const object_lanes *o, const occ_selection *choice)
{
    fwide scale = splat_wide(choice->scale), c[3], a[9], least;
    if (!choice->orthographic) scale = 1.0f / OCC_NORM1(o->t[0], o->t[1], o->t[2]);
    for (uint32_t j = 0; j < 3; j++)
        c[j] = choice->orthographic ? splat_wide(choice->toward[j]) : o->t[j] * scale;
    for (uint32_t k = 0; k < 9; k++)
        a[k] = o->a[k] * scale;
    fwide shown = volume_of(a, a + 3, c) + volume_of(a + 3, a + 6, c) + volume_of(a + 6, a, c);
    fwide squared = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    least = choice->least * choice->least * squared;
    if (!choice->orthographic) least *= squared * squared;
    return ~above_wide(least, 16.0f * shown * shown);
}

// How near the nearest point of a box's bounds is: as occ_frame_nearness().
static inline fwide nearness_of(const object_lanes *o, const occ_selection *choice)
{
    fwide sum = splat_wide(0.0f);
    for (uint32_t j = 0; j < 3; j++) {
        fwide h = OCC_NORM1(o->a[j], o->a[3 + j], o->a[6 + j]), gap = OCC_FABS(o->t[j]) - h;
        fwide past = 0.5f * (gap + OCC_FABS(gap)); // 0 where the eye is between
        float toward = choice->toward[j];
        sum += choice->orthographic ? -(toward * o->t[j] + fabsf(toward) * h) : past * past;
    }
    return sum;
}

// Those of `open` that no occluder so far hides alone.
static inline uint32_t not_hidden(const object_lanes *o, uint32_t open, const occ_shadow_set *set,
                                  const occ_screen *screen)
{
    center_lanes centers;
    centers_on_screen(&centers, o, screen, open);
    for (uint32_t i = 0; i < set->count && open; i += OCC_SHADOW_LANES) {
        rect_lanes rects = rects_of_block(&set->rects[i / OCC_SHADOW_LANES]);
        uint32_t near = present(near_box(&rects, &centers.bounds), set->count - i);
        for (; near; near &= near - 1u) {
            uint32_t s = (uint32_t)__builtin_ctz(near);
            uint32_t at = centers_near(&centers, &rects, s) & open;
            at = centers_inside(o, &set->shadows[i + s], at);
            if (at) open &= ~inside_shadow(o, &set->shadows[i + s], at);
        }
    }
    return open;
}

static uint32_t select_occluders(const occ_box *boxes, uint32_t count, const occ_selection *choice,
                                 uint32_t planes, const occ_shadow_set *set, float *key)
{
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < count; i += OCC_WIDTH) {
        object_lanes lanes;
        load_occluders(&lanes, boxes + i, count - i, choice->eye);
        fwide near = nearness_of(&lanes, choice);
        memcpy(key + i, &near, sizeof near);
        uint32_t outside = outside_frustum(&lanes, choice->eye, planes);
        uint32_t open = large_enough(&lanes, choice) & ~outside & ALL_WIDE;
        open = present(open, count - i);
        if (open && set->count) open = not_hidden(&lanes, open, set, choice->screen);
        chosen |= open << i;
    }
    return chosen;
}

#endif
