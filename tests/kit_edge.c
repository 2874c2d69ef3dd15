// SPDX-License-Identifier: Apache-2.0
#include "kit_edge.h"

#include <math.h>
#include <string.h>

float edge_number(kit_random *random, float most)
{
    float x = kit_between(random, -1, 1);
    switch (kit_below(random, 12)) {
    case 0:
        return 0.0f;
    case 1:
        return x * 1e-30f;
    case 2:
        return x * 1e-40f;
    case 3:
        return most;
    case 4:
        return -most;
    case 5:
        return x * most * 1e-6f;
    default:
        return x * most;
    }
}

float edge_size(kit_random *random)
{
    static const float sizes[] = {1.0f, 1e15f, 1e-30f, 1e-38f, 1e3f, 1e7f};
    return sizes[kit_below(random, sizeof sizes / sizeof *sizes)];
}

occ_relative_box edge_box(kit_random *random, float size, float slack_floor)
{
    occ_relative_box box;
    for (int j = 0; j < 3; j++)
        box.t[j] = edge_number(random, size);
    float axes = kit_below(random, 3) ? 0.1f * size : size;
    for (int k = 0; k < 9; k++)
        box.a[k] = edge_number(random, axes);
    if (kit_below(random, 4) == 0) memset(box.a + 3 * kit_below(random, 3), 0, 3 * sizeof(float));
    box.e = occ_box_slack(&box, slack_floor);
    return box;
}

static void make_normal(kit_random *random, float plane[4])
{
    for (int j = 0; j < 3; j++)
        plane[j] = kit_below(random, 4) ? kit_between(random, -1, 1) : 0.0f;
    if (kit_below(random, 8) == 0) plane[kit_below(random, 3)] = 1.0f;
    if (kit_below(random, 16) == 0) plane[kit_below(random, 3)] = 1e-41f;
}

static float nudged(float x, int steps)
{
    for (; steps > 0; steps--)
        x = nextafterf(x, INFINITY);
    for (; steps < 0; steps++)
        x = nextafterf(x, -INFINITY);
    return x;
}

void edge_plane(kit_random *random, const occ_relative_box *box, float size, float plane[4])
{
    make_normal(random, plane);
    float s = OCC_PLANE_AT(plane[0], plane[1], plane[2], 0.0f, box->t[0], box->t[1], box->t[2]);
    float r = occ_box_reach(box, plane[0], plane[1], plane[2]);
    int steps = (int)kit_below(random, 7) - 3;
    switch (kit_below(random, 8)) {
    case 0:
        plane[3] = edge_number(random, size);
        break;
    case 1:
        plane[3] = nudged(-(r + box->e) - s, steps);
        break;
    case 2:
    case 3:
        plane[3] = nudged(r + box->e - s, steps);
        break;
    default:
        plane[3] = 2.0f * (r + box->e) - s + fabsf(edge_number(random, size));
    }
}

occ_eye edge_eye(kit_random *random, float size)
{
    occ_eye eye = {.slack_floor = 0x1p-80f};
    for (int j = 0; j < 3; j++) {
        eye.high[j] = kit_below(random, 3) ? edge_number(random, size) : 0.0f;
        eye.low[j] = eye.high[j] * kit_between(random, -0x1p-25f, 0x1p-25f);
        eye.slack_floor += 0x1p-46f * fabsf(eye.high[j]);
    }
    return eye;
}

void edge_shadow(kit_random *random, const occ_relative_box *box, float size, uint32_t rows,
                 occ_shadow *shadow)
{
    static const uint32_t plane_counts[] = {1, 2, 4, 5, 7, 8, 9};
    *shadow = (occ_shadow){.planes = plane_counts[kit_below(random, 7)], .owner = OCC_NOBODY};
    shadow->silhouettes = shadow->planes - 1; // a sheet's, or a box's
    if (shadow->planes > 7 && kit_below(random, 2)) shadow->silhouettes = 6;
    if (kit_below(random, 2)) shadow->owner = kit_below(random, rows);
    for (uint32_t p = 0; p < shadow->planes; p++)
        edge_plane(random, box, size, shadow->plane[p]);
}
