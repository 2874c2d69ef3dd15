// SPDX-License-Identifier: Apache-2.0
// Random mini worlds. Most numbers come from a small grid, and most boxes are made from others: as
// copies, mirrored, next to each other, behind each other as seen from the eye. So what random
// numbers never do happens all the time here: planes through the eye, shared edges, equal
// distances, objects that fill a shadow to the last bit.
#include "mini.h"

#include <math.h>

typedef struct maker {
    kit_random random;
    mini *m;
    double eye[3];
    bool orthographic;
    int reach; // of the grid
} maker;

static bool one_in(maker *k, uint32_t n)
{
    return kit_below(&k->random, n) == 0;
}

static float grid(maker *k, int reach)
{
    return (float)((int)kit_below(&k->random, 2u * (uint32_t)reach + 1u) - reach);
}

// --- boxes ---------------------------------------------------------------------------------------

static occ_box grid_box(maker *k)
{
    occ_box box = {{0}, {{0}}};
    bool aligned = !one_in(k, 3);
    float unit = one_in(k, 2) ? 1.0f : 0.5f;
    for (int j = 0; j < 3; j++) {
        box.center[j] = one_in(k, 12) ? kit_between(&k->random, -3, 3) : grid(k, k->reach);
        for (int i = 0; i < 3; i++)
            if (!aligned || i == j) box.axis[i][j] = unit * grid(k, 2);
    }
    return box;
}

static occ_box shaped_box(maker *k)
{
    double center[3];
    for (int j = 0; j < 3; j++)
        center[j] = one_in(k, 2) ? (double)grid(k, k->reach)
                                 : world_between(&k->random, -k->reach, k->reach);
    world_shape shape = (world_shape)kit_below(&k->random, WORLD_SHAPES);
    return world_box(&k->random, shape, center, world_scale(&k->random, 0.25, 4));
}

// Any box that is there already.
static const occ_box *any_box(maker *k)
{
    const mini *m = k->m;
    uint32_t total = m->object_count + m->occluder_count;
    if (!total) return NULL;
    uint32_t i = kit_below(&k->random, total);
    return i < m->object_count ? &m->objects[i] : &m->occluders[i - m->object_count].box;
}

static void add_axis(occ_box *box, const float axis[3], float times)
{
    for (int j = 0; j < 3; j++)
        box->center[j] += times * axis[j];
}

static void scale_axis(occ_box *box, uint32_t i, float times)
{
    for (int j = 0; j < 3; j++)
        box->axis[i][j] *= times;
}

// The same box with its axes in other places or turned about: the same points.
static void rename_axes(maker *k, occ_box *box)
{
    uint32_t turn = kit_below(&k->random, 3);
    occ_box old = *box;
    for (uint32_t i = 0; i < 3; i++) {
        float sign = one_in(k, 2) ? -1.0f : 1.0f;
        for (int j = 0; j < 3; j++)
            box->axis[i][j] = sign * old.axis[(i + turn) % 3][j];
    }
}

// A neighbour that shares a face, an edge or a corner with it, or a part of it.
static void shift_along_axes(maker *k, occ_box *box)
{
    bool inside = one_in(k, 3);
    uint32_t first = kit_below(&k->random, 3), axes = 1 + kit_below(&k->random, 3);
    for (uint32_t n = 0; n < axes; n++) {
        uint32_t i = (first + n) % 3;
        if (inside) scale_axis(box, i, 0.5f);
        float side = one_in(k, 2) ? -1.0f : 1.0f;
        add_axis(box, box->axis[i], inside ? side : 2.0f * side);
    }
}

static occ_box related_box(maker *k, const occ_box *other)
{
    occ_box box = *other;
    uint32_t i = kit_below(&k->random, 3);
    switch (kit_below(&k->random, 6)) {
    case 0:
        break; // a copy
    case 1:
        rename_axes(k, &box);
        break;
    case 2:
    case 3:
        shift_along_axes(k, &box);
        break;
    case 4: // one of its faces
        add_axis(&box, other->axis[i], one_in(k, 2) ? -1.0f : 1.0f);
        scale_axis(&box, i, 0.0f);
        break;
    default: // smaller or larger about the same middle
        for (uint32_t n = 0; n < 3; n++)
            scale_axis(&box, n, one_in(k, 3) ? 2.0f : one_in(k, 2) ? 0.5f : 0.9f);
    }
    return box;
}

// What fills the other's shadow from one of its distances on: all of it, nearly, or a bit more.
static occ_box shadowed_box(maker *k, const occ_box *other)
{
    static const double distances[] = {1.0, 1.5, 2.0, 2.0, 3.0, 4.0, 16.0, 1000.0};
    bool is_far =
        fabsf(other->center[0]) + fabsf(other->center[1]) + fabsf(other->center[2]) > 1e5f;
    double far_off = distances[kit_below(&k->random, is_far ? 3 : 8)], fill = 1.0;
    double bend = exp2(-1.0 - (double)kit_below(&k->random, 24));
    if (!one_in(k, 4)) fill = one_in(k, 4) ? 1.0 + bend : 1.0 - bend;
    const float *view = k->m->camera.frame.view;
    occ_box box;
    for (int j = 0; j < 3; j++) {
        double c = (double)other->center[j];
        box.center[j] = (float)(k->eye[j] + far_off * (c - k->eye[j]));
        if (k->orthographic) box.center[j] = (float)(c - far_off * 2.0 * (double)view[4 * j + 2]);
        for (int i = 0; i < 3; i++) {
            double a = fill * (double)other->axis[i][j];
            box.axis[i][j] = (float)(k->orthographic ? a : a * far_off);
        }
    }
    if (one_in(k, 3)) scale_axis(&box, kit_below(&k->random, 3), one_in(k, 2) ? 0.5f : 0.0f);
    return box;
}

static occ_box any_new_box(maker *k, bool behind)
{
    const occ_box *other = any_box(k);
    if (other && behind && !one_in(k, 3)) return shadowed_box(k, other);
    if (other && one_in(k, 2)) return related_box(k, other);
    return one_in(k, 4) ? shaped_box(k) : grid_box(k);
}

// --- the camera ----------------------------------------------------------------------------------

// On the grid; or, of some box, in the plane of a face, on the line of an edge, in a corner or in
// the middle.
static void place_eye(maker *k)
{
    const occ_box *box = any_box(k);
    uint32_t level = kit_below(&k->random, 5), turn = kit_below(&k->random, 3);
    for (int j = 0; j < 3; j++)
        k->eye[j] = (double)grid(k, 3 * k->reach);
    if (!box || level == 0) return;
    for (int j = 0; j < 3; j++)
        k->eye[j] = (double)box->center[j];
    for (uint32_t i = 0; i < 3; i++) {
        double times = i < level - 1 ? 1.0 : 0.25 * (double)grid(k, 24);
        if (level == 4 && one_in(k, 3)) times = 0.0;
        if (one_in(k, 2)) times = -times;
        for (int j = 0; j < 3; j++)
            k->eye[j] += times * (double)box->axis[(i + turn) % 3][j];
    }
    for (int j = 0; j < 3; j++) // a float, most of the time
        if (!one_in(k, 8)) k->eye[j] = (double)(float)k->eye[j];
}

// Along an axis, the one that leads to the target best; or straight at it.
static void look_at(maker *k, const double target[3])
{
    static const double corner[3] = {1, 1, 1};
    double ahead[3];
    int most = 0;
    for (int j = 0; j < 3; j++) {
        ahead[j] = target[j] - k->eye[j];
        if (fabs(ahead[j]) > fabs(ahead[most])) most = j;
    }
    if (ahead[most] == 0.0) ahead[most] = -1.0;
    mini *m = k->m;
    for (int j = 0; j < 3; j++)
        m->camera.eye[j] = k->eye[j];
    float rows[3][3] = {{0}};
    if (one_in(k, 3)) {
        obs_frame look = obs_look(k->eye, one_in(k, 8) ? corner : ahead, 1, 1, 1, 2);
        for (int i = 0; i < 9; i++)
            rows[i / 3][i % 3] = look.view[4 * (i % 3) + i / 3];
    } else { // back, up and right are signed axes
        int up = (most + 1 + (int)kit_below(&k->random, 2)) % 3, right = 3 - most - up;
        float back = ahead[most] > 0.0 ? -1.0f : 1.0f, sign = one_in(k, 2) ? -1.0f : 1.0f;
        bool cyclic = (up + 1) % 3 == most; // right x up = back
        rows[2][most] = back;
        rows[1][up] = sign;
        rows[0][right] = cyclic ? sign * back : -sign * back;
    }
    mini_set_rows(m, (const float(*)[3])rows);
}

static void set_lens(maker *k)
{
    static const double nears[] = {0.0625, 0.1, 1.0, 0x1p-10, 3.0};
    static const double fars[] = {0.0, 1000.0, 16.0, 64.0, 1e5};
    static const double wides[] = {1.0, 1.7320508, 0.5, 2.0};
    double wide = wides[kit_below(&k->random, 4)] * (k->orthographic ? 0.125 : 1.0);
    const double scale[2] = {one_in(k, 2) ? wide : wide * 9.0 / 16.0, wide};
    uint32_t distance = kit_below(&k->random, 5);
    if (k->orthographic && distance == 0) distance = 1;
    mini_camera *camera = &k->m->camera;
    camera->depth = one_in(k, 2) ? (occ_depth)kit_below(&k->random, 3) : OCC_DEPTH_MINUS_ONE_TO_ONE;
    camera->eye_given = one_in(k, 2);
    mini_set_lens(k->m, k->orthographic, scale, nears[kit_below(&k->random, 5)], fars[distance]);
    if (!k->orthographic && one_in(k, 6)) { // off-centre, or jittered
        camera->frame.proj[8] = kit_between(&k->random, -0.5f, 0.5f);
        camera->frame.proj[9] = one_in(k, 2) ? 0.25f / 540.0f : 0.5f;
    }
}

// --- worlds --------------------------------------------------------------------------------------

static void make_camera(maker *k)
{
    const occ_box *box = any_box(k);
    double target[3];
    place_eye(k);
    for (int j = 0; j < 3; j++)
        target[j] = box && !one_in(k, 8) ? (double)box->center[j] : (double)grid(k, k->reach);
    k->orthographic = one_in(k, 5);
    look_at(k, target);
    set_lens(k);
}

// Small numbers more often than large ones.
static uint32_t some(maker *k, uint32_t most)
{
    return 1 + kit_below(&k->random, 1 + kit_below(&k->random, most));
}

static void give_owners(maker *k)
{
    mini *m = k->m;
    for (uint32_t i = 0; i < m->occluder_count; i++) {
        if (one_in(k, 2)) continue;
        int owner = (int)kit_below(&k->random, m->object_count);
        m->occluders[i].owner = owner;
        if (one_in(k, 3)) m->objects[owner] = m->occluders[i].box;
    }
}

// A float here and there is the next one.
static void nudge(maker *k)
{
    mini *m = k->m;
    for (uint32_t n = some(k, 6); n > 0; n--) {
        uint32_t i = kit_below(&k->random, m->object_count + m->occluder_count);
        occ_box *box =
            i < m->object_count ? &m->objects[i] : &m->occluders[i - m->object_count].box;
        uint32_t j = kit_below(&k->random, 12);
        float *number = j < 3 ? &box->center[j] : &box->axis[(j - 3) / 3][j % 3];
        float to = one_in(k, 2) ? -INFINITY : INFINITY;
        if (*number != 0.0f) *number = nextafterf(*number, to);
    }
}

static void put_elsewhere(maker *k)
{
    double by[3];
    double step = exp2((double)kit_below(&k->random, 21));
    for (int j = 0; j < 3; j++)
        by[j] = step * (double)grid(k, 2);
    if (one_in(k, 4)) mini_move(k->m, by);
    if (one_in(k, 3)) mini_scale(k->m, exp2f(grid(k, 20)));
}

void mini_make(mini *m, uint64_t seed)
{
    maker k = {.random = {seed * 0x9e3779b97f4a7c15u + 1}, .m = m};
    kit_next(&k.random);
    *m = (mini){.object_count = 0};
    k.reach = 1 << kit_below(&k.random, 4);
    uint32_t occluders = some(&k, MINI_OCCLUDERS), objects = some(&k, 24);
    for (uint32_t i = 0; i < occluders; i++) {
        m->occluders[i] = (world_occluder){any_new_box(&k, false), -1};
        m->occluder_count++;
        if (i == 0 || one_in(&k, 4)) make_camera(&k); // what comes later knows an eye
    }
    for (uint32_t i = 0; i < objects; i++) {
        m->objects[i] = any_new_box(&k, true);
        m->object_count++;
    }
    give_owners(&k);
    if (one_in(&k, 3)) nudge(&k);
    put_elsewhere(&k);
}
