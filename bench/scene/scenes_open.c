// SPDX-License-Identifier: Apache-2.0
// The scenes under the open sky. Random numbers are drawn one to a statement: C leaves the order of
// calls within an expression open.
#include "scenes.h"

#include "steady.h"

#include <math.h>

#define PI 3.14159265358979323846

static const double COTANGENT_60 = 1.7320508075688772935; // of half of 60 degrees
static const double WIDE = 16.0 / 9.0;
enum { PATH_FRAMES = 60 };

static void add_view(obs_scene *scene, const double *eye, const double *direction, double near_z,
                     double far_z)
{
    obs_frame frame = obs_look(eye, direction, COTANGENT_60, WIDE, near_z, far_z);
    obs_add_frame(scene, &frame);
}

// --- seedscene -----------------------------------------------------------------------------------

void scenes_seedscene(obs_scene *scene, uint32_t count, uint64_t seed)
{
    steady_random random = steady_seed(seed, "seedscene");
    const double inscribed = 1 / sqrt(3.0); // the cube inside a unit sphere
    for (uint32_t i = 0; i < count; i++) {
        double radius = steady_between(&random, 1, 10);
        double x = steady_between(&random, 0, 100);
        double y = steady_between(&random, 0, 100);
        double z = steady_between(&random, 0, 100);
        occ_box box = scenes_box(x, y, z, radius, radius, radius);
        uint32_t owner = obs_add_object(scene, &box);
        occ_box inner = scenes_shrunk(&box, inscribed, inscribed, inscribed);
        obs_add_occluder(scene, &inner, owner);
    }
    const double eye[3] = {0, 0, 0}, diagonal[3] = {1, 1, 1};
    add_view(scene, eye, diagonal, 0.1, 400);
}

// --- city ----------------------------------------------------------------------------------------

enum { TOWERS_A_SIDE = 3, FURNITURE_A_BLOCK = 31, OBJECTS_A_BLOCK = 40 };
static const double BLOCK = 60, STREET = 20, PITCH = 80;

static void add_tower(obs_scene *scene, steady_random *random, double x, double z)
{
    const double plot = BLOCK / TOWERS_A_SIDE;
    double height = steady_between(random, 6, 45);
    if (steady_unit(random) < 0.1) height *= 3; // a high-rise
    double width = plot * steady_between(random, 0.8, 1);
    double depth = plot * steady_between(random, 0.8, 1);
    occ_box box = scenes_box(x, height / 2, z, width / 2, height / 2, depth / 2);
    box = scenes_turned(&box, steady_between(random, -0.05, 0.05));
    uint32_t owner = obs_add_object(scene, &box);
    occ_box inner = scenes_shrunk(&box, 0.95, 0.97, 0.95);
    obs_add_occluder(scene, &inner, owner);
}

// Half of the things stand in the street west of the block, half anywhere on it or around.
static void add_street_furniture(obs_scene *scene, steady_random *random, double x, double z)
{
    bool on_street = steady_unit(random) < 0.5;
    x += on_street ? steady_between(random, -STREET, 0) : steady_between(random, 0, PITCH);
    z += steady_between(random, -STREET, PITCH);
    double height = steady_between(random, 0.3, 2);
    double width = height * steady_between(random, 0.3, 1);
    double depth = height * steady_between(random, 0.3, 1);
    occ_box box = scenes_box(x, height / 2, z, width, height / 2, depth);
    box = scenes_turned(&box, steady_between(random, 0, 2 * PI));
    uint32_t owner = obs_add_object(scene, &box);
    if (steady_unit(random) >= 0.3) return; // most of it is not solid
    occ_box inner = scenes_shrunk(&box, 0.7, 0.7, 0.7);
    obs_add_occluder(scene, &inner, owner);
}

static void add_block(obs_scene *scene, steady_random *random, double x, double z)
{
    const double plot = BLOCK / TOWERS_A_SIDE;
    for (int i = 0; i < TOWERS_A_SIDE; i++)
        for (int j = 0; j < TOWERS_A_SIDE; j++)
            add_tower(scene, random, x + (i + 0.5) * plot, z + (j + 0.5) * plot);
    for (int i = 0; i < FURNITURE_A_BLOCK; i++)
        add_street_furniture(scene, random, x, z);
}

void scenes_city(obs_scene *scene, uint32_t count, uint64_t seed)
{
    steady_random random = steady_seed(seed, "city");
    int side = (int)ceil(sqrt((double)count / OBJECTS_A_BLOCK));
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++)
            add_block(scene, &random, i * PITCH, j * PITCH);

    double length = side * PITCH;
    occ_box ground = scenes_box(length / 2, -0.5, length / 2, length, 0.5, length);
    obs_add_occluder(scene, &ground, obs_add_object(scene, &ground));

    int before = side / 2; // blocks west of the street that the path follows
    double middle = before * PITCH - STREET / 2;
    for (int i = 0; i < PATH_FRAMES; i++) {
        double t = (double)i / PATH_FRAMES, yaw = 0.6 * steady_sin(12 * t);
        const double eye[3] = {middle + 2 * steady_sin(9 * t), 1.7, length * (0.1 + 0.8 * t)};
        const double direction[3] = {steady_sin(yaw), 0.02, steady_cos(yaw)};
        add_view(scene, eye, direction, 0.1, 5000);
    }
}

// --- forest --------------------------------------------------------------------------------------

static void add_tree(obs_scene *scene, steady_random *random, double length)
{
    double x = steady_between(random, 0, length);
    double z = steady_between(random, 0, length);
    double height = steady_between(random, 5, 15);
    double trunk = steady_between(random, 0.15, 0.5);
    double crown = steady_between(random, 1, 2.5);
    double angle = steady_between(random, 0, 2 * PI);
    occ_box box = scenes_box(x, height / 2, z, crown, height / 2, crown);
    box = scenes_turned(&box, angle);
    uint32_t owner = obs_add_object(scene, &box);
    occ_box inner = scenes_shrunk(&box, trunk / crown, 0.9, trunk / crown);
    obs_add_occluder(scene, &inner, owner);
}

void scenes_forest(obs_scene *scene, uint32_t count, uint64_t seed)
{
    steady_random random = steady_seed(seed, "forest");
    double length = 3 * sqrt((double)count); // nine square metres a tree
    for (uint32_t i = 0; i < count; i++)
        add_tree(scene, &random, length);
    for (int i = 0; i < PATH_FRAMES; i++) {
        double t = (double)i / PATH_FRAMES;
        const double eye[3] = {length * (0.1 + 0.8 * t), 1.7, length / 2};
        const double direction[3] = {steady_cos(3 * t), 0, steady_sin(3 * t)};
        add_view(scene, eye, direction, 0.1, 2000);
    }
}

// --- soup ----------------------------------------------------------------------------------------

// A uniformly random attitude: a point of the unit 4-ball, taken as a quaternion.
static void random_attitude(steady_random *random, double rows[3][3])
{
    double q[4], length;
    do {
        length = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = steady_between(random, -1, 1);
            length += q[k] * q[k];
        }
    } while (length > 1 || length < 1e-6);
    double s = 2 / length, x = q[0], y = q[1], z = q[2], w = q[3];
    rows[0][0] = 1 - s * (y * y + z * z);
    rows[0][1] = s * (x * y + z * w);
    rows[0][2] = s * (x * z - y * w);
    rows[1][0] = s * (x * y - z * w);
    rows[1][1] = 1 - s * (x * x + z * z);
    rows[1][2] = s * (y * z + x * w);
    rows[2][0] = s * (x * z + y * w);
    rows[2][1] = s * (y * z - x * w);
    rows[2][2] = 1 - s * (x * x + y * y);
}

static void add_floating_box(obs_scene *scene, steady_random *random, double length)
{
    const double log_20 = 2.9957322735539909934;
    occ_box box;
    double half[3], rows[3][3];
    for (int k = 0; k < 3; k++) {
        box.center[k] = (float)steady_between(random, 0, length);
        half[k] = 0.2 * steady_exp(log_20 * steady_unit(random)); // 0.2 to 4, as likely small
    }
    random_attitude(random, rows);
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            box.axis[k][j] = (float)(half[k] * rows[k][j]);
    uint32_t owner = obs_add_object(scene, &box);
    occ_box inner = scenes_shrunk(&box, 0.9, 0.9, 0.9);
    obs_add_occluder(scene, &inner, owner);
}

void scenes_soup(obs_scene *scene, uint32_t count, uint64_t seed)
{
    steady_random random = steady_seed(seed, "soup");
    double length = 4 * steady_cbrt((double)count); // 64 cubic metres a box
    for (uint32_t i = 0; i < count; i++)
        add_floating_box(scene, &random, length);
    for (int i = 0; i < PATH_FRAMES; i++) {
        double angle = 2 * PI * i / PATH_FRAMES;
        double across = 0.1 * length * steady_cos(angle), along = 0.1 * length * steady_sin(angle);
        const double eye[3] = {length / 2 + across, length / 2, length / 2 + along};
        const double direction[3] = {steady_cos(2 * angle), 0.2 * steady_sin(angle),
                                     steady_sin(2 * angle)};
        add_view(scene, eye, direction, 0.1, 4 * length);
    }
}
