// SPDX-License-Identifier: Apache-2.0
// Compiled several times, each time with OCC_LANES_NAME set to the name of an instruction set.
//
// Shadow volumes of boxes (Crow, Shadow Algorithms for Computer Graphics, SIGGRAPH 1977): the
// planes through the eye and the silhouette edges, and the planes of the faces that the eye sees.
//
// Why it is safe. Let V be any set of faces, at most one of each pair, that the eye is in front of
// for certain. The planes through those edges of V that only one face of V has, each turned towards
// that face, cut out the kernel of the polygon that V shows, and the kernel lies inside the polygon
// whether that is convex or not. A point in it and behind all planes of V is behind a point of some
// face of V. So a face that is doubtful may be left out, and V = the certain faces is sound even
// where it is not the full silhouette. Set-up is in double; what it rounds is moved inward.
//
// Four numbers at once: of the three pairs of faces and a fourth that means nothing, or of the four
// edges along one axis. Edge l is where the next axis has the sign of l & 1, and the one after that
// the sign of l & 2.
#include "shadow.h"

#include "quad.h"
#include "vector.h"

#include <occlude/scene.h>

#ifndef OCC_LANES_NAME
#define OCC_LANES_NAME plain
#endif
#define EPS 0x1p-53

static const quad sign_next = {-1.0, 1.0, -1.0, 1.0}, sign_after = {-1.0, -1.0, 1.0, 1.0};

// Of every pair of faces, what belongs to its neighbours: pair k + 1, pair k + 2.
static inline quad next_pair(quad x)
{
    return OCC_SHUFFLE(quad_truth, x, x, 1, 2, 0, 3);
}

static inline quad after_pair(quad x)
{
    return OCC_SHUFFLE(quad_truth, x, x, 2, 0, 1, 3);
}

// An occluder relative to the eye. Lane k speaks of axis k.
typedef struct solid {
    quad center[3]; // alike in all lanes
    quad axis[3];
    quad normal[3]; // of the faces: axis[k+1] x axis[k+2]; each component within EPS
    quad size[3];   // alike in all lanes: |center_j| + sum |axis_j|: bounds every corner's
                    // coordinate; and the doubt about the eye, which the center inherits
    quad sign;      // the face center + sign * axis[k] is seen for certain; 0: neither
    quad facing;    // an outward normal of it is facing * normal[k], facing = ±1
    quad middle[3]; // of it
} solid;

static inline void set_solid(solid *s, const occ_camera *camera, const occ_box *box)
{
    for (int j = 0; j < 3; j++) {
        double a = (double)box->axis[0][j], b = (double)box->axis[1][j];
        double c = (double)box->axis[2][j], center = (double)box->center[j] - camera->eye[j];
        s->axis[j] = make_quad(a, b, c, c); // not 0: valgrind 3.19 lacks gcc's way to that
        s->center[j] = splat_quad(center);
        s->size[j] = splat_quad(fabs(center) + camera->doubt[j] + fabs(a) + fabs(b) + fabs(c));
    }
    quad next[3], after[3];
    for (int j = 0; j < 3; j++) {
        next[j] = next_pair(s->axis[j]);
        after[j] = after_pair(s->axis[j]);
    }
    cross_quad(next, after, s->normal);
}

// Decides whether the eye sees a face of each pair, and which. With the eye at 0 and G = n.c, the
// box spans |n.x - G| <= D = |n.a_k|; the eye is in front of the nearer face if |G| > D. A box may
// be so flat that the sign of its volume is in doubt. Either will do for all three pairs: what V
// then shows of the box are the faces on its far side, which tile the same outline, and whose
// planes the eye is in front of as well.
static inline uint32_t see_faces(solid *s, const occ_camera *camera)
{
    quad depth = dot_quad(s->normal, s->axis), side, margin, error;
    if (camera->orthographic) {
        quad toward[3];
        for (int j = 0; j < 3; j++)
            toward[j] = splat_quad(camera->toward[j]);
        side = -dot_quad(s->normal, toward);
        margin = abs_quad(side);
        error = 8.0 * EPS * dot_magnitude_quad(s->normal, toward);
    } else {
        side = dot_quad(s->normal, s->center);
        margin = abs_quad(side) - abs_quad(depth);
        error = 16.0 * EPS * dot_magnitude_quad(s->normal, s->size);
    }
    quad_truth seen = above_quad(margin, error) & (quad_truth){-1, -1, -1, 0};
    // Towards the eye is against `side`. Which of the two faces lies there depends on the sign of
    // the volume n.a_k.
    quad zero = splat_quad(0.0);
    quad_truth ahead = above_quad(side, zero), turned = above_quad(zero, splat_quad(depth[0]));
    s->facing = where_quad(ahead, splat_quad(-2.0)) + 1.0;
    s->sign = where_quad(seen, where_quad(turned ^ ahead, splat_quad(-2.0)) + 1.0);
    for (int j = 0; j < 3; j++)
        s->middle[j] = s->center[j] + s->sign * s->axis[j];
    return bits_quad(seen);
}

// Up to four planes n.x + d > 0, where the components of n are off by at most `error` and d by at
// most `d_error`.
typedef struct plane_quad {
    quad n[3], error, d, d_error;
} plane_quad;

// Makes floats of planes. Returns the lanes in which n is long enough for its error: in the others
// its direction means nothing.
static inline uint32_t finish_planes(const plane_quad *p, float out[4][4])
{
    quad size = largest_quad(p->n);
    quad_truth good = above_quad(size, splat_quad(1e-200)) & above_quad(splat_quad(1e200), size) &
                      ~above_quad(p->error, size * 0x1p-26);
    quad scale = unit_scale_quad(size);
    quad_float column[4];
    for (int j = 0; j < 3; j++)
        column[j] = round_quad(p->n[j] * scale);
    quad inward = (p->d - p->d_error) * scale;
    column[3] = round_down_quad(inward - abs_quad(inward) * 0x1p-21);
    turn_quad(column, out);
    return bits_quad(good);
}

// The planes of the visible faces: behind them is inside.
static inline void set_face_planes(plane_quad *p, const solid *s)
{
    for (int j = 0; j < 3; j++)
        p->n[j] = -s->facing * s->normal[j];
    p->error = EPS * largest_quad(p->n);
    p->d = -dot_quad(p->n, s->middle);
    p->d_error = 16.0 * EPS * dot_magnitude_quad(p->n, s->size);
}

// What the planes through the edges have in common. Lane k speaks of the edges along axis k.
typedef struct rims {
    quad through[3]; // ray x axis[k], the ray leading to the box's center
    quad error;      // of the components of a plane
} rims;

static inline void set_rims(rims *r, const solid *s, const occ_camera *camera)
{
    quad ray[3], from[3], most = {0.0};
    for (int j = 0; j < 3; j++) {
        ray[j] = camera->orthographic ? splat_quad(-camera->toward[j]) : s->center[j];
        from[j] = camera->orthographic ? abs_quad(ray[j]) : s->size[j];
    }
    cross_quad(ray, s->axis, r->through);
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        most = larger_quad(most, from[p] * abs_quad(s->axis[q]) + from[q] * abs_quad(s->axis[p]));
    }
    r->error = 8.0 * EPS * most;
}

// The planes through the edges along axis k, the middle of a visible face inside. Returns the lanes
// whose edge only one face of V has.
static inline uint32_t set_rim_planes(plane_quad *p, const solid *s, const rims *r,
                                      const occ_camera *camera, int k)
{
    int next = (k + 1) % 3, after = (k + 2) % 3;
    quad sign[2] = {splat_quad(s->sign[next]), splat_quad(s->sign[after])};
    quad_truth in_next = above_quad(sign_next * sign[0], splat_quad(0.5)),
               in_after = above_quad(sign_after * sign[1], splat_quad(0.5));
    quad inward = where_quad(in_next, -sign_after * s->facing[next]) +
                  where_quad(in_after, sign_next * s->facing[after]);
    for (int j = 0; j < 3; j++) {
        quad n = splat_quad(r->through[j][k]);
        if (!camera->orthographic) {
            n -= sign_next * s->normal[j][after];
            n += sign_after * s->normal[j][next];
        }
        p->n[j] = inward * n;
    }
    p->error = splat_quad(r->error[k]);
    p->d = splat_quad(0.0);
    if (camera->orthographic) {
        quad point[3];
        for (int j = 0; j < 3; j++)
            point[j] = s->center[j] + sign_next * s->axis[j][next] + sign_after * s->axis[j][after];
        p->d = -dot_quad(p->n, point);
        p->d_error =
            16.0 * EPS * dot_magnitude_quad(p->n, s->size) + 3.0 * p->error * largest_quad(s->size);
    } else {
        quad doubt[3];
        for (int j = 0; j < 3; j++)
            doubt[j] = splat_quad(camera->doubt[j]);
        p->d_error = 8.0 * EPS * dot_magnitude_quad(p->n, doubt);
    }
    return bits_quad(in_next ^ in_after);
}

// Appends those of the planes that `lanes` names, of the first `count`. False if one of them means
// nothing.
static inline bool add_planes(occ_shadow *shadow, const plane_quad *p, uint32_t lanes,
                              uint32_t count)
{
    float plane[4][4];
    uint32_t good = finish_planes(p, plane);
    for (uint32_t l = 0; l < count; l++) {
        memcpy(shadow->plane[shadow->planes], plane[l], sizeof plane[l]);
        shadow->planes += lanes >> l & 1u;
    }
    return !(lanes & ~good);
}

// --- the tolerance -------------------------------------------------------------------------------

// A plane that turns about the eye.
typedef struct turning {
    uint32_t k, lane;
    uint32_t corners; // bit c: its edge ends at corner c of the box
    double unit[3], length, ray[3];
} turning;

static void set_turning(turning *t, const solid *s, const plane_quad *p, uint32_t k, uint32_t lane)
{
    uint32_t next = (k + 1) % 3, after = (k + 2) % 3;
    double n[3];
    for (int j = 0; j < 3; j++) {
        n[j] = p->n[j][lane];
        t->ray[j] = s->center[j][0] + sign_next[lane] * s->axis[j][next] +
                    sign_after[lane] * s->axis[j][after];
    }
    t->length = sqrt(occ_dot(n, n));
    for (int j = 0; j < 3; j++)
        t->unit[j] = n[j] / t->length;
    uint32_t end = (lane & 1u) << next | lane >> 1 << after;
    t->k = k;
    t->lane = lane;
    t->corners = 1u << end | 1u << (end | 1u << k);
}

// Turns the planes outward about the eye, by t = tolerance / 2 in the middle of their edges: to the
// unit normal n, t m is added, m being the direction of that middle. Whatever m rounds to, its
// length is 1: a point x is inside the new plane only if n.x > -t |x|, so that nothing rounds but
// n, as before. Where two planes meet at an angle a below 90 degrees their corner would move by t /
// sin(a / 2), without bound; there t is made less, so that no corner moves by more than that of a
// square. (With unit normals n and n', 1 + n.n' is 2 sin(a / 2)^2.)
static void turn_outward(plane_quad planes[3], const uint32_t lanes[3], const solid *s,
                         double tolerance)
{
    turning all[12];
    uint32_t count = 0;
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t l = 0; l < 4; l++)
            if (lanes[k] >> l & 1u) set_turning(&all[count++], s, &planes[k], k, l);
    for (uint32_t i = 0; i < count; i++) {
        turning *t = &all[i];
        plane_quad *p = &planes[t->k];
        double limit = 1.0;
        for (uint32_t o = 0; o < count; o++)
            if (o != i && t->corners & all[o].corners)
                limit = fmin(limit, sqrt(fmax(1.0 + occ_dot(t->unit, all[o].unit), 0.0)));
        double by = 0.5 * tolerance * (1.0 - 0x1p-20) * limit;
        double scale = by * t->length / sqrt(occ_dot(t->ray, t->ray));
        for (int j = 0; j < 3; j++)
            p->n[j][t->lane] += scale * t->ray[j];
        p->error[t->lane] += 4.0 * EPS * t->length;
    }
}

// --- the near plane ------------------------------------------------------------------------------

// Whether all that the near plane cuts away is in front of a visible face.
static bool cut_is_in_front(const solid *s, const occ_camera *camera, int k)
{
    for (int c = 0; c < 4; c++) {
        double height = 0.0, size = 0.0;
        for (int j = 0; j < 3; j++) {
            double offset = camera->near_corner[c][j] - s->middle[j][k];
            height += s->normal[j][k] * offset;
            size += fabs(s->normal[j][k]) * (fabs(camera->near_corner[c][j]) + s->size[j][k]);
        }
        if (!(s->facing[k] * height > size * 1e-9)) return false;
    }
    return true;
}

static bool is_beyond(const solid *s, const double *cutter)
{
    quad n[3] = {splat_quad(cutter[0]), splat_quad(cutter[1]), splat_quad(cutter[2])};
    quad reach = abs_quad(dot_quad(n, s->axis)), center = dot_quad(n, s->center);
    quad size = dot_magnitude_quad(n, s->size);
    return center[0] + cutter[3] - (reach[0] + reach[1] + reach[2]) >
           (size[0] + fabs(cutter[3])) * 1e-9;
}

// The near plane cuts away what lies between it and the eye. The occluder is whole if it lies
// beyond the near plane, which most do, or if all that is cut away is in front of one of its
// visible faces.
static bool survives_near(const solid *s, const occ_camera *camera, uint32_t seen)
{
    if (camera->cutter == OCC_NO_PLANE) return true;
    if (is_beyond(s, camera->plane[camera->cutter]) &&
        (!camera->far_cuts_too || is_beyond(s, camera->plane[OCC_NEAR_PLANE + 1]))) {
        return true;
    }
    for (int k = 0; k < 3 && camera->has_corners; k++)
        if ((seen >> k & 1u) && cut_is_in_front(s, camera, k)) return true;
    return false;
}

// --- all of it -----------------------------------------------------------------------------------

static inline bool add_silhouettes(occ_shadow *shadow, const solid *s, const occ_camera *camera)
{
    rims r;
    plane_quad planes[3];
    uint32_t lanes[3];
    set_rims(&r, s, camera);
    for (int k = 0; k < 3; k++)
        lanes[k] = set_rim_planes(&planes[k], s, &r, camera, k);
    if (camera->tolerance > 0.0 && !camera->orthographic)
        turn_outward(planes, lanes, s, camera->tolerance);
    bool good = true;
    for (int k = 0; k < 3; k++)
        good &= add_planes(shadow, &planes[k], lanes[k], 4);
    return good;
}

bool OCC_SHADE(OCC_LANES_NAME)(occ_shadow *shadow, const occ_camera *camera, const occ_box *box,
                               uint32_t owner)
{
    solid s;
    set_solid(&s, camera, box);
    uint32_t seen = see_faces(&s, camera);
    if (!seen || !survives_near(&s, camera, seen)) return false;
    shadow->planes = 0;
    shadow->owner = owner;
    shadow->pad = 0;
    if (!add_silhouettes(shadow, &s, camera)) return false;
    shadow->silhouettes = shadow->planes;
    plane_quad faces;
    set_face_planes(&faces, &s);
    return add_planes(shadow, &faces, seen, 3);
}
