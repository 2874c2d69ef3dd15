// SPDX-License-Identifier: Apache-2.0
#include "gl_boxes.h"

#include <math.h>
#include <string.h>

enum { X, Y, Z, W, MOST_CORNERS = 12 };

// --- vectors -------------------------------------------------------------------------------------

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length(const double *a)
{
    return sqrt(dot(a, a));
}

static void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// --- cameras -------------------------------------------------------------------------------------

// Depth as 1 at the near plane and 0 at the far one.
static void reverse_depth(double row[4][4], occ_depth depth)
{
    for (int k = 0; k < 4; k++) {
        if (depth == OCC_DEPTH_MINUS_ONE_TO_ONE) row[Z][k] = 0.5 * (row[W][k] - row[Z][k]);
        if (depth == OCC_DEPTH_ZERO_TO_ONE) row[Z][k] = row[W][k] - row[Z][k];
    }
}

// The matrix's own eye, by Cramer's rule; and how far a point must go to move in x or y alone.
static void find_eye(glb_camera *c)
{
    const double *along = length(c->row[W]) > 0.0 ? c->row[W] : c->row[Z];
    double of_x[3], of_y[3], of_w[3];
    cross(c->row[Y], along, of_x);
    cross(along, c->row[X], of_y);
    cross(c->row[X], c->row[Y], of_w);
    double det = dot(of_x, c->row[X]);
    c->lateral[0] = length(of_x) / fabs(det);
    c->lateral[1] = length(of_y) / fabs(det);
    c->eye[3] = along == c->row[W] ? 1.0 : 0.0;
    for (int j = 0; j < 3; j++) {
        double at = of_x[j] * c->row[X][3] + of_y[j] * c->row[Y][3] + of_w[j] * along[3];
        c->eye[j] = along == c->row[W] ? -at / det : of_w[j];
    }
}

glb_camera glb_camera_of(const occ_camera_desc *desc, int width, int height, int subpixel_bits)
{
    glb_camera c = {.pixels = {width, height}};
    for (int i = 0; i < 16; i++)
        c.row[i % 4][i / 4] = (double)desc->view_projection[i];
    reverse_depth(c.row, desc->depth);
    find_eye(&c);
    if (desc->eye && c.eye[3] != 0.0) { // the planes move with the eye
        double moved[3];
        for (int j = 0; j < 3; j++) {
            moved[j] = c.eye[j] - desc->eye[j];
            c.eye[j] = desc->eye[j];
        }
        for (int r = 0; r < 4; r++)
            c.row[r][3] += dot(c.row[r], moved);
    }
    c.tolerance = 1.5 * exp2(-subpixel_bits) +
                  16.0 * 0x1p-24 * 0.5 * (fmax(c.pixels[0], c.pixels[1]) + 2.0 * GLB_BORDER);
    return c;
}

// The point's clip coordinates in a viewport that has a border around the frustum.
static void to_clip(const glb_camera *c, const double point[3], double out[4])
{
    for (int r = 0; r < 4; r++)
        out[r] = dot(c->row[r], point) + c->row[r][3];
    for (int r = 0; r < 2; r++) {
        double whole = c->pixels[r] + 2.0 * GLB_BORDER;
        out[r] = out[r] * (c->pixels[r] / whole) + out[W] * (2.0 * c->shift[r] / whole);
    }
}

void glb_project(const glb_camera *c, const double point[3], double out[2])
{
    double clip[4];
    to_clip(c, point, clip);
    for (int r = 0; r < 2; r++)
        out[r] = (clip[r] / clip[W] + 1.0) * 0.5 * (c->pixels[r] + 2.0 * GLB_BORDER);
}

static void corner_of(const occ_box *box, unsigned corner, double out[3])
{
    for (int j = 0; j < 3; j++) {
        out[j] = (double)box->center[j];
        for (int k = 0; k < 3; k++)
            out[j] += (corner >> k & 1u ? 1.0 : -1.0) * (double)box->axis[k][j];
    }
}

// --- larger and smaller --------------------------------------------------------------------------

// A box by its axes; a zero axis of a sheet is its normal, of length 1.
typedef struct solid {
    double axis[3][3], height[3]; // half the distance of two faces
    int flat;                     // the zero axis, or -1
} solid;

// Half the distance of the two faces across axis k; `normal` gets their normal, of length 1.
static double height_of(const solid *s, int k, double normal[3])
{
    cross(s->axis[(k + 1) % 3], s->axis[(k + 2) % 3], normal);
    double size = length(normal);
    for (int j = 0; j < 3; j++)
        normal[j] /= size;
    return size > 0.0 ? fabs(dot(normal, s->axis[k])) : NAN;
}

static bool solid_of(const occ_box *box, solid *s)
{
    double normal[3];
    s->flat = -1;
    for (int k = 0; k < 3; k++) {
        for (int j = 0; j < 3; j++)
            s->axis[k][j] = (double)box->axis[k][j];
        if (length(s->axis[k]) > 0.0) continue;
        if (s->flat >= 0) return false;
        s->flat = k;
    }
    if (s->flat >= 0) {
        if (isnan(height_of(s, s->flat, normal))) return false;
        memcpy(s->axis[s->flat], normal, sizeof normal);
    }
    for (int k = 0; k < 3; k++) {
        s->height[k] = height_of(s, k, normal);
        if (isnan(s->height[k])) return false;
    }
    return true;
}

// How far the box's points must go in the world, at most, to move by so many pixels.
static double reach_of(const glb_camera *c, const occ_box *box, double pixels)
{
    double most = 0.0;
    for (unsigned i = 0; i < 8; i++) {
        double at[3];
        corner_of(box, i, at);
        most = fmax(most, dot(c->row[W], at) + c->row[W][3]);
    }
    return most * 2.0 * pixels * hypot(c->lateral[0] / c->pixels[0], c->lateral[1] / c->pixels[1]);
}

// The least cosine between a sheet's normal and the lines of sight to it. In one plane all of them
// have the same part along the normal, so that the longest one decides, which ends at a corner.
static double slant_of(const glb_camera *c, const occ_box *box, const double normal[3])
{
    double least = 1.0;
    for (unsigned i = 0; i < 8; i++) {
        double sight[3];
        corner_of(box, i, sight);
        for (int j = 0; j < 3; j++)
            sight[j] = c->eye[j] - c->eye[3] * sight[j];
        least = fmin(least, fabs(dot(normal, sight)) / length(sight));
    }
    return least;
}

// A plate that is too thin to be made smaller becomes the sheet in its middle.
static bool flatten(solid *s, double least, occ_box *box)
{
    for (int k = 0; k < 3 && s->flat < 0; k++) {
        if (s->height[k] > least) continue;
        memset(box->axis[k], 0, sizeof box->axis[k]);
        return solid_of(box, s);
    }
    return true;
}

bool glb_grow(const glb_camera *c, const occ_box *box, double pixels, occ_box *out)
{
    solid s;
    *out = *box;
    double reach = reach_of(c, box, pixels);
    if (!solid_of(box, &s) || (pixels < 0.0 && !flatten(&s, -reach, out))) return false;
    if (pixels < 0.0 && s.flat >= 0) {
        double slant = slant_of(c, out, s.axis[s.flat]);
        if (slant < 0.1) return false;
        reach *= 2.0 / slant; // in the sheet's plane
    }
    for (int k = 0; k < 3; k++) {
        double factor = k == s.flat ? fmax(reach, 0.0) : 1.0 + reach / s.height[k];
        if (k != s.flat && !(factor > 0.0 && isfinite(factor))) return false;
        for (int j = 0; j < 3; j++)
            out->axis[k][j] = (float)(factor * s.axis[k][j]);
    }
    return true;
}

// --- cutting -------------------------------------------------------------------------------------

typedef struct polygon {
    int count;
    double corner[MOST_CORNERS][4];
} polygon;

// What is positive on one side of a plane: parts of x, y, z, w, and a constant.
static double value(const double plane[5], const double corner[4])
{
    return plane[X] * corner[X] + plane[Y] * corner[Y] + plane[Z] * corner[Z] +
           plane[W] * corner[W] + plane[4];
}

// What of the polygon is on the plane's side that is not negative, or on the other one. Where an
// edge is cut comes out the same for both sides, and for both faces that share the edge.
static void cut(polygon *p, const double plane[5], bool other_side)
{
    polygon from = *p;
    p->count = 0;
    for (int i = 0; i < from.count; i++) {
        const double *a = from.corner[i], *b = from.corner[(i + 1) % from.count];
        double at_a = value(plane, a), at_b = value(plane, b);
        if (other_side ? at_a <= 0.0 : at_a >= 0.0)
            memcpy(p->corner[p->count++], a, sizeof from.corner[0]);
        if (!((at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0))) continue;
        bool ascends = at_a < at_b;
        const double *low = ascends ? a : b, *high = ascends ? b : a;
        double at_low = fmin(at_a, at_b), part = at_low / (at_low - fmax(at_a, at_b));
        for (int r = 0; r < 4; r++)
            p->corner[p->count][r] = low[r] + part * (high[r] - low[r]);
        p->count++;
    }
}

// The face of axis k at its low or high end, cut to the sides of the framebuffer and to what is
// ahead of the eye.
static polygon face_of(const glb_camera *c, const occ_box *box, int face, double least_w)
{
    static const unsigned around[4] = {0, 1, 3, 2};
    polygon p = {.count = 4};
    int k = face / 2;
    for (int i = 0; i < 4; i++) {
        double at[3];
        unsigned u = around[i] & 1u, v = around[i] >> 1;
        corner_of(box, (unsigned)(face & 1) << k | u << (k + 1) % 3 | v << (k + 2) % 3, at);
        to_clip(c, at, p.corner[i]);
    }
    cut(&p, (const double[5]){0, 0, 0, 1, -least_w}, false);
    for (int side = 0; side < 4; side++) {
        double plane[5] = {0};
        plane[side / 2] = side % 2 ? 1.0 : -1.0;
        plane[W] = 1.0 - 1.0 / (c->pixels[side / 2] + 2.0 * GLB_BORDER);
        cut(&p, plane, false);
    }
    return p;
}

// The cut ahead of the eye is so close to it that what it takes away is seen nowhere.
static double least_w_of(const glb_camera *c, const occ_box *box)
{
    double most = 0.0;
    for (unsigned i = 0; i < 8; i++) {
        double at[3];
        corner_of(box, i, at);
        most = fmax(most, fabs(dot(c->row[W], at) + c->row[W][3]));
    }
    return 1e-6 * most;
}

static const double near_plane[5] = {0, 0, -1, 1, 0}, far_plane[5] = {0, 0, 1, 0, 0};

static bool holds_eye(const glb_camera *c, const occ_box *box)
{
    solid s;
    double to_eye[3], normal[3];
    if (c->eye[3] == 0.0 || !solid_of(box, &s)) return false;
    for (int j = 0; j < 3; j++)
        to_eye[j] = c->eye[j] - (double)box->center[j];
    for (int k = 0; k < 3; k++) {
        cross(s.axis[(k + 1) % 3], s.axis[(k + 2) % 3], normal);
        double end = k == s.flat ? 0.0 : fabs(dot(normal, s.axis[k]));
        if (fabs(dot(normal, to_eye)) > end + 1e-6 * length(normal) * length(s.axis[k]))
            return false;
    }
    return true;
}

// Whether some of a face that the frustum leaves is on the far side of a plane.
static bool is_cut(const glb_camera *c, const occ_box *box, const double plane[5])
{
    double least_w = least_w_of(c, box);
    for (int face = 0; face < 6; face++) {
        polygon p = face_of(c, box, face, least_w);
        for (int i = 0; i < p.count; i++)
            if (value(plane, p.corner[i]) < 0.0) return true;
    }
    return holds_eye(c, box);
}

bool glb_is_open(const glb_camera *c, const occ_box *box)
{
    const double ahead[5] = {0, 0, 0, 1, -2.0 * least_w_of(c, box)};
    return c->eye[3] != 0.0 && is_cut(c, box, ahead);
}

bool glb_is_cut_by_near(const glb_camera *c, const occ_box *box)
{
    return is_cut(c, box, near_plane);
}

// --- triangles -----------------------------------------------------------------------------------

typedef struct window {
    double x, y, z; // pixels, pixels, depth
} window;

static window to_window(const glb_camera *c, const double corner[4])
{
    return (window){corner[X] / corner[W] * 0.5 * (c->pixels[0] + 2.0 * GLB_BORDER),
                    corner[Y] / corner[W] * 0.5 * (c->pixels[1] + 2.0 * GLB_BORDER),
                    corner[Z] / corner[W]};
}

// How wrong the depth of a triangle may be, twice over; infinite if the triangle is too thin.
static double doubt_of(const glb_camera *c, const window t[3])
{
    double ax = t[1].x - t[0].x, ay = t[1].y - t[0].y, az = t[1].z - t[0].z;
    double bx = t[2].x - t[0].x, by = t[2].y - t[0].y, bz = t[2].z - t[0].z;
    double area = fabs(ax * by - ay * bx);
    double longest = fmax(fmax(hypot(ax, ay), hypot(bx, by)), hypot(ax - bx, ay - by));
    double thickness = area / longest;
    if (!(thickness > 16.0 * c->tolerance)) return INFINITY;
    double slope = (fabs(az * by - ay * bz) + fabs(ax * bz - az * bx)) / area;
    double range = fmax(fmax(fabs(az), fabs(bz)), fabs(az - bz));
    double highest = fmax(fmax(t[0].z, t[1].z), t[2].z);
    return 8.0 * c->tolerance * slope +
           32.0 * 0x1p-24 * (range * longest / thickness + fabs(highest));
}

static int add_triangle(const glb_camera *c, const double *const corner[3], glb_manner manner,
                        bool lies_in_near, glb_vertex *out)
{
    window t[3];
    for (int i = 0; i < 3; i++)
        t[i] = to_window(c, corner[i]);
    double doubt = doubt_of(c, t);
    if (manner == GLB_SPARING && isinf(doubt)) return 0;
    for (int i = 0; i < 3; i++) {
        double z = manner == GLB_GENEROUS ? t[i].z + doubt : t[i].z - doubt;
        if (lies_in_near || isinf(doubt)) z = 1.0;
        out[i] = (glb_vertex){(float)corner[i][X], (float)corner[i][Y], (float)(z * corner[i][W]),
                              (float)corner[i][W]};
    }
    return 3;
}

static int add_polygon(const glb_camera *c, const polygon *p, glb_manner manner, bool lies_in_near,
                       glb_vertex *out)
{
    int count = 0;
    for (int i = 2; i < p->count; i++) {
        const double *const corner[3] = {p->corner[0], p->corner[i - 1], p->corner[i]};
        count += add_triangle(c, corner, manner, lies_in_near, out + count);
    }
    return count;
}

int glb_triangles(const glb_camera *c, const occ_box *box, glb_manner manner,
                  glb_vertex out[GLB_MOST_VERTICES])
{
    double least_w = least_w_of(c, box);
    int count = 0;
    for (int face = 0; face < 6; face++) {
        polygon beyond = face_of(c, box, face, least_w), before = beyond;
        cut(&beyond, near_plane, false);
        cut(&before, near_plane, true);
        if (manner == GLB_SPARING) cut(&beyond, far_plane, false);
        count += add_polygon(c, &beyond, manner, false, out + count);
        if (manner == GLB_GENEROUS) count += add_polygon(c, &before, manner, true, out + count);
    }
    return count;
}
