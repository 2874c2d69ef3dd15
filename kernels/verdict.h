// SPDX-License-Identifier: Apache-2.0
// What the test of objects reads, laid out alike on host and device, and the verdict on one object.
#ifndef OCC_VERDICT_H
#define OCC_VERDICT_H

#include "geometry.h"

#define OCC_SHADOW_PLANES  9
#define OCC_FRUSTUM_PLANES 6
#define OCC_NOBODY         0xffffffffu

// The shadow volume of an occluder, relative to the eye: a point is hidden if it is inside all
// planes. A plane is four floats, n and d, inside where n.x + d > 0.
typedef struct occ_shadow {
    float plane[OCC_SHADOW_PLANES][4]; // silhouette planes, then the visible faces
    occ_u32 planes;                    // how many of them: of a box 5, 8 or 9, of a sheet 4 to 9
    occ_u32 owner;                     // row of the object that it must not hide, or OCC_NOBODY
    occ_u32 silhouettes;               // how many planes come before those of faces
    occ_u32 pad;
} occ_shadow;

// The camera, as the test needs it.
typedef struct occ_eye {
    float high[4]; // the eye is high + low
    float low[4];
    float plane[OCC_FRUSTUM_PLANES][4]; // the frustum's, relative to the eye
    float toward[4];                    // orthographic: a direction to the viewer, and 1; else 0
    float slack_floor;
    float doubt;    // four times what the eye may be off by
    occ_u32 splits; // how many subtractions fusion may spend on an object
    occ_u32 pad;
} occ_eye;

// A run of at most 64 objects that the walk left open.
typedef struct occ_range {
    occ_u32 first; // row
    occ_u32 count;
    occ_u32 candidates; // where its list of shadows begins
    occ_u32 candidate_count;
    occ_u32 frustum; // bit p: plane p of the frustum may cut the range
    occ_u32 fused;   // whether candidates may hide an object together
} occ_range;

#define OCC_RANGE_OBJECTS 64u

// The answers for a range: bit i % 32 of word i / 32 speaks of row first + i. Neither: hidden.
typedef struct occ_verdict {
    occ_u32 visible[2];
    occ_u32 outside[2];
} occ_verdict;

// What is known of an object.
#define OCC_VISIBLE 0u
#define OCC_OUTSIDE 1u
#define OCC_HIDDEN  2u

// A box relative to the eye.
typedef struct occ_relative_box {
    float t[3];
    float a[9];
    float e; // its error bound
} occ_relative_box;

OCC_FN float occ_box_slack(const occ_relative_box *box, float slack_floor)
{
    float size = OCC_NORM1(box->t[0], box->t[1], box->t[2]);
    size += OCC_NORM1(box->a[0], box->a[1], box->a[2]);
    size += OCC_NORM1(box->a[3], box->a[4], box->a[5]);
    size += OCC_NORM1(box->a[6], box->a[7], box->a[8]);
    return OCC_BOUND(size, slack_floor);
}

OCC_FN float occ_box_reach(const occ_relative_box *box, float nx, float ny, float nz)
{
    float r = OCC_REACH_OF_AXIS(nx, ny, nz, box->a[0], box->a[1], box->a[2]);
    r += OCC_REACH_OF_AXIS(nx, ny, nz, box->a[3], box->a[4], box->a[5]);
    r += OCC_REACH_OF_AXIS(nx, ny, nz, box->a[6], box->a[7], box->a[8]);
    return r;
}

#ifdef __OPENCL_C_VERSION__
#define OCC_PLANES_OF __global const float *
#else
#define OCC_PLANES_OF const float *
#endif

// The box is hidden: each of its corner rays meets a visible face of the occluder before the
// corner, which is to say that each corner is inside every plane of the shadow.
OCC_FN int occ_box_in_shadow(const occ_relative_box *box, OCC_PLANES_OF plane, occ_u32 planes)
{
    for (occ_u32 p = 0; p < planes; p++, plane += 4) {
        float s =
            OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], box->t[0], box->t[1], box->t[2]);
        float r = occ_box_reach(box, plane[0], plane[1], plane[2]);
        if (!OCC_IS_INSIDE(s, r, box->e)) return 0;
    }
    return 1;
}

// The box is outside one of the frustum's planes that `mask` names.
OCC_FN int occ_box_outside(const occ_relative_box *box, OCC_PLANES_OF plane, occ_u32 mask)
{
    for (; mask; mask >>= 1, plane += 4) {
        if (!(mask & 1u)) continue;
        float s =
            OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], box->t[0], box->t[1], box->t[2]);
        float r = occ_box_reach(box, plane[0], plane[1], plane[2]);
        if (OCC_IS_OUTSIDE(s, r, box->e)) return 1;
    }
    return 0;
}

#endif
