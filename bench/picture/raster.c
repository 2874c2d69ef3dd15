// SPDX-License-Identifier: Apache-2.0
#include "raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A polygon of clip-space points: a quad or a triangle, and one more corner from cutting it.
typedef struct clip_polygon {
    double at[8][4];
    int count;
} clip_polygon;

// A corner on the raster: x and y in pixels, depth.
typedef double screen_point[3];

raster_camera raster_camera_of(const obs_frame *frame)
{
    raster_camera camera;
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += (double)frame->proj[4 * k + r] * (double)frame->view[4 * c + k];
            camera.clip[4 * c + r] = sum;
        }
    bool perspective = frame->proj[11] != 0.0f;
    for (int k = 0; k < 3; k++)
        camera.eye[k] = perspective ? (double)frame->eye[k] : -(double)frame->dir[k];
    camera.eye[3] = perspective ? 1 : 0;
    return camera;
}

bool raster_create(raster *r, int width, int height)
{
    size_t count = (size_t)width * (size_t)height;
    *r = (raster){.width = width, .height = height};
    r->depth = malloc(count * sizeof *r->depth);
    r->face = malloc(count * sizeof *r->face);
    if (!r->depth || !r->face) {
        raster_free(r);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        r->depth[i] = INFINITY;
        r->face[i] = RASTER_EMPTY;
    }
    return true;
}

static void to_clip(const raster_camera *camera, const double world[3], double out[4])
{
    for (int r = 0; r < 4; r++)
        out[r] = camera->clip[r] * world[0] + camera->clip[4 + r] * world[1] +
                 camera->clip[8 + r] * world[2] + camera->clip[12 + r];
}

// Keeps what is beyond the near plane: z >= -w.
static clip_polygon cut_near(const clip_polygon *p)
{
    clip_polygon out = {.count = 0};
    for (int i = 0; i < p->count; i++) {
        const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
        double da = a[2] + a[3], db = b[2] + b[3];
        if (da >= 0) memcpy(out.at[out.count++], a, sizeof out.at[0]);
        if ((da >= 0) != (db >= 0)) {
            double t = da / (da - db);
            for (int k = 0; k < 4; k++)
                out.at[out.count][k] = a[k] + t * (b[k] - a[k]);
            out.count++;
        }
    }
    return out;
}

static void draw_span(raster *r, int y, double left, double right, const double plane[3],
                      uint32_t face)
{
    if (right < 0 || left > r->width) return;
    int from = left <= 0 ? 0 : (int)ceil(left - 0.5);
    int to = right >= r->width ? r->width - 1 : (int)floor(right - 0.5);
    size_t row = (size_t)y * (size_t)r->width;
    for (int x = from; x <= to; x++) {
        double z = plane[0] * (x + 0.5) + plane[1] * (y + 0.5) + plane[2];
        // Of faces in one plane the first stays: rounding would mix them in stripes.
        if (z > 1 || z + 1e-5 * (1 - z) >= (double)r->depth[row + (size_t)x]) continue;
        r->depth[row + (size_t)x] = (float)z;
        r->face[row + (size_t)x] = face;
    }
}

// Depth is linear over the screen: z = plane . (x, y, 1). False for a polygon without area.
static bool depth_plane(const screen_point *p, int count, double plane[3])
{
    double best = 0;
    for (int i = 1; i + 1 < count; i++) {
        double ux = p[i][0] - p[0][0], uy = p[i][1] - p[0][1], uz = p[i][2] - p[0][2];
        double vx = p[i + 1][0] - p[0][0], vy = p[i + 1][1] - p[0][1], vz = p[i + 1][2] - p[0][2];
        double area = ux * vy - uy * vx;
        if (fabs(area) <= best) continue;
        best = fabs(area);
        plane[0] = (uz * vy - uy * vz) / area;
        plane[1] = (ux * vz - uz * vx) / area;
        plane[2] = p[0][2] - plane[0] * p[0][0] - plane[1] * p[0][1];
    }
    return best > 0;
}

static void draw_polygon(raster *r, const screen_point *p, int count, uint32_t face)
{
    double plane[3] = {0, 0, 0}, low = INFINITY, high = -INFINITY;
    if (!depth_plane(p, count, plane)) return;
    for (int i = 0; i < count; i++) {
        low = fmin(low, p[i][1]);
        high = fmax(high, p[i][1]);
    }
    if (high < 0 || low > r->height) return;
    int first = low <= 0 ? 0 : (int)ceil(low - 0.5);
    int last = high >= r->height ? r->height - 1 : (int)floor(high - 0.5);
    for (int y = first; y <= last; y++) {
        double left = INFINITY, right = -INFINITY, middle = y + 0.5;
        for (int i = 0; i < count; i++) {
            const double *a = p[i], *b = p[(i + 1) % count];
            if ((a[1] <= middle) == (b[1] <= middle)) continue;
            double x = a[0] + (middle - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            left = fmin(left, x);
            right = fmax(right, x);
        }
        if (left <= right) draw_span(r, y, left, right, plane, face);
    }
}

static void draw_face(raster *r, const raster_camera *camera, const double (*corner)[3], int count,
                      uint32_t face)
{
    clip_polygon p = {.count = count};
    screen_point screen[8];
    for (int i = 0; i < count; i++)
        to_clip(camera, corner[i], p.at[i]);
    p = cut_near(&p);
    if (p.count < 3) return;
    for (int i = 0; i < p.count; i++) {
        if (p.at[i][3] <= 0) return; // On the eye: the near plane is at the eye.
        screen[i][0] = (p.at[i][0] / p.at[i][3] + 1) / 2 * r->width;
        screen[i][1] = (1 - p.at[i][1] / p.at[i][3]) / 2 * r->height;
        screen[i][2] = p.at[i][2] / p.at[i][3];
    }
    draw_polygon(r, (const screen_point *)screen, p.count, face);
}

static double dot_cross(const double *a, const double *b, const double *c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Where the eye is along each axis, times the box's volume: beyond the volume, outside that face.
static void eye_in_box(const raster_camera *camera, double axis[3][3], const double center[3],
                       double volume, double along[3])
{
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = camera->eye[k] - center[k] * camera->eye[3];
    for (int k = 0; k < 3; k++) {
        along[k] = dot_cross(d, axis[(k + 1) % 3], axis[(k + 2) % 3]);
        if (volume < 0) along[k] = -along[k];
    }
}

void raster_box(raster *r, const raster_camera *camera, const occ_box *box, uint32_t number)
{
    double center[3], axis[3][3], along[3];
    for (int k = 0; k < 3; k++) {
        center[k] = (double)box->center[k];
        for (int n = 0; n < 3; n++)
            axis[n][k] = (double)box->axis[n][k];
    }
    double volume = dot_cross(axis[0], axis[1], axis[2]);
    eye_in_box(camera, axis, center, volume, along);
    for (uint32_t face = 0; face < 6; face++) {
        const double *a = axis[face / 2], *u = axis[(face / 2 + 1) % 3],
                     *v = axis[(face / 2 + 2) % 3];
        double side = face & 1 ? 1 : -1, corner[4][3];
        if (face % 2 == 0 && a[0] == 0 && a[1] == 0 && a[2] == 0) continue; // is the other side
        if (volume != 0 && side * along[face / 2] <= fabs(volume) * camera->eye[3]) continue;
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++)
                corner[i][k] = center[k] + side * a[k] + (i == 1 || i == 2 ? u[k] : -u[k]) +
                               (i >= 2 ? v[k] : -v[k]);
        draw_face(r, camera, (const double(*)[3])corner, 4, 6 * number + face);
    }
}

// Whether the eye is where the corners go counterclockwise.
static bool is_before(const raster_camera *camera, double corner[3][3])
{
    double u[3], v[3], to_eye[3];
    for (int k = 0; k < 3; k++) {
        u[k] = corner[1][k] - corner[0][k];
        v[k] = corner[2][k] - corner[0][k];
        to_eye[k] = camera->eye[k] - corner[0][k] * camera->eye[3];
    }
    return dot_cross(to_eye, u, v) > 0;
}

void raster_sheet(raster *r, const raster_camera *camera, const occ_sheet *sheet, uint32_t number)
{
    for (uint32_t t = 0; t + 2 < sheet->corner_count; t++) {
        const uint32_t from[3] = {0, t + 1, t + 2};
        double corner[3][3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                corner[c][k] = (double)sheet->corner[from[c]][k];
        if (sheet->sides == OCC_SIDES_FRONT && !is_before(camera, corner)) continue;
        draw_face(r, camera, (const double(*)[3])corner, 3, 6 * number);
    }
}

void raster_triangle(raster *r, const raster_camera *camera, const float *const corner[3],
                     uint32_t number)
{
    double at[3][3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            at[c][k] = (double)corner[c][k];
    draw_face(r, camera, (const double(*)[3])at, 3, 6 * number);
}

bool raster_is_edge(const raster *r, int x, int y, int reach)
{
    size_t i = (size_t)y * (size_t)r->width + (size_t)x;
    size_t aside = (size_t)reach, down = aside * (size_t)r->width;
    uint32_t face = r->face[i];
    return (x >= reach && face != r->face[i - aside]) ||
           (x + reach < r->width && face != r->face[i + aside]) ||
           (y >= reach && face != r->face[i - down]) ||
           (y + reach < r->height && face != r->face[i + down]);
}

void raster_free(raster *r)
{
    free(r->depth);
    free(r->face);
    *r = (raster){0};
}
