// SPDX-License-Identifier: Apache-2.0
#include "path.h"

#include "progress.h"
#include "route.h"
#include "steady.h"
#include "voxels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double GRID_CELLS = 4e6;
static const double COTANGENT = 1.7320508075688772; // 60 degrees from bottom to top
static const double ASPECT = 16.0 / 9.0;
static const double PI = 3.14159265358979323846;

typedef struct way {
    double (*points)[3];
    size_t count;
} way;

// The eye is a float, as it will be in the file: nothing is derived from a finer one.
typedef struct pose {
    float eye[3];
    double direction[3];
} pose;

static double distance(const double a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(sum);
}

static double dot3(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void take_eye(const pose *p, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)p->eye[k];
}

static double clamp(double value, double least, double most)
{
    return value < least ? least : value > most ? most : value;
}

static double diagonal(const model *m)
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)m->min[k];
        b[k] = (double)m->max[k];
    }
    return distance(a, b);
}

static double width(const model *m)
{
    return fmax((double)m->max[0] - (double)m->min[0], (double)m->max[2] - (double)m->min[2]);
}

// The nearest point of a segment, as a distance.
static double to_segment(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3], q[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = b[k] - a[k];
        ap[k] = p[k] - a[k];
    }
    double square = dot3(ab, ab);
    double t = square > 0 ? clamp(dot3(ap, ab) / square, 0, 1) : 0;
    for (int k = 0; k < 3; k++)
        q[k] = a[k] + t * ab[k];
    return distance(p, q);
}

// From a point to a triangle: to its plane if the foot is inside, else to its nearest edge.
static double to_triangle(const double p[3], double c[3][3])
{
    double u[3], v[3], w[3], n[3];
    for (int k = 0; k < 3; k++) {
        u[k] = c[1][k] - c[0][k];
        v[k] = c[2][k] - c[0][k];
        w[k] = p[k] - c[0][k];
    }
    double uu = dot3(u, u), uv = dot3(u, v), vv = dot3(v, v), wu = dot3(w, u), wv = dot3(w, v);
    double det = uu * vv - uv * uv;
    double s = vv * wu - uv * wv, t = uu * wv - uv * wu;
    if (det > 0 && s >= 0 && t >= 0 && s + t <= det) {
        for (int k = 0; k < 3; k++)
            n[k] = w[k] - (s * u[k] + t * v[k]) / det;
        return sqrt(dot3(n, n));
    }
    return fmin(to_segment(p, c[0], c[1]),
                fmin(to_segment(p, c[1], c[2]), to_segment(p, c[2], c[0])));
}

static double clearance_at(const model *m, const double eye[3], double best)
{
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        double c[3][3];
        bool far = false;
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++)
                c[i][k] = (double)m->positions[m->corners[t][i]][k];
            far = far || fmin(c[0][k], fmin(c[1][k], c[2][k])) > eye[k] + best ||
                  fmax(c[0][k], fmax(c[1][k], c[2][k])) < eye[k] - best;
        }
        if (!far) best = fmin(best, to_triangle(eye, c));
    }
    return best;
}

// Replaces points by the mean of their neighbours as long as they stay in cells that are allowed.
static void smooth(const voxel_grid *grid, const route *r, way *w)
{
    for (int round = 0; round < 200; round++)
        for (size_t i = 1; i + 1 < w->count; i++) {
            double p[3];
            for (int k = 0; k < 3; k++) {
                p[k] =
                    0.25 * w->points[i - 1][k] + 0.5 * w->points[i][k] + 0.25 * w->points[i + 1][k];
            }
            size_t cell = voxels_at(grid, p);
            if (cell != SIZE_MAX && r->allowed[cell]) memcpy(w->points[i], p, sizeof p);
        }
}

static bool make_way(const voxel_grid *grid, const route *r, way *w)
{
    w->count = r->count;
    w->points = malloc(r->count * sizeof *w->points);
    if (!w->points) return false;
    for (size_t i = 0; i < r->count; i++)
        voxels_center(grid, r->cells[i], w->points[i]);
    smooth(grid, r, w);
    return true;
}

static double way_length(const way *w)
{
    double length = 0;
    for (size_t i = 1; i < w->count; i++)
        length += distance(w->points[i - 1], w->points[i]);
    return length;
}

// The point that lies `along` the way from its start, or its end.
static void point_along(const way *w, double along, double out[3])
{
    for (size_t i = 1; i < w->count; i++) {
        double step = distance(w->points[i - 1], w->points[i]);
        if (along > step) {
            along -= step;
            continue;
        }
        for (int k = 0; k < 3; k++) {
            double t = step > 0 ? along / step : 0;
            out[k] = w->points[i - 1][k] + t * (w->points[i][k] - w->points[i - 1][k]);
        }
        return;
    }
    memcpy(out, w->points[w->count - 1], 3 * sizeof(double));
}

// Looks where the way leads, turned aside by `yaw`, and never steeply up or down.
static void look_along(const double from[3], const double to[3], double yaw, double out[3])
{
    double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    double level = sqrt(d[0] * d[0] + d[2] * d[2]);
    if (level == 0) {
        d[0] = level = 1;
        d[1] = 0;
    }
    out[0] = (steady_cos(yaw) * d[0] - steady_sin(yaw) * d[2]) / level;
    out[1] = clamp(d[1] / level, -0.3, 0.3);
    out[2] = (steady_sin(yaw) * d[0] + steady_cos(yaw) * d[2]) / level;
}

static pose pose_on_way(const way *w, double length, double share)
{
    pose p;
    double eye[3], ahead[3], behind[3], reach = 0.03 * length;
    double along = length * (0.02 + 0.96 * share);
    point_along(w, along, eye);
    point_along(w, fmin(along + reach, length), ahead);
    point_along(w, fmax(along - reach, 0), behind);
    for (int k = 0; k < 3; k++)
        p.eye[k] = (float)eye[k];
    look_along(behind, ahead, 0.6 * steady_sin(7 * 2 * PI * share), p.direction);
    return p;
}

// Around a model without an inside, at the height of its upper half.
static pose pose_on_orbit(const model *m, double share)
{
    pose p;
    double angle = 2 * PI * share, radius = 0.9 * diagonal(m) + 1e-30, middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (double)m->min[k] + 0.5 * (double)m->max[k];
    p.eye[0] = (float)(middle[0] + radius * steady_cos(angle));
    p.eye[1] = 0.25f * m->min[1] + 0.75f * m->max[1];
    p.eye[2] = (float)(middle[2] + radius * steady_sin(angle));
    for (int k = 0; k < 3; k++)
        p.direction[k] = middle[k] - (double)p.eye[k];
    return p;
}

static double farthest_corner(const model *m, const double eye[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double d = fmax(fabs(eye[k] - (double)m->min[k]), fabs(eye[k] - (double)m->max[k]));
        sum += d * d;
    }
    return sqrt(sum);
}

static bool add_frames(const model *m, const pose *poses, uint32_t frames, obs_scene *scene,
                       path_report *report)
{
    double corner = sqrt(1 + (1 + ASPECT * ASPECT) / (COTANGENT * COTANGENT));
    report->clearance = diagonal(m) + 1e-30;
    report->far_z = 0;
    progress_begin("measuring clearance, by frame", frames);
    for (uint32_t i = 0; i < frames; i++) {
        progress_step(i);
        double eye[3];
        take_eye(&poses[i], eye);
        report->clearance = clearance_at(m, eye, report->clearance);
        report->far_z = fmax(report->far_z, farthest_corner(m, eye));
    }
    progress_end();
    report->far_z *= 1.01;
    // Far from the origin an eye's own rounding may take it to a surface: near stays above 0.
    report->near_z = fmax(0.5 * report->clearance / corner, 1e-7 * report->far_z);
    for (uint32_t i = 0; i < frames; i++) {
        double eye[3];
        take_eye(&poses[i], eye);
        obs_frame frame =
            obs_look(eye, poses[i].direction, COTANGENT, ASPECT, report->near_z, report->far_z);
        if (obs_add_frame(scene, &frame) == UINT32_MAX) return false;
    }
    return true;
}

// Tries rules from the strictest to the loosest until a way is long enough to be worth it.
static bool find_route(const model *m, const voxel_grid *grid, double eye_height, route *r,
                       path_report *report)
{
    int above = (int)clamp(ceil(eye_height / 0.75 / grid->cell), 4, 1000);
    const route_rule rules[] = {{10, 6, above}, {8, 4, above},   {10, 6, 0}, {6, 3, above},
                                {8, 4, 0},      {10, -4, above}, {10, -4, 0}};
    double enough = 0.4 * width(m) / grid->cell;
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        if (!route_find(grid, &rules[i], r)) return false;
        if (r->count > 2 && r->length >= enough) {
            report->kind = rules[i].max_above ? "walk" : "flight";
            return true;
        }
        route_free(r);
    }
    report->kind = "orbit";
    return true;
}

static bool fill_poses(const model *m, double eye_height, pose *poses, uint32_t frames,
                       path_report *report)
{
    voxel_grid grid;
    route r = {0};
    way w = {0};
    if (!voxels_build(m, GRID_CELLS, &grid)) return false;
    bool done = find_route(m, &grid, eye_height, &r, report);
    bool inside = done && r.count > 0;
    if (inside) done = make_way(&grid, &r, &w);
    if (done) report->length = inside ? way_length(&w) : 2 * PI * 0.9 * diagonal(m);
    for (uint32_t i = 0; done && i < frames; i++) {
        double share = (i + 0.5) / frames;
        poses[i] = inside ? pose_on_way(&w, report->length, share) : pose_on_orbit(m, share);
    }
    free(w.points);
    route_free(&r);
    voxels_free(&grid);
    return done;
}

bool path_make(const model *m, uint32_t frames, double eye_height, obs_scene *scene,
               path_report *report)
{
    *report = (path_report){0};
    double height = (double)m->max[1] - (double)m->min[1];
    if (eye_height <= 0) eye_height = fmin(0.03 * width(m), 0.1 * height);
    pose *poses = malloc(((size_t)frames + 1) * sizeof *poses);
    bool done = poses && fill_poses(m, eye_height, poses, frames, report) &&
                add_frames(m, poses, frames, scene, report);
    free(poses);
    return done;
}
