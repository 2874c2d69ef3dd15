// SPDX-License-Identifier: Apache-2.0
// labels: oracle
// What OpenGL draws, against rays in double through the middles of the pixels, which know neither
// OpenGL nor the matrices.
#include "image_camera.h"
#include "image_compare.h"
#include "image_context.h"
#include "image_gl.h"
#include "soup.h"
#include "steady.h"
#include "support.h"

#include <stdio.h>

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

static const double cotangent = 1.2, near_z = 0.5, far_z = 400;

static model m;
static division d;
static image_parts parts;
static image_gl *gl;
static image_pixels picture;
static uint32_t *objects;

// --- the stage -----------------------------------------------------------------------------------

// Triangles around a place, a quarter of them see-through.
static void make_model(double away)
{
    steady_random random = steady_seed(11, "image gl");
    m = soup_make(300);
    while (m.triangle_count < 300) {
        float p[3][3];
        double middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = away + steady_between(&random, -30, 30);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                p[c][k] = (float)(middle[k] + steady_between(&random, -9, 9));
        m.see_through[m.triangle_count] = steady_below(&random, 4) == 0;
        soup_triangle(&m, p[0], p[1], p[2]);
    }
}

static void open_stage(double away, bool one_sided)
{
    const image_gl_options options = {WIDTH, HEIGHT, one_sided};
    make_model(away);
    const division_options dividing = {.most = 8};
    ck_assert(division_make(&m, &dividing, &d));
    ck_assert(image_parts_make(&m, &d, &parts));
    ck_assert(image_pixels_create(&picture, WIDTH, HEIGHT));
    objects = malloc(parts.object_count * sizeof *objects);
    ck_assert_ptr_nonnull(objects);
    for (uint32_t i = 0; i < parts.object_count; i++)
        objects[i] = i;
    gl = image_gl_open(&parts, &options);
    ck_assert_ptr_nonnull(gl);
}

static void close_stage(void)
{
    image_gl_close(gl);
    free(objects);
    image_pixels_free(&picture);
    image_parts_free(&parts);
    division_free(&d);
    soup_free(&m);
}

static void draw(const obs_frame *frame, size_t count, image_pixels *out)
{
    double clip[16];
    image_pass pass;
    uint32_t triangles = 0;
    ck_assert(image_camera_of(frame, clip));
    ck_assert(image_gl_draw(gl, clip, objects, count, &pass));
    ck_assert(image_gl_read(gl, out->front, out->veil));
    for (size_t i = 0; i < count; i++)
        triangles += parts.first[objects[i] + 1] - parts.first[objects[i]];
    ck_assert_uint_eq(pass.triangles, triangles);
    ck_assert_uint_ge(pass.draws, (uint32_t)count);
    ck_assert(pass.cpu_ms > 0 && pass.whole_ms >= pass.cpu_ms);
}

// --- rays ----------------------------------------------------------------------------------------

typedef struct ray {
    double from[3], along[3]; // `along` goes one unit forward
    bool one_sided;
} ray;

static void cross(const double *a, const double *b, double *out)
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalize(double *a)
{
    double size = sqrt(dot(a, a));
    for (int k = 0; k < 3; k++)
        a[k] /= size;
}

static ray ray_of(const obs_frame *frame, const double forward[3], uint32_t pixel, bool one_sided)
{
    double f[3] = {forward[0], forward[1], forward[2]}, side[3], up[3];
    const double sky[3] = {0, 1, 0};
    normalize(f);
    cross(f, sky, side);
    normalize(side);
    cross(side, f, up);
    uint32_t column = pixel % WIDTH, row = pixel / WIDTH;
    double x = 2 * (column + 0.5) / WIDTH - 1, y = 2 * (row + 0.5) / HEIGHT - 1;
    bool is_parallel = frame->proj[11] == 0.0f;
    ray r = {.one_sided = one_sided};
    for (int k = 0; k < 3; k++) {
        double aside = x / (double)frame->proj[0] * side[k] + y / (double)frame->proj[5] * up[k];
        r.from[k] = (double)frame->eye[k] + (is_parallel ? aside : 0);
        r.along[k] = f[k] + (is_parallel ? 0 : aside);
    }
    return r;
}

typedef enum hit { HIT_NO, HIT_YES, HIT_PERHAPS } hit;

// Whether the ray meets a triangle, and how far ahead; perhaps, if it passes next to an edge.
static hit meet(const ray *r, const uint32_t corners[3], double *ahead)
{
    double edge[2][3], to[3], normal[3], q[3];
    for (int k = 0; k < 3; k++) {
        double origin = (double)m.positions[corners[0]][k];
        edge[0][k] = (double)m.positions[corners[1]][k] - origin;
        edge[1][k] = (double)m.positions[corners[2]][k] - origin;
        to[k] = r->from[k] - origin;
    }
    cross(edge[0], edge[1], normal);
    double slope = -dot(normal, r->along);
    if (r->one_sided && slope < 0) return HIT_NO;
    cross(to, r->along, q);
    double u = dot(edge[1], q) / slope, v = -dot(edge[0], q) / slope;
    *ahead = dot(normal, to) / slope;
    double inside = fmin(fmin(u, v), 1 - u - v);
    if (!(inside > -0.03) || *ahead < 0.99 * near_z) return HIT_NO;
    return inside > 0.03 && *ahead > 1.01 * near_z && *ahead < 0.9 * far_z ? HIT_YES : HIT_PERHAPS;
}

typedef struct sight {
    uint32_t front; // as in a picture
    bool veiled, certain;
} sight;

static sight look(const ray *r, size_t object_count)
{
    sight s = {.certain = true};
    double nearest = INFINITY, doubt = INFINITY, veil = INFINITY;
    for (size_t i = 0; i < object_count; i++)
        for (uint32_t place = parts.first[objects[i]]; place < parts.first[objects[i] + 1];
             place++) {
            double ahead;
            hit h = meet(r, parts.corners[place], &ahead);
            if (h == HIT_NO) continue;
            if (h == HIT_PERHAPS) {
                doubt = fmin(doubt, ahead);
            } else if (place >= parts.see_through[objects[i]]) {
                veil = fmin(veil, ahead);
            } else {
                if (fabs(ahead - nearest) < 1e-3) s.certain = false;
                if (ahead < nearest) s.front = place + 1;
                nearest = fmin(nearest, ahead);
            }
        }
    s.veiled = veil < nearest;
    s.certain = s.certain && doubt > nearest + 1e-3 && fabs(veil - nearest) > 1e-3;
    if (isinf(nearest)) s.certain = isinf(doubt);
    return s;
}

// --- tests ---------------------------------------------------------------------------------------

static void check_picture(const obs_frame *frame, const double forward[3], bool one_sided,
                          size_t count)
{
    uint32_t certain = 0, covered = 0, veiled = 0;
    draw(frame, count, &picture);
    for (uint32_t i = 0; i < PIXELS; i++) {
        ray r = ray_of(frame, forward, i, one_sided);
        sight s = look(&r, count);
        if (!s.certain) continue;
        ck_assert_msg(picture.front[i] == s.front, "pixel %u,%u: %u, not %u", i % WIDTH, i / WIDTH,
                      picture.front[i], s.front);
        ck_assert_msg((picture.veil[i] != 0) == s.veiled, "pixel %u,%u: a veil of %u", i % WIDTH,
                      i / WIDTH, picture.veil[i]);
        certain++;
        covered += s.front != 0;
        veiled += s.veiled;
    }
    ck_assert_uint_gt(certain, PIXELS / 2);
    ck_assert_uint_gt(covered, PIXELS / 20);
    ck_assert_uint_gt(veiled, PIXELS / 80);
}

static void check_frame(const double eye[3], const double forward[3], bool one_sided, size_t count)
{
    obs_frame frame = obs_look(eye, forward, cotangent, (double)WIDTH / HEIGHT, near_z, far_z);
    check_picture(&frame, forward, one_sided, count);
}

// Near the origin and so far from it that floats are a quarter apart, from both sides and from one.
START_TEST(every_pixel_shows_the_triangle_that_a_ray_meets_first)
{
    double away = _i & 1 ? 4000000 : 0;
    bool one_sided = _i & 2;
    const double eye[3] = {away + 3.3, away - 4.7, away + 41.1}, forward[3] = {0.1, 0.13, -1};
    const double middle[3] = {away, away, away}, askew[3] = {-1, 0.7, 0.4};
    open_stage(away, one_sided);
    check_frame(eye, forward, one_sided, parts.object_count);
    check_frame(middle, askew, one_sided, parts.object_count);
    size_t kept = 0; // two of three: see-through objects are the last ones
    for (uint32_t i = 0; i < parts.object_count; i++)
        if (i % 3) objects[kept++] = i;
    check_frame(eye, forward, one_sided, kept);
    close_stage();
}
END_TEST

// Lines of sight that do not meet.
START_TEST(orthographic_picture_is_what_parallel_rays_meet)
{
    const double eye[3] = {3.3, -4.7, 60.1}, forward[3] = {0.1, 0.13, -1};
    obs_frame frame = obs_look(eye, forward, 1, 1, near_z, far_z);
    open_stage(0, false);
    frame.proj[0] = (float)(HEIGHT / (30.0 * WIDTH));
    frame.proj[5] = 1.0f / 30;
    frame.proj[10] = (float)(-2 / (far_z - near_z));
    frame.proj[11] = 0;
    frame.proj[14] = (float)(-(far_z + near_z) / (far_z - near_z));
    frame.proj[15] = 1;
    check_picture(&frame, forward, false, parts.object_count);
    close_stage();
}
END_TEST

// Leaves out each object in turn.
START_TEST(object_left_out_is_missed_where_it_showed)
{
    const double eye[3] = {3.3, -4.7, 41.1}, forward[3] = {0.1, 0.13, -1};
    obs_frame frame = obs_look(eye, forward, cotangent, (double)WIDTH / HEIGHT, near_z, far_z);
    open_stage(0, false);
    image_pixels without;
    ck_assert(image_pixels_create(&without, WIDTH, HEIGHT));
    draw(&frame, parts.object_count, &picture);
    uint32_t *veil = calloc(PIXELS, sizeof *veil);
    ck_assert_ptr_nonnull(veil);
    for (uint32_t left_out = 0; left_out < parts.object_count; left_out++) {
        uint32_t count = 0, expected = 0, different = 0;
        for (uint32_t i = 0; i < parts.object_count; i++)
            if (i != left_out) objects[count++] = i;
        draw(&frame, count, &without);
        ck_assert(image_gl_veil(gl, left_out, veil));
        for (uint32_t i = 0; i < PIXELS; i++) {
            bool front = picture.front[i] > parts.first[left_out] &&
                         picture.front[i] <= parts.first[left_out + 1];
            bool veiled = picture.front[i] == without.front[i] && veil[i] != 0;
            expected += front || veiled;
            different += picture.front[i] != without.front[i] || picture.veil[i] != without.veil[i];
        }
        ck_assert_uint_eq(different, expected);
    }
    free(veil);
    image_pixels_free(&without);
    close_stage();
}
END_TEST

static bool is_present(void)
{
    image_context context;
    const char *missing = image_context_open(&context);
    if (missing) fprintf(stderr, "%s\n", missing);
    return !missing;
}

int main(void)
{
    int skipped = test_skip_unless(is_present, "OpenGL 4.5 without a window", "OCC_REQUIRE_GL");
    if (skipped) return skipped;
    Suite *suite = suite_create("image_gl");
    TCase *drawn = tcase_create("drawn");
    tcase_add_loop_test(drawn, every_pixel_shows_the_triangle_that_a_ray_meets_first, 0, 4);
    tcase_add_test(drawn, orthographic_picture_is_what_parallel_rays_meet);
    tcase_add_test(drawn, object_left_out_is_missed_where_it_showed);
    suite_add_tcase(suite, drawn);
    return test_run_suite(suite);
}
