// SPDX-License-Identifier: Apache-2.0
#include "stage.h"

#include <math.h>
#include <string.h>

// --- numbers -------------------------------------------------------------------------------------

bool stage_chance(stage *s, uint32_t count)
{
    return steady_below(&s->random, count) == 0;
}

double stage_draw(stage *s, stage_range range)
{
    double steps = floor((range.high - range.low) / range.step + 0.5);
    return range.low + range.step * steady_below(&s->random, (uint32_t)steps + 1u);
}

double stage_whole(stage *s, int low, int high)
{
    return stage_draw(s, stage_ones(low, high));
}

double stage_part(stage *s, double low, double high)
{
    return stage_draw(s, stage_parts(low, high));
}

double stage_sign(stage *s)
{
    return stage_chance(s, 2) ? 1.0 : -1.0;
}

double stage_signed(stage *s, int low, int high)
{
    double sign = stage_sign(s);
    return sign * stage_whole(s, low, high);
}

double stage_sliver(stage *s, int least, int most)
{
    double sign = stage_sign(s);
    return ldexp(sign, -(int)stage_whole(s, least, most));
}

void stage_point(stage *s, stage_range x, stage_range y, stage_range z, double out[3])
{
    out[0] = stage_draw(s, x);
    out[1] = stage_draw(s, y);
    out[2] = stage_draw(s, z);
}

// --- the place -----------------------------------------------------------------------------------

// The rotation of a quaternion of whole numbers, times its squared length.
static double turn_by(const double q[4], double turn[3][3])
{
    double w = q[0], x = q[1], y = q[2], z = q[3];
    double rows[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                         {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                         {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    memcpy(turn, rows, sizeof rows);
    return w * w + x * x + y * y + z * z;
}

// A third as it is, a third turned by right angles, a third by angles whose sines are fractions.
static double draw_turn(stage *s)
{
    static const double right[6][4] = {{1, 1, 0, 0}, {1, 0, 1, 0}, {1, 0, 0, 1},
                                       {1, 1, 1, 1}, {0, 1, 1, 0}, {0, 0, 1, 0}};
    double q[4] = {1, 0, 0, 0};
    uint32_t kind = steady_below(&s->random, 3);
    if (kind == 1) memcpy(q, right[steady_below(&s->random, 6)], sizeof q);
    for (double squared = 0; kind == 2 && (squared < 1 || squared > 9);) {
        squared = 0;
        for (int i = 0; i < 4; i++) {
            q[i] = stage_whole(s, -2, 2);
            squared += q[i] * q[i];
        }
    }
    return turn_by(q, s->turn);
}

void stage_begin(stage *s, family_world *world, const family_place *place, const char *name)
{
    memset(world, 0, sizeof *world);
    *s = (stage){.world = world, .random = steady_seed(place->seed, name)};
    double factor = draw_turn(s);
    s->unit = world_few_bits(place->scale / factor, 8);
    s->length = s->unit * factor;
    uint32_t largest = steady_below(&s->random, 3);
    for (uint32_t j = 0; j < 3; j++) {
        double part = j == largest ? 1.0 : 0.25 * stage_whole(s, 0, 3);
        s->place[j] = world_few_bits(place->offset, 8) * part * stage_sign(s);
    }
    s->back[2] = 1.0;
}

void stage_carry(const stage *s, const double local[3], double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = s->unit *
                 (s->turn[j][0] * local[0] + s->turn[j][1] * local[1] + s->turn[j][2] * local[2]);
}

static void nudge(stage *s, float *number)
{
    if (stage_chance(s, 8)) *number = nextafterf(*number, stage_chance(s, 2) ? 1e16f : -1e16f);
}

static void nudge_box(stage *s, occ_box *box)
{
    for (int j = 0; j < 3; j++) {
        nudge(s, &box->center[j]);
        for (int k = 0; k < 3; k++)
            nudge(s, &box->axis[k][j]);
    }
}

void stage_end(stage *s)
{
    if (!stage_chance(s, 4)) return;
    for (uint32_t i = 0; i < s->world->object_count; i++)
        nudge_box(s, &s->world->objects[i]);
    for (uint32_t i = 0; i < s->world->occluder_count; i++)
        nudge_box(s, &s->world->occluders[i].box);
    for (uint32_t i = 0; i < s->world->sheet_count; i++) {
        occ_sheet *sheet = &s->world->sheets[i].sheet;
        for (uint32_t c = 0; c < 3 * sheet->corner_count; c++)
            nudge(s, &sheet->corner[c / 3][c % 3]);
    }
}

// --- boxes ---------------------------------------------------------------------------------------

stage_box stage_brick(double x, double y, double z, double a, double b, double c)
{
    return (stage_box){{x, y, z}, {{a, 0, 0}, {0, b, 0}, {0, 0, c}}};
}

stage_box stage_any_brick(stage *s, stage_range x, stage_range y, stage_range z, stage_range a,
                          stage_range b, stage_range c)
{
    double center[3], half[3];
    stage_point(s, x, y, z, center);
    stage_point(s, a, b, c, half);
    return stage_brick(center[0], center[1], center[2], half[0], half[1], half[2]);
}

stage_box stage_any(stage *s, world_shape shape, const double center[3], double size)
{
    if (shape == WORLD_SHAPES) shape = (world_shape)steady_below(&s->random, WORLD_SHAPES);
    occ_box made = world_box(&s->random, shape, center, size);
    stage_box box;
    for (int j = 0; j < 3; j++) {
        box.center[j] = (double)made.center[j];
        for (int k = 0; k < 3; k++)
            box.axis[k][j] = (double)made.axis[k][j];
    }
    return box;
}

void stage_corner(const stage_box *box, unsigned corner, double out[3])
{
    for (int j = 0; j < 3; j++) {
        out[j] = box->center[j];
        for (int k = 0; k < 3; k++)
            out[j] += (corner >> k & 1u ? 1.0 : -1.0) * box->axis[k][j];
    }
}

static occ_box placed(const stage *s, const stage_box *box)
{
    occ_box out;
    double v[3];
    stage_carry(s, box->center, v);
    for (int j = 0; j < 3; j++)
        out.center[j] = (float)(s->place[j] + v[j]);
    for (int k = 0; k < 3; k++) {
        stage_carry(s, box->axis[k], v);
        for (int j = 0; j < 3; j++)
            out.axis[k][j] = (float)v[j];
    }
    return out;
}

int stage_object(stage *s, stage_box box)
{
    if (s->world->object_count == FAMILY_OBJECTS) return -1;
    s->world->objects[s->world->object_count] = placed(s, &box);
    return (int)s->world->object_count++;
}

int stage_occluder(stage *s, stage_box box, int owner)
{
    uint32_t i = s->world->occluder_count;
    if (i == FAMILY_OCCLUDERS) return -1;
    s->occluders[i] = box;
    s->world->occluders[i] = (world_occluder){placed(s, &box), owner};
    return (int)s->world->occluder_count++;
}

// --- the camera ----------------------------------------------------------------------------------

world_lens stage_lens(stage *s)
{
    static const float nears[] = {0x1p-4f, 0x1p-10f, 0.1f}, fars[] = {0x1p10f, 200.0f, 1e5f};
    world_lens lens = {.depth = (occ_depth)steady_below(&s->random, 3)};
    if (stage_chance(s, 2)) lens.projection = (world_projection)steady_below(&s->random, 5);
    lens.near_z = nears[steady_below(&s->random, 3)];
    lens.far_z = fars[steady_below(&s->random, 3)];
    lens.height = (float)world_between(&s->random, 0.5, 2.0);
    if (lens.projection == WORLD_ORTHOGRAPHIC) lens.height *= 20.0f;
    return lens;
}

// Rows of the rotation from the stage to the camera.
static void view_rows(const double eye[3], const double target[3], double row[3][3])
{
    memset(row, 0, 3 * sizeof *row);
    row[0][0] = row[1][1] = row[2][2] = 1.0;
    if (!target) return;
    double flat, length;
    for (int j = 0; j < 3; j++)
        row[2][j] = eye[j] - target[j];
    flat = sqrt(row[2][0] * row[2][0] + row[2][2] * row[2][2]);
    length = sqrt(flat * flat + row[2][1] * row[2][1]);
    if (!(flat > 1e-9 * length)) { // straight up or down
        row[2][0] = row[2][2] = 0.0;
        row[2][1] = row[2][1] < 0.0 ? -1.0 : 1.0;
        row[1][1] = 0.0;
        row[1][2] = -row[2][1];
        return;
    }
    row[0][0] = row[2][2] / flat;
    row[0][2] = -row[2][0] / flat;
    for (int j = 0; j < 3; j++)
        row[2][j] /= length;
    row[1][0] = row[2][1] * row[0][2];
    row[1][1] = row[2][2] * row[0][0] - row[2][0] * row[0][2];
    row[1][2] = -row[2][1] * row[0][0];
}

// The same rows in the world, times the turn's factor: exact where the rows are.
static void carry_rows(const stage *s, double local[3][3], double out[3][3])
{
    for (int r = 0; r < 3; r++)
        for (int j = 0; j < 3; j++)
            out[r][j] = s->turn[j][0] * local[r][0] + s->turn[j][1] * local[r][1] +
                        s->turn[j][2] * local[r][2];
}

// What a scene file would hold: a rotation, a translation and a projection of their own.
static void set_parts(stage *s, double row[3][3], double clip[4][4], const double eye[3])
{
    family_world *world = s->world;
    double factor = s->length / s->unit;
    for (int r = 0; r < 4; r++) {
        double along = 0.0;
        for (int j = 0; j < 3; j++) {
            world->view[4 * j + r] = r < 3 ? (float)(row[r][j] / factor) : 0.0f;
            if (r < 3) along -= row[r][j] / factor * eye[j];
        }
        world->view[12 + r] = r < 3 ? (float)along : 1.0f;
        for (int c = 0; c < 4; c++)
            world->proj[4 * c + r] = (float)clip[r][c];
    }
}

// Rows times columns; where the matrix counts from `from`, the eye is at `eye` - `from`.
static void set_matrix(stage *s, double row[3][3], double clip[4][4], const double at[3])
{
    double factor = s->length / s->unit;
    float *m = s->world->camera.view_projection;
    for (int r = 0; r < 4; r++) {
        double constant = factor * clip[r][3];
        for (int j = 0; j < 3; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++)
                sum += clip[r][k] * row[k][j];
            m[4 * j + r] = (float)sum;
            constant -= sum * at[j];
        }
        m[12 + r] = (float)constant;
    }
}

// Lengths to world units, and the numbers that the side planes are made of to eight bits.
static void clip_rows(const stage *s, const world_lens *lens, double clip[4][4])
{
    world_lens scaled = *lens;
    scaled.near_z = (float)((double)lens->near_z * s->length);
    scaled.far_z = (float)((double)lens->far_z * s->length);
    if (s->parallel) scaled.height = (float)((double)lens->height * s->length);
    world_project(&scaled, clip);
    clip[0][0] = world_few_bits(clip[0][0], 8);
    clip[1][1] = world_few_bits(clip[1][1], 8);
}

void stage_look(stage *s, const double eye[3], const double target[3], const world_lens *lens)
{
    double local[3][3], row[3][3], clip[4][4], at[3];
    family_world *world = s->world;
    s->parallel = lens->projection == WORLD_ORTHOGRAPHIC;
    memcpy(s->eye, eye, sizeof s->eye);
    view_rows(eye, target, local);
    memcpy(s->back, local[2], sizeof s->back);
    carry_rows(s, local, row);
    clip_rows(s, lens, clip);
    stage_carry(s, eye, at);
    for (int j = 0; j < 3; j++)
        world->eye[j] = s->place[j] + at[j];
    world->camera = (occ_camera_desc){.depth = lens->depth};

    // A matrix without translation that counts from the eye, or one that counts from the world's
    // origin; the eye given, or left to be derived from it.
    bool from_eye = !stage_chance(
        s, s->place[0] * s->place[0] + s->place[1] * s->place[1] + s->place[2] * s->place[2] > 0.0
               ? 4
               : 2);
    if (from_eye) {
        memcpy(world->origin, world->eye, sizeof world->origin);
        world->camera.origin = world->origin;
    }
    if (!stage_chance(s, 4)) world->camera.eye = world->eye;
    const double zero[3] = {0, 0, 0};
    set_matrix(s, row, clip, from_eye ? zero : world->eye);
    set_parts(s, row, clip, world->eye);
}

void stage_look_about(stage *s, double aside, const world_lens *lens)
{
    const stage_range near_by = stage_ones(-2, 2), about = stage_parts(-aside, aside);
    double eye[3], target[3];
    stage_point(s, near_by, near_by, near_by, eye);
    stage_point(s, about, about, stage_just(-16), target);
    for (int j = 0; j < 3; j++)
        target[j] += eye[j];
    stage_look(s, eye, stage_chance(s, 2) ? target : NULL, lens);
}
