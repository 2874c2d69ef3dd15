// SPDX-License-Identifier: Apache-2.0
// The arithmetic of every verdict, once, for the host (C17) and the device (OpenCL C 1.2).
//
// Only + - * and comparisons of floats, in the order written: with contraction off, every compiler
// and device gives the same bits. Each test is the sign of a number that carries an error bound, so
// that "inside" and "outside" are proofs and what lies between is neither.
//
// Error bound. Let u = 2^-24. A box relative to the eye has a center t and axes a_k; E is the eye.
//   t = (c - hi) - lo has error <= 2u|t| + 2u^2|E|    (two roundings, and E - hi - lo)
//   bounds of nodes: center and half size from (max ± min) / 2, again <= 2u(|t| + h)
//   a plane's normal, scaled so that its components are at most 1, was rounded: <= u per component,
//     and its set-up in double is held to <= u/2 (shadow.c, camera.c)
//   s = n.t + d: four roundings of partial sums, r = sum |n.a_k|: five, s -+ r and its bound: two
// In all less than 12 u (|t|_1 + sum |a_k|_1) + 2u^2 |E|_1; the plane's own offset d was moved by
// 8u|d| when it was made. OCC_SLACK is 16 u, so e = OCC_SLACK * (|t|_1 + sum |a_k|_1) + floor, with
// floor >= 4u^2 |E|_1 + 2^-80 (which also swallows underflow), bounds all of it.
//
// These are macros because the same text serves floats, OpenCL and vectors of many boxes (lanes.c).
#ifndef OCC_GEOMETRY_H
#define OCC_GEOMETRY_H

#ifdef __OPENCL_C_VERSION__
#pragma OPENCL FP_CONTRACT OFF
#define OCC_FN      inline
#define OCC_GLOBAL  __global
#define OCC_FABS(x) fabs(x)
typedef uint occ_u32;
#else
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#define OCC_FN static inline
#define OCC_GLOBAL
#ifndef OCC_FABS
#define OCC_FABS(x) fabsf(x)
#endif
typedef uint32_t occ_u32;
#endif

#define OCC_SLACK 0x1p-20f

// A coordinate relative to the eye, which is given as a pair of floats.
#define OCC_RELATIVE(coordinate, eye_high, eye_low) (((coordinate) - (eye_high)) - (eye_low))

// Center and half size of an interval.
#define OCC_MIDDLE(min, max) (0.5f * (min) + 0.5f * (max))
#define OCC_HALF(min, max)   (0.5f * (max)-0.5f * (min))

// |x| + |y| + |z|
#define OCC_NORM1(x, y, z) (OCC_FABS(x) + OCC_FABS(y) + OCC_FABS(z))

// The error bound e of a box whose |t|_1 + sum |a_k|_1 is `size`.
#define OCC_BOUND(size, slack_floor) ((size)*OCC_SLACK + (slack_floor))

// s: a plane (n, d) at a center.
#define OCC_PLANE_AT(nx, ny, nz, d, x, y, z) ((nx) * (x) + (ny) * (y) + (nz) * (z) + (d))

// |n.a|: how far a half axis reaches from the center along a normal. r is the sum over three axes.
#define OCC_REACH_OF_AXIS(nx, ny, nz, x, y, z) OCC_FABS((nx) * (x) + (ny) * (y) + (nz) * (z))

// r of an axis-aligned box with half sizes (x, y, z), none of them negative.
#define OCC_REACH_OF_AABB(nx, ny, nz, x, y, z)                                                     \
    (OCC_FABS(nx) * (x) + OCC_FABS(ny) * (y) + OCC_FABS(nz) * (z))

// All corners are on the positive side of a plane, for certain.
#define OCC_IS_INSIDE(s, r, e) ((s) - (r) > (e))

// All corners are on the negative side of a plane, for certain.
#define OCC_IS_OUTSIDE(s, r, e) ((s) + (r) < -(e))

#endif
