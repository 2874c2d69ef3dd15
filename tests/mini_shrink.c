// SPDX-License-Identifier: Apache-2.0
// Greedy descent: a candidate is taken if it costs less and fails too. Since the cost is a whole
// number that only falls, this ends. (The idea of shrinking is QuickCheck's: Claessen and Hughes,
// QuickCheck: A Lightweight Tool for Random Testing of Haskell Programs, ICFP 2000.)
#include "mini_shrink.h"

#include <math.h>
#include <string.h>

// --- the cost ------------------------------------------------------------------------------------

// 0 is free, 1 is cheap; every binary digit, the sign and a large exponent cost.
static uint64_t number_cost(double x)
{
    if (x == 0.0) return signbit(x) ? 1 : 0;
    int exponent, digits = 53;
    double mantissa = frexp(fabs(x), &exponent) * 0x1p53; // a whole number
    for (; fmod(mantissa, 2.0) == 0.0; mantissa *= 0.5)
        digits--;
    int distance = exponent > 0 ? exponent - 1 : 1 - exponent;
    return 3 + 4 * (uint64_t)(digits - 1) + (uint64_t)distance + (x < 0.0);
}

static uint64_t box_cost(const occ_box *box)
{
    uint64_t sum = 0;
    for (int j = 0; j < 3; j++) {
        sum += number_cost((double)box->center[j]);
        for (int i = 0; i < 3; i++)
            sum += number_cost((double)box->axis[i][j]);
    }
    return sum;
}

static uint64_t camera_cost(const mini_camera *camera)
{
    uint64_t sum = camera->depth != OCC_DEPTH_MINUS_ONE_TO_ONE ? 100 : 0;
    for (int j = 0; j < 3; j++)
        sum += number_cost(camera->eye[j]);
    for (int i = 0; i < 16; i++)
        sum += number_cost((double)camera->frame.proj[i]) / 2 +
               (i % 4 < 3 && i < 12 ? number_cost((double)camera->frame.view[i]) : 0);
    return sum;
}

uint64_t mini_cost(const mini *m)
{
    uint64_t sum = camera_cost(&m->camera);
    for (uint32_t i = 0; i < m->object_count; i++)
        sum += 10000 + box_cost(&m->objects[i]);
    for (uint32_t k = 0; k < m->occluder_count; k++)
        sum += 10000 + box_cost(&m->occluders[k].box) + (m->occluders[k].owner >= 0 ? 50 : 0);
    return sum;
}

// --- steps ---------------------------------------------------------------------------------------

typedef struct shrinker {
    mini best;
    uint64_t cost;
    mini_predicate *fails;
    void *context;
    unsigned asked;
} shrinker;

static bool take(shrinker *s, const mini *candidate)
{
    uint64_t cost = mini_cost(candidate);
    if (cost >= s->cost) return false;
    s->asked++;
    if (!s->fails(candidate, s->context)) return false;
    s->best = *candidate;
    s->cost = cost;
    return true;
}

// Without the objects from `first` on. What they own is then nobody's, or gone as well.
static mini without_objects(const mini *m, uint32_t first, uint32_t count, bool keep_occluders)
{
    mini less = *m;
    less.object_count = m->object_count - count;
    for (uint32_t i = first; i < less.object_count; i++)
        less.objects[i] = m->objects[i + count];
    less.occluder_count = 0;
    for (uint32_t k = 0; k < m->occluder_count; k++) {
        world_occluder occluder = m->occluders[k];
        bool orphan = occluder.owner >= (int)first && occluder.owner < (int)(first + count);
        if (orphan && !keep_occluders) continue;
        if (orphan) occluder.owner = -1;
        if (occluder.owner >= (int)first) occluder.owner -= (int)count;
        less.occluders[less.occluder_count++] = occluder;
    }
    return less;
}

static void drop_objects(shrinker *s)
{
    for (uint32_t size = s->best.object_count; size > 0; size /= 2)
        for (uint32_t first = 0; first + size <= s->best.object_count;) {
            mini bare = without_objects(&s->best, first, size, false);
            mini less = without_objects(&s->best, first, size, true);
            if (!take(s, &bare) && !take(s, &less)) first += size;
        }
}

static void drop_occluders(shrinker *s)
{
    for (uint32_t size = s->best.occluder_count; size > 0; size /= 2)
        for (uint32_t first = 0; first + size <= s->best.occluder_count;) {
            mini less = s->best;
            less.occluder_count -= size;
            for (uint32_t k = first; k < less.occluder_count; k++)
                less.occluders[k] = s->best.occluders[k + size];
            if (!take(s, &less)) first += size;
        }
    for (uint32_t k = 0; k < s->best.occluder_count; k++) {
        mini less = s->best;
        less.occluders[k].owner = -1;
        take(s, &less);
    }
}

// The eye at the origin, or what is in its middle there; and everything as large as 1.
static void bring_home(shrinker *s)
{
    double by[3];
    for (int j = 0; j < 3; j++)
        by[j] = -s->best.camera.eye[j];
    mini moved = s->best;
    mini_move(&moved, by);
    take(s, &moved);
    for (uint32_t i = 0; i < s->best.object_count + s->best.occluder_count; i++) {
        const mini *m = &s->best;
        const occ_box *box =
            i < m->object_count ? &m->objects[i] : &m->occluders[i - m->object_count].box;
        for (int j = 0; j < 3; j++)
            by[j] = -(double)box->center[j];
        moved = s->best;
        mini_move(&moved, by);
        take(s, &moved);
    }
    for (int step = 32; step > 0; step /= 2)
        for (int up = 0; up < 2; up++) {
            moved = s->best;
            mini_scale(&moved, ldexpf(1.0f, up ? step : -step));
            take(s, &moved);
        }
}

// --- the camera ----------------------------------------------------------------------------------

// The same planes, but for rounding, in a matrix whose clip z runs from -w to w.
static void set_default_depth(mini *m)
{
    float *proj = m->camera.frame.proj;
    float sign = m->camera.depth == OCC_DEPTH_ONE_TO_ZERO ? -1.0f : 1.0f;
    for (int c = 0; c < 4 && m->camera.depth != OCC_DEPTH_MINUS_ONE_TO_ONE; c++)
        proj[4 * c + 2] = sign * (2.0f * proj[4 * c + 2] - proj[4 * c + 3]);
    m->camera.depth = OCC_DEPTH_MINUS_ONE_TO_ONE;
}

static void plain_depth(shrinker *s)
{
    mini plain = s->best;
    set_default_depth(&plain);
    take(s, &plain);
}

static void plain_lens(shrinker *s)
{
    static const double nears[] = {1.0, 0.5, 0.0625, 0x1p-10, 0x1p-20, 2.0, 16.0};
    static const double fars[] = {0.0, 2.0, 3.0, 16.0, 1024.0};
    static const double widths[] = {1.0, 0.5, 2.0, 0.125, 0.0625};
    bool orthographic = mini_is_orthographic(&s->best);
    for (int i = 0; i < 7 * 5 * 5; i++) {
        const double scale[2] = {widths[i % 5], widths[i % 5]};
        double near_z = nears[i / 25], far_z = fars[i / 5 % 5];
        if (far_z > 0.0 ? far_z <= near_z : orthographic) continue;
        mini plain = s->best;
        plain.camera.depth = OCC_DEPTH_MINUS_ONE_TO_ONE;
        mini_set_lens(&plain, orthographic, scale, near_z, far_z);
        take(s, &plain);
    }
}

// Straight along each axis, right side up and lying.
static void plain_rows(shrinker *s)
{
    for (int i = 0; i < 12; i++) {
        int most = i % 3, up = (most + 1 + i / 3 % 2) % 3, right = 3 - most - up;
        float rows[3][3] = {{0}}, back = i < 6 ? 1.0f : -1.0f;
        rows[2][most] = back;
        rows[1][up] = 1.0f;
        rows[0][right] = (up + 1) % 3 == most ? back : -back;
        mini plain = s->best;
        mini_set_rows(&plain, (const float(*)[3])rows);
        take(s, &plain);
    }
}

// --- numbers -------------------------------------------------------------------------------------

// What a number may be replaced by, the simplest first. Returns false when there is no more.
static bool simpler(double x, int n, double *y)
{
    static const int digits[] = {1, 2, 3, 4, 6, 8, 11, 14, 17, 20, 22, 23, 24};
    enum { DIGITS = sizeof digits / sizeof *digits };
    int exponent;
    double mantissa = frexp(x, &exponent);
    switch (n) {
    case 0:
        *y = 0.0;
        return true;
    case 1:
        *y = x < 0.0 ? -1.0 : 1.0;
        return true;
    case 2:
        *y = -x;
        return true;
    case 3:
        *y = rint(x);
        return true;
    case 4:
        *y = ldexp(x, exponent > 1 ? -1 : 1); // half way home
        return true;
    case 5:
        *y = 2.0 * mantissa;
        return true;
    default:
        if (n - 6 >= 3 * DIGITS) return false;
        int kept = digits[(n - 6) / 3];
        double scaled = ldexp(mantissa, kept), whole = n % 3 == 0   ? rint(scaled)
                                                       : n % 3 == 1 ? floor(scaled)
                                                                    : ceil(scaled);
        *y = ldexp(whole, exponent - kept);
        return true;
    }
}

static float *number_of_box(occ_box *box, uint32_t j)
{
    return j < 3 ? &box->center[j] : &box->axis[(j - 3) / 3][j % 3];
}

static void simplify_box(shrinker *s, uint32_t i)
{
    for (uint32_t j = 0; j < 12; j++) {
        double y = 0.0;
        for (int n = 0;; n++) {
            mini candidate = s->best;
            occ_box *box = i < candidate.object_count
                               ? &candidate.objects[i]
                               : &candidate.occluders[i - candidate.object_count].box;
            float *number = number_of_box(box, j);
            if (*number == 0.0f || !simpler((double)*number, n, &y)) break;
            *number = (float)y;
            take(s, &candidate);
        }
    }
}

// Axes that are all zero, or a unit of their own.
static void simplify_axes(shrinker *s, uint32_t i)
{
    for (int n = 0; n < 6; n++) {
        mini candidate = s->best;
        occ_box *box = i < candidate.object_count
                           ? &candidate.objects[i]
                           : &candidate.occluders[i - candidate.object_count].box;
        float *axis = box->axis[n / 2];
        float longest = fmaxf(fabsf(axis[0]), fmaxf(fabsf(axis[1]), fabsf(axis[2])));
        memset(axis, 0, 3 * sizeof *axis);
        if (n % 2 == 1) axis[n / 2] = longest;
        take(s, &candidate);
    }
}

static void simplify_eye(shrinker *s)
{
    for (int j = 0; j < 3; j++) {
        double y = 0.0;
        for (int n = 0; s->best.camera.eye[j] != 0.0 && simpler(s->best.camera.eye[j], n, &y);
             n++) {
            mini candidate = s->best;
            double eye[3] = {candidate.camera.eye[0], candidate.camera.eye[1],
                             candidate.camera.eye[2]};
            eye[j] = y;
            mini_set_eye(&candidate, eye);
            take(s, &candidate);
        }
    }
}

static void simplify_matrices(shrinker *s)
{
    for (int i = 0; i < 32; i++) {
        double y = 0.0;
        for (int n = 0;; n++) {
            mini candidate = s->best;
            obs_frame *frame = &candidate.camera.frame;
            float *number = i < 16 ? &frame->proj[i] : &frame->view[i - 16];
            if (i >= 16 && (i % 4 == 3 || i >= 28)) break; // the eye's, and a row of zeros
            if (i < 16 && i % 4 >= 2) break; // the depth and w: plain_lens() knows what is sound
            if (*number == 0.0f || !simpler((double)*number, n, &y)) break;
            *number = (float)y;
            const double eye[3] = {candidate.camera.eye[0], candidate.camera.eye[1],
                                   candidate.camera.eye[2]};
            if (i >= 16) mini_set_eye(&candidate, eye);
            take(s, &candidate);
        }
    }
}

// All numbers of all boxes on one coarser grid, and the eye with them.
static void coarsen(shrinker *s)
{
    for (int power = -24; power <= 24; power++) {
        mini candidate = s->best;
        float unit = ldexpf(1.0f, -power);
        double eye[3];
        for (int j = 0; j < 3; j++)
            eye[j] = rint(candidate.camera.eye[j] / (double)unit) * (double)unit;
        for (uint32_t i = 0; i < candidate.object_count + candidate.occluder_count; i++)
            for (uint32_t j = 0; j < 12; j++) {
                float *number =
                    i < candidate.object_count
                        ? number_of_box(&candidate.objects[i], j)
                        : number_of_box(&candidate.occluders[i - candidate.object_count].box, j);
                *number = rintf(*number / unit) * unit;
            }
        mini_set_eye(&candidate, eye);
        if (take(s, &candidate)) return;
    }
}

// --- all of it -----------------------------------------------------------------------------------

unsigned mini_shrink(mini *m, mini_predicate *fails, void *context)
{
    shrinker s = {.best = *m, .cost = mini_cost(m), .fails = fails, .context = context};
    uint64_t before;
    do {
        before = s.cost;
        drop_objects(&s);
        drop_occluders(&s);
        plain_depth(&s);
        plain_lens(&s);
        plain_rows(&s);
        bring_home(&s);
        coarsen(&s);
        for (uint32_t i = 0; i < s.best.object_count + s.best.occluder_count; i++) {
            simplify_axes(&s, i);
            simplify_box(&s, i);
        }
        simplify_eye(&s);
        simplify_matrices(&s);
    } while (s.cost < before);
    *m = s.best;
    return s.asked;
}

static void keep_if(mini *m, const mini *candidate, mini_predicate *fails, void *context)
{
    if (fails(candidate, context)) *m = *candidate;
}

const char *mini_shrink_for_file(mini *m, mini_predicate *fails, void *context)
{
    mini candidate = *m;
    set_default_depth(&candidate);
    keep_if(m, &candidate, fails, context);
    for (int way = 0; way < 2 && mini_not_for_files(m); way++) {
        candidate = *m;
        if (way == 0) {
            double eye[3];
            for (int j = 0; j < 3; j++)
                eye[j] = (double)candidate.camera.frame.eye[j];
            mini_set_eye(&candidate, eye);
        } else {
            candidate.camera.eye_given = false;
        }
        keep_if(m, &candidate, fails, context);
    }
    candidate = *m;
    mini_embody(&candidate);
    keep_if(m, &candidate, fails, context);
    return mini_not_for_files(m);
}
