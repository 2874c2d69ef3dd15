// SPDX-License-Identifier: Apache-2.0
// Shadow volumes of boxes (Crow, Shadow Algorithms for Computer Graphics, SIGGRAPH 1977): the
// planes through the eye and the silhouette edges, and the planes of the faces that the eye sees.
//
// Why it is safe. Let V be any set of faces, at most one of each pair, that the eye is in front of
// for certain. The planes through those edges of V that only one face of V has, each turned towards
// that face, cut out the kernel of the polygon that V shows, and the kernel lies inside the polygon
// whether that is convex or not. A point in it and behind all planes of V is behind a point of some
// face of V. So a face that is doubtful may be left out, and V = the certain faces is sound even
// where it is not the full silhouette. Set-up is in double; what it rounds is moved inward.
#include "shadow.h"

#include "rounding.h"
#include "vector.h"

#define EPS 0x1p-53

// An occluder relative to the eye.
typedef struct solid {
    double center[3];
    double axis[3][3];
    double normal[3]
                 [3]; // of the faces: normal[k] = axis[k+1] x axis[k+2]; each component within EPS
    double size[3];   // |center_j| + sum |axis_j|: bounds every corner's coordinate; and the doubt
                      // about the eye, which the center inherits
} solid;

// A face that the eye sees for certain: center + sign * axis[k].
typedef struct face {
    int sign;         // 0: not seen
    double center[3]; // its middle
    double facing;    // an outward normal is facing * normal[k], facing = ±1
} face;

static void set_solid(solid *s, const occ_camera *camera, const occ_box *box)
{
    for (int j = 0; j < 3; j++) {
        s->center[j] = (double)box->center[j] - camera->eye[j];
        s->size[j] = fabs(s->center[j]) + camera->doubt[j];
        for (int k = 0; k < 3; k++) {
            s->axis[k][j] = (double)box->axis[k][j];
            s->size[j] += fabs(s->axis[k][j]);
        }
    }
    for (int k = 0; k < 3; k++)
        occ_cross(s->axis[(k + 1) % 3], s->axis[(k + 2) % 3], s->normal[k]);
}

// Decides whether the eye sees a face of pair k, and which. With the eye at 0 and G = n.c, the box
// spans |n.x - G| <= D = |n.a_k|; the eye is in front of the nearer face if |G| > D.
static void see_face(const solid *s, const occ_camera *camera, int k, double volume, face *f)
{
    const double *n = s->normal[k];
    double side, margin, error;
    if (camera->orthographic) {
        side = -occ_dot(n, camera->toward);
        margin = fabs(side);
        error = 8.0 * EPS * occ_dot_magnitude(n, camera->toward);
    } else {
        side = occ_dot(n, s->center);
        margin = fabs(side) - fabs(occ_dot(n, s->axis[k]));
        error = 16.0 * EPS * occ_dot_magnitude(n, s->size);
    }
    f->sign = 0;
    if (!(margin > error)) return;
    // Towards the eye is against `side`. Which of the two faces lies there depends on the sign of
    // the volume n.a_k.
    f->facing = side > 0.0 ? -1.0 : 1.0;
    f->sign = (volume < 0.0) != (side > 0.0) ? -1 : 1;
    for (int j = 0; j < 3; j++)
        f->center[j] = s->center[j] + (double)f->sign * s->axis[k][j];
}

// Fills in the faces of V and returns how many there are. A box may be so flat that the sign of its
// volume is in doubt. Either will do for all three pairs: what V then shows of the box are the
// faces on its far side, which tile the same outline, and whose planes the eye is in front of as
// well.
static int see_faces(const solid *s, const occ_camera *camera, face seen[3])
{
    double volume = occ_dot(s->normal[0], s->axis[0]);
    int count = 0;
    for (int k = 0; k < 3; k++) {
        see_face(s, camera, k, volume, &seen[k]);
        count += seen[k].sign != 0;
    }
    return count;
}

bool occ_shadow_add_plane(occ_shadow *shadow, const double n[3], double normal_error, double d,
                          double d_error)
{
    double size = occ_largest(n);
    if (!(size > 0.0) || !(size < 1e200) || normal_error > size * 0x1p-26) return false;
    double scale = occ_unit_scale(size);
    float *plane = shadow->plane[shadow->planes++];
    for (int j = 0; j < 3; j++)
        plane[j] = (float)(n[j] * scale);
    double inward = (d - d_error) * scale;
    plane[3] = occ_round_down(inward - fabs(inward) * 0x1p-21);
    return true;
}

// The plane of a visible face: behind it is inside.
static bool add_face(occ_shadow *shadow, const solid *s, const face *f, int k)
{
    double inward[3];
    for (int j = 0; j < 3; j++)
        inward[j] = -f->facing * s->normal[k][j];
    double d = -occ_dot(inward, f->center);
    double error = 16.0 * EPS * occ_dot_magnitude(inward, s->size);
    return occ_shadow_add_plane(shadow, inward, EPS * occ_largest(inward), d, error);
}

// An edge of face k: where the face ends on the `side` of axis[across]; it runs along axis[along].
typedef struct edge {
    int k, side, across, along;
} edge;

double occ_cross_error(const double from[3], const double axis[3])
{
    double most = 0.0;
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        most = occ_larger(most, from[p] * fabs(axis[q]) + from[q] * fabs(axis[p]));
    }
    return 8.0 * EPS * most;
}

// A silhouette edge's plane through the eye: n.x = 0, the face's middle inside.
typedef struct rim {
    double n[3], error; // of its components
    double point[3];    // the edge's middle
    double ray[3];      // towards it
    uint32_t corners;   // bit c: the edge ends at corner c of the box
} rim;

static void set_rim(rim *r, const solid *s, const occ_camera *camera, const face *f, const edge *e)
{
    double bound[3];
    for (int j = 0; j < 3; j++) {
        r->point[j] = f->center[j] + (double)e->side * s->axis[e->across][j];
        r->ray[j] = camera->orthographic ? -camera->toward[j] : r->point[j];
        bound[j] = camera->orthographic ? fabs(r->ray[j]) : s->size[j];
    }
    occ_cross(r->ray, s->axis[e->along], r->n);
    r->error = occ_cross_error(bound, s->axis[e->along]);
    // With a and b for the two axes and m for the face's middle, (m + side a) x b . m is
    // side (a x b) . m; a x b is ±normal[k], and see_face() knows the sign of normal[k] . m.
    bool cyclic = e->across == (e->k + 1) % 3;
    bool inward = (f->facing < 0.0) == (e->side > 0) ? cyclic : !cyclic;
    for (int j = 0; j < 3; j++)
        r->n[j] = inward ? r->n[j] : -r->n[j];
    uint32_t end = (f->sign > 0 ? 1u << e->k : 0u) | (e->side > 0 ? 1u << e->across : 0u);
    r->corners = 1u << end | 1u << (end | 1u << e->along);
}

// All silhouette edges of V: those whose other face is not in V. Returns how many.
static int set_rims(rim rims[OCC_SHADOW_PLANES], const solid *s, const occ_camera *camera,
                    const face seen[3])
{
    int count = 0;
    for (int k = 0; k < 3; k++) {
        if (!seen[k].sign) continue;
        for (int i = 0; i < 4; i++) {
            int turn = 1 + i / 2, side = i % 2 ? -1 : 1;
            edge e = {k, side, (k + turn) % 3, (k + 3 - turn) % 3};
            if (seen[e.across].sign == side) continue;
            set_rim(&rims[count++], s, camera, &seen[k], &e);
        }
    }
    return count;
}

// Turns the planes outward about the eye, by t = tolerance / 2 in the middle of their edges: to the
// unit normal n, t m is added, m being the direction of that middle. Whatever m rounds to, its
// length is 1: a point x is inside the new plane only if n.x > -t |x|, so that nothing rounds but
// n, as before. Where two planes meet at an angle a below 90 degrees their corner would move by t /
// sin(a / 2), without bound; there t is made less, so that no corner moves by more than that of a
// square. (With unit normals n and n', 1 + n.n' is 2 sin(a / 2)^2.)
static void turn_outward(rim rims[OCC_SHADOW_PLANES], int count, double tolerance)
{
    double unit[OCC_SHADOW_PLANES][3], length[OCC_SHADOW_PLANES];
    for (int i = 0; i < count; i++) {
        length[i] = sqrt(occ_dot(rims[i].n, rims[i].n));
        for (int j = 0; j < 3; j++)
            unit[i][j] = rims[i].n[j] / length[i];
    }
    for (int i = 0; i < count; i++) {
        double limit = 1.0;
        for (int k = 0; k < count; k++)
            if (k != i && rims[i].corners & rims[k].corners)
                limit = fmin(limit, sqrt(fmax(1.0 + occ_dot(unit[i], unit[k]), 0.0)));
        double by = 0.5 * tolerance * (1.0 - 0x1p-20) * limit;
        double scale = by * length[i] / sqrt(occ_dot(rims[i].ray, rims[i].ray));
        for (int j = 0; j < 3; j++)
            rims[i].n[j] += scale * rims[i].ray[j];
        rims[i].error += 4.0 * EPS * length[i];
    }
}

static bool add_rim(occ_shadow *shadow, const solid *s, const occ_camera *camera, const rim *r)
{
    const double *n = r->n;
    double d = 0.0, d_error = 0.0;
    if (camera->orthographic) {
        d = -occ_dot(n, r->point);
        d_error =
            16.0 * EPS * occ_dot_magnitude(n, s->size) + 3.0 * r->error * occ_largest(s->size);
    } else {
        d_error = 8.0 * EPS * occ_dot_magnitude(n, camera->doubt);
    }
    return occ_shadow_add_plane(shadow, n, r->error, d, d_error);
}

static bool add_silhouettes(occ_shadow *shadow, const solid *s, const occ_camera *camera,
                            const face seen[3])
{
    rim rims[OCC_SHADOW_PLANES];
    int count = set_rims(rims, s, camera, seen);
    if (camera->tolerance > 0.0 && !camera->orthographic)
        turn_outward(rims, count, camera->tolerance);
    for (int i = 0; i < count; i++)
        if (!add_rim(shadow, s, camera, &rims[i])) return false;
    return true;
}

// Whether all that the near plane cuts away is in front of a visible face.
static bool cut_is_in_front(const solid *s, const occ_camera *camera, const face *f, int k)
{
    for (int c = 0; c < 4; c++) {
        double offset[3], size[3];
        for (int j = 0; j < 3; j++) {
            offset[j] = camera->near_corner[c][j] - f->center[j];
            size[j] = fabs(camera->near_corner[c][j]) + s->size[j];
        }
        double height = f->facing * occ_dot(s->normal[k], offset);
        if (!(height > occ_dot_magnitude(s->normal[k], size) * 1e-9)) return false;
    }
    return true;
}

static bool is_beyond(const solid *s, const double *cutter)
{
    double reach = 0.0;
    for (int k = 0; k < 3; k++)
        reach += fabs(occ_dot(cutter, s->axis[k]));
    double size = occ_dot_magnitude(cutter, s->size) + fabs(cutter[3]);
    return occ_dot(cutter, s->center) + cutter[3] - reach > size * 1e-9;
}

// The near plane cuts away what lies between it and the eye. The occluder is whole if it lies
// beyond the near plane, which most do, or if all that is cut away is in front of one of its
// visible faces.
static bool survives_near(const solid *s, const occ_camera *camera, const face seen[3])
{
    if (camera->cutter == OCC_NO_PLANE) return true;
    if (is_beyond(s, camera->plane[camera->cutter]) &&
        (!camera->far_cuts_too || is_beyond(s, camera->plane[OCC_NEAR_PLANE + 1]))) {
        return true;
    }
    for (int k = 0; k < 3 && camera->has_corners; k++)
        if (seen[k].sign && cut_is_in_front(s, camera, &seen[k], k)) return true;
    return false;
}

bool occ_shadow_init(occ_shadow *shadow, const occ_camera *camera, const occ_box *box,
                     uint32_t owner)
{
    solid s;
    face seen[3];
    set_solid(&s, camera, box);
    if (!see_faces(&s, camera, seen)) return false;
    if (!survives_near(&s, camera, seen)) return false;
    *shadow = (occ_shadow){.owner = owner};
    if (!add_silhouettes(shadow, &s, camera, seen)) return false;
    shadow->silhouettes = shadow->planes;
    for (int k = 0; k < 3; k++)
        if (seen[k].sign && !add_face(shadow, &s, &seen[k], k)) return false;
    return true;
}
