// SPDX-License-Identifier: Apache-2.0
// What the test of objects reads, laid out alike on host and device, and the verdict on one object.
#ifndef OCC_VERDICT_H
#define OCC_VERDICT_H

#include "geometry.h"

#define OCC_SHADOW_PLANES  9
#define OCC_FRUSTUM_PLANES 6
#define OCC_NOBODY         0xffffffffu

// A device loads a plane at once if it knows how it lies.
#ifdef __OPENCL_C_VERSION__
#define OCC_ALIGNED __attribute__((aligned(16)))
#else
#define OCC_ALIGNED
#endif

// The shadow volume of an occluder, relative to the eye: a point is hidden if it is inside all
// planes. A plane is four floats, n and d, inside where n.x + d > 0.
typedef struct OCC_ALIGNED occ_shadow {
    float plane[OCC_SHADOW_PLANES][4]; // silhouette planes, then the visible faces
    occ_u32 planes;                    // how many of them: of a box 5, 8 or 9, of a sheet 4 to 9
    occ_u32 owner;                     // row of the object that it must not hide, or OCC_NOBODY
    occ_u32 silhouettes;               // how many planes come before those of faces
    occ_u32 pad;
} occ_shadow;

// The same with its planes side by side, for items that have vectors: coordinate j of plane p is
// plane[j][p], and the ninth is `last`. Everything is inside where there is no plane.
#define OCC_SIDES 8u

typedef struct OCC_ALIGNED occ_side_shadow {
    float plane[4][OCC_SIDES];
    float last[4];
    occ_u32 planes; // bit p: plane p exists
    occ_u32 faces;  // bit p: it is one of a face
    occ_u32 owner;
    occ_u32 sides; // how many planes there are beside `last`
} occ_side_shadow;

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

// What a view sends for a frame, in one piece: this, then shadows of either form, ranges and
// candidates, each at so many bytes from the beginning.
typedef struct occ_sent {
    occ_eye eye;
    occ_u32 shadows, ranges, candidates;
    occ_u32 pad;
} occ_sent;

#define OCC_SENT_AT(sent, type, at)                                                                \
    ((OCC_GLOBAL const type *)((OCC_GLOBAL const char *)(sent) + (at)))
#define OCC_SENT_SHADOWS(sent)    OCC_SENT_AT(sent, occ_shadow, (sent)->shadows)
#define OCC_SENT_RANGES(sent)     OCC_SENT_AT(sent, occ_range, (sent)->ranges)
#define OCC_SENT_CANDIDATES(sent) OCC_SENT_AT(sent, occ_u32, (sent)->candidates)

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

// A row of a table of boxes, relative to the eye.
OCC_FN void occ_row_relative(occ_relative_box *box, OCC_GLOBAL const float *boxes, occ_u32 stride,
                             occ_u32 row, OCC_GLOBAL const occ_eye *eye)
{
    for (occ_u32 j = 0; j < 3u; j++) {
        float coordinate = boxes[j * (size_t)stride + row];
        box->t[j] = OCC_RELATIVE(coordinate, eye->high[j], eye->low[j]);
    }
    for (occ_u32 k = 0; k < 9u; k++)
        box->a[k] = boxes[(3u + k) * (size_t)stride + row];
    box->e = occ_box_slack(box, eye->slack_floor);
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
