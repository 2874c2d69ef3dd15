// SPDX-License-Identifier: Apache-2.0
// The test of the open ranges where an item has vectors rather than neighbours: on a CPU. An item
// takes half of a range, eight objects at a time, and then what is unresolved of them one by one.
// The answers are test.cl's.
#include "sides.cl"

#define RANGE_HALF (OCC_RANGE_OBJECTS / 2u)

typedef struct range_lanes {
    float8 t[3];
    float8 a[9];
    float8 e;
} range_lanes;

inline void load_lanes(range_lanes *o, __global const float *boxes, uint stride, uint row,
                       __global const occ_eye *eye)
{
    for (uint j = 0; j < 3u; j++) {
        float8 center = vload8(0, boxes + j * (size_t)stride + row);
        o->t[j] = OCC_RELATIVE(center, eye->high[j], eye->low[j]);
    }
    for (uint k = 0; k < 9u; k++)
        o->a[k] = vload8(0, boxes + (3u + k) * (size_t)stride + row);
    float8 size = OCC_NORM1(o->t[0], o->t[1], o->t[2]);
    size += OCC_NORM1(o->a[0], o->a[1], o->a[2]);
    size += OCC_NORM1(o->a[3], o->a[4], o->a[5]);
    size += OCC_NORM1(o->a[6], o->a[7], o->a[8]);
    o->e = OCC_BOUND(size, eye->slack_floor);
}

// At a plane whose numbers are `step` apart.
inline float8 centers_at(const range_lanes *o, OCC_PLANES_OF n, uint step)
{
    return OCC_PLANE_AT(n[0], n[step], n[2u * step], n[3u * step], o->t[0], o->t[1], o->t[2]);
}

inline float8 lanes_reach(const range_lanes *o, OCC_PLANES_OF n, uint step)
{
    float x = n[0], y = n[step], z = n[2u * step];
    float8 r = OCC_REACH_OF_AXIS(x, y, z, o->a[0], o->a[1], o->a[2]);
    r += OCC_REACH_OF_AXIS(x, y, z, o->a[3], o->a[4], o->a[5]);
    r += OCC_REACH_OF_AXIS(x, y, z, o->a[6], o->a[7], o->a[8]);
    return r;
}

inline int8 lanes_outside(const range_lanes *o, __global const occ_eye *eye, uint planes)
{
    int8 outside = (int8)(0);
    for (uint p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (!(planes >> p & 1u)) continue;
        float8 s = centers_at(o, eye->plane[p], 1u), r = lanes_reach(o, eye->plane[p], 1u);
        outside |= OCC_IS_OUTSIDE(s, r, o->e);
    }
    return outside;
}

inline int8 lanes_in_frustum(const range_lanes *o, __global const occ_eye *eye, uint mask)
{
    int8 in = (int8)(-1);
    for (uint p = 0; p < OCC_SIDE_PLANES; p++)
        if (mask >> p & 1u) in &= centers_at(o, eye->plane[p], 1u) > 0.0f;
    return in;
}

// The least box along the coordinates around those boxes that are open.
inline void box_around(occ_relative_box *box, const range_lanes *o, int8 open,
                       __global const occ_eye *eye)
{
    for (uint j = 0; j < 3u; j++) {
        float8 h = (fabs(o->a[j]) + fabs(o->a[3u + j])) + fabs(o->a[6u + j]);
        float8 low = select((float8)(INFINITY), o->t[j] - h, open);
        float8 high = select((float8)(-INFINITY), o->t[j] + h, open);
        float4 low4 = fmin(low.lo, low.hi), high4 = fmax(high.lo, high.hi);
        float2 low2 = fmin(low4.lo, low4.hi), high2 = fmax(high4.lo, high4.hi);
        float least = fmin(low2.x, low2.y), most = fmax(high2.x, high2.y);
        box->t[j] = OCC_MIDDLE(least, most);
        box->a[3u * j] = box->a[3u * j + 1u] = box->a[3u * j + 2u] = 0.0f;
        box->a[4u * j] = OCC_HALF(least, most);
    }
    box->e = occ_box_slack(box, eye->slack_floor);
}

// Those of a range's candidates that are not apart from a box along the coordinates.
inline void list_candidates(side_list *to, __global const uint *list, uint count,
                            const occ_relative_box *box)
{
    const float *t = box->t, *a = box->a;
    uint near = 0, asked = count < SIDE_NEAR ? count : SIDE_NEAR;
    for (uint i = 0; i < asked; i++) {
        __global const occ_side_shadow *shadow = &to->shadows[list[i]];
        float8 x = vload8(0, shadow->plane[0]), y = vload8(0, shadow->plane[1]);
        float8 z = vload8(0, shadow->plane[2]), d = vload8(0, shadow->plane[3]);
        float8 s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]);
        float8 r = OCC_REACH_OF_AABB(x, y, z, a[0], a[4], a[8]);
        to->near[near] = list[i];
        near += !side_any(OCC_IS_OUTSIDE(s, r, box->e));
    }
    to->near_count = near;
    to->rest = list + asked;
    to->rest_count = count - asked;
}

// What a shadow alone says of the objects `near`, which are open: those whose center it holds are
// added to *held, and those that it holds as a whole are taken from *open.
inline void ask_shadow(const range_lanes *o, __global const occ_side_shadow *shadow, int8 near,
                       int8 *open, int8 *held)
{
    near = points_held(near, shadow, o->t[0], o->t[1], o->t[2], o->e);
    if (!side_any(near)) return;
    *held |= near;
    for (uint p = 0; p < shadow->sides && side_any(near); p++) {
        OCC_PLANES_OF n = &shadow->plane[0][p];
        float8 s = centers_at(o, n, OCC_SIDES), r = lanes_reach(o, n, OCC_SIDES);
        near &= OCC_IS_INSIDE(s, r, o->e);
    }
    if (shadow->planes >> OCC_SIDES) {
        float8 s = centers_at(o, shadow->last, 1u), r = lanes_reach(o, shadow->last, 1u);
        near &= OCC_IS_INSIDE(s, r, o->e);
    }
    *open &= ~near;
}

// Of the objects `ask`, those that several shadows hide together.
inline uint fuse_lanes(__global const float *boxes, uint stride, __global const occ_eye *eye,
                       uint mask, const side_list *list, uint row, uint ask)
{
    uint hidden = 0;
    for (; ask; ask &= ask - 1u) {
        uint l = lowest_of(ask);
        occ_relative_box box;
        occ_row_relative(&box, boxes, stride, row + l, eye);
        hidden |= (uint)sides_hide(&box, eye, mask, row + l, list) << l;
    }
    return hidden;
}

// Eight objects of a range, `left` of which are in it. Returns which are visible.
inline uint test_eight(__global const float *boxes, uint stride, __global const occ_sent *sent,
                       __global const occ_range *range, uint row, uint left, uint *outside)
{
    const int8 iota = (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    __global const occ_eye *eye = &sent->eye;
    range_lanes o;
    occ_relative_box around;
    side_list list;
    load_lanes(&o, boxes, stride, row, eye);
    int8 all = iota < (int)left, held = (int8)(0);
    int8 lost = lanes_outside(&o, eye, range->frustum) & all, open = all & ~lost;
    *outside = side_bits(lost);
    if (!range->candidate_count || !side_any(open)) return side_bits(open);
    list.shadows = OCC_SENT_AT(sent, occ_side_shadow, sent->shadows);
    box_around(&around, &o, open, eye);
    list_candidates(&list, OCC_SENT_CANDIDATES(sent) + range->candidates, range->candidate_count,
                    &around);
    uint count = list.near_count + list.rest_count;
    for (uint i = 0; i < count && side_any(open); i++) {
        __global const occ_side_shadow *shadow = listed(&list, i);
        ask_shadow(&o, shadow, open & (iota != (int)(shadow->owner - row)), &open, &held);
    }
    if (!range->fused) return side_bits(open);
    uint ask = side_bits(open & (held | ~lanes_in_frustum(&o, eye, range->frustum)));
    return side_bits(open) & ~fuse_lanes(boxes, stride, eye, range->frustum, &list, row, ask);
}

__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
occ_test_range(__global const float *boxes, uint stride, __global const occ_sent *sent,
               __global occ_verdict *verdicts)
{
    uint place = (uint)get_global_id(0) / 2u, word = (uint)get_global_id(0) % 2u;
    __global const occ_range *range = OCC_SENT_RANGES(sent) + place;
    uint visible = 0, outside = 0, begin = RANGE_HALF * word;
    for (uint i = 0; i < RANGE_HALF && begin + i < range->count; i += 8u) {
        uint lost, row = range->first + begin + i;
        visible |= test_eight(boxes, stride, sent, range, row, range->count - begin - i, &lost)
                   << i;
        outside |= lost << i;
    }
    verdicts[place].visible[word] = visible;
    verdicts[place].outside[word] = outside;
}
