// SPDX-License-Identifier: Apache-2.0
// What the eye sees of a box, as pieces: its outline, a convex polygon of four or six corners, or
// its faces one by one.
#ifndef OCC_OUTLINE_H
#define OCC_OUTLINE_H

#include "piece.h"

#define OCC_SIDE_NONE  0 // the eye is between the two faces, or there are none
#define OCC_SIDE_MINUS 1 // it sees the face at -axis
#define OCC_SIDE_PLUS  2
#define OCC_SIDE_DOUBT 3

// A corner's coordinate: the center's, and those of three axes with their signs.
#define OCC_CORNER(t, a, b, c) ((((t) + (a)) + (b)) + (c))

// Which face of pair k the eye sees. With the eye at 0, n = a x b and the box from n.t - |n.c| to
// n.t + |n.c| along n, it is in front of the nearer face if |n.t| > |n.c|.
OCC_FN int occ_side_seen(const occ_relative_box *box, occ_u32 k, OCC_GLOBAL const occ_eye *eye)
{
    const float *a = box->a + 3 * ((k + 1) % 3), *b = box->a + 3 * ((k + 2) % 3);
    const float *c = box->a + 3 * k, *t = box->t;
    float area = OCC_NORM1(a[0], a[1], a[2]) * OCC_NORM1(b[0], b[1], b[2]);
    float depth = OCC_NORM1(c[0], c[1], c[2]);
    if (OCC_NORM1(a[0], a[1], a[2]) == 0.0f || OCC_NORM1(b[0], b[1], b[2]) == 0.0f) {
        return OCC_SIDE_NONE;
    }
    if (area < 0x1p-100f || !(area * box->e < 0x1p100f)) return OCC_SIDE_DOUBT;
    float nx = a[1] * b[2] - a[2] * b[1], ny = a[2] * b[0] - a[0] * b[2];
    float nz = a[0] * b[1] - a[1] * b[0];
    float volume = nx * c[0] + ny * c[1] + nz * c[2], extent = OCC_FABS(volume);
    if (depth > 0.0f && extent <= area * depth * 0x1p-19f) return OCC_SIDE_DOUBT;
    float at = nx * t[0] + ny * t[1] + nz * t[2], error = area * (8.0f * box->e + eye->doubt);
    if (eye->toward[3] != 0.0f) { // orthographic: the eye is far off
        at = -(nx * eye->toward[0] + ny * eye->toward[1] + nz * eye->toward[2]);
        extent = 0.0f;
        error = area * 0x1p-19f;
    }
    if (OCC_FABS(at) - extent > error) {
        return (at < 0.0f) == (volume >= 0.0f) ? OCC_SIDE_PLUS : OCC_SIDE_MINUS;
    }
    return extent - OCC_FABS(at) > error ? OCC_SIDE_NONE : OCC_SIDE_DOUBT;
}

// Polygons whose corners are corners of the box. Bit k of a corner: it is at -axis[k] rather than
// at +axis[k].
typedef struct occ_outline {
    occ_u32 polygons;
    occ_u32 corners; // of each
    occ_u32 corner[6][6];
} occ_outline;

// Face `minus` (0 or 1) of pair k.
OCC_FN void occ_outline_add_face(occ_outline *outline, occ_u32 k, occ_u32 minus)
{
    occ_u32 a = 1u << (k + 1) % 3, b = 1u << (k + 2) % 3, at = minus << k;
    occ_u32 *corner = outline->corner[outline->polygons++];
    corner[0] = at;
    corner[1] = at | a;
    corner[2] = at | a | b;
    corner[3] = at | b;
}

// Where two or three faces are seen, their outline has six corners: with three, all but the nearest
// and the farthest; with two, all of both, and the third axis runs along the edge between them.
OCC_FN void occ_outline_set_hexagon(occ_outline *outline, const int *side)
{
    occ_u32 at = 0;
    for (occ_u32 k = 0; k < 3; k++)
        at |= (occ_u32)(side[k] == OCC_SIDE_MINUS) << k;
    int two = side[0] == OCC_SIDE_NONE || side[1] == OCC_SIDE_NONE || side[2] == OCC_SIDE_NONE;
    occ_u32 k = side[0] == OCC_SIDE_NONE ? 0u : side[1] == OCC_SIDE_NONE ? 1u : 2u;
    occ_u32 a = 1u << (k + 1) % 3, b = 1u << (k + 2) % 3, c = 1u << k;
    occ_u32 *corner = outline->corner[0];
    corner[0] = at ^ a;
    corner[1] = two ? at : at ^ (a | b);
    corner[2] = at ^ b;
    corner[3] = at ^ (b | c);
    corner[4] = at ^ c;
    corner[5] = at ^ (a | c);
    outline->polygons = 1;
    outline->corners = 6;
}

// Whether the eye is outside of the box for certain, by the box's axis-aligned bounds alone.
OCC_FN int occ_outline_is_apart(const occ_relative_box *box, OCC_GLOBAL const occ_eye *eye)
{
    const float *t = box->t, *a = box->a;
    float least = 2.0f * box->e + eye->doubt;
    return eye->toward[3] != 0.0f || OCC_FABS(t[0]) - OCC_NORM1(a[0], a[3], a[6]) > least ||
           OCC_FABS(t[1]) - OCC_NORM1(a[1], a[4], a[7]) > least ||
           OCC_FABS(t[2]) - OCC_NORM1(a[2], a[5], a[8]) > least;
}

// The outline, or the faces: every face that may be seen, where it is in doubt which are. 0: it
// cannot be told, for the eye may be inside.
OCC_FN int occ_outline_set(occ_outline *outline, const occ_relative_box *box,
                           OCC_GLOBAL const occ_eye *eye, int by_faces)
{
    int side[3];
    occ_u32 seen = 0, doubts = 0;
    for (occ_u32 k = 0; k < 3; k++) {
        side[k] = occ_side_seen(box, k, eye);
        seen += side[k] == OCC_SIDE_PLUS || side[k] == OCC_SIDE_MINUS;
        doubts += side[k] == OCC_SIDE_DOUBT;
    }
    if (!seen && !occ_outline_is_apart(box, eye)) return 0;
    if (!doubts && seen > 1 && !by_faces) {
        occ_outline_set_hexagon(outline, side);
        return 1;
    }
    outline->polygons = 0;
    outline->corners = 4;
    for (occ_u32 k = 0; k < 3; k++) {
        if (side[k] == OCC_SIDE_NONE) continue;
        if (side[k] != OCC_SIDE_MINUS) occ_outline_add_face(outline, k, 0);
        if (side[k] != OCC_SIDE_PLUS) occ_outline_add_face(outline, k, 1);
    }
    return outline->polygons > 0;
}

// The corner that has the signs `corner`.
OCC_FN void occ_box_corner(const occ_relative_box *box, occ_u32 corner, float *x, float *y,
                           float *z)
{
    const float *t = box->t, *a = box->a;
    float s0 = corner & 1u ? -1.0f : 1.0f, s1 = corner & 2u ? -1.0f : 1.0f;
    float s2 = corner & 4u ? -1.0f : 1.0f;
    *x = OCC_CORNER(t[0], s0 * a[0], s1 * a[3], s2 * a[6]);
    *y = OCC_CORNER(t[1], s0 * a[1], s1 * a[4], s2 * a[7]);
    *z = OCC_CORNER(t[2], s0 * a[2], s1 * a[5], s2 * a[8]);
}

// That corner as a vertex, the largest of whose x, y, z is in [1/2, 1). 0 if that cannot be.
OCC_FN int occ_outline_vertex(const occ_relative_box *box, occ_u32 corner, occ_vertex *v)
{
    occ_box_corner(box, corner, &v->x, &v->y, &v->z);
    float most = OCC_FABS(v->x);
    if (OCC_FABS(v->y) > most) most = OCC_FABS(v->y);
    if (OCC_FABS(v->z) > most) most = OCC_FABS(v->z);
    occ_u32 exponent = OCC_BITS_OF(most) >> 23;
    if (exponent < 24u || exponent > 230u) return 0;
    v->w = OCC_FLOAT_OF((253u - exponent) << 23);
    v->x *= v->w;
    v->y *= v->w;
    v->z *= v->w;
    return 1;
}

// The polygons as pieces. Their number, or 0 if floats cannot say where a corner is.
OCC_FN occ_u32 occ_outline_pieces(const occ_outline *outline, const occ_relative_box *box,
                                  occ_piece *pieces)
{
    for (occ_u32 i = 0; i < outline->polygons; i++) {
        occ_piece *piece = &pieces[i];
        piece->count = outline->corners;
        piece->cuts = 0;
        for (occ_u32 k = 0; k < outline->corners; k++)
            if (!occ_outline_vertex(box, outline->corner[i][k], &piece->v[k])) return 0;
    }
    return outline->polygons;
}

#endif
