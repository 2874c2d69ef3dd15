// SPDX-License-Identifier: Apache-2.0
#include "interior_furniture.h"

#include "scenes.h"

#include <math.h>

enum { PIECES_A_ROOM = 12, TRIES = 12 };
static const double AISLE = 0.45; // half the width of the free way to a door

// Ranges of half width, half depth and height, and the solid part within: from `low` to `high` of
// the height, `solid` of width and depth. Nothing of a piece with `solid` 0 is opaque throughout.
typedef struct furniture_kind {
    double width[2], depth[2], height[2];
    double low, high, solid;
} furniture_kind;

static const furniture_kind furniture_kinds[] = {
    {{0.30, 0.60}, {0.20, 0.30}, {1.80, 2.30}, 0.04, 0.97, 0.93}, // cupboard
    {{0.50, 0.80}, {0.35, 0.50}, {0.70, 0.78}, 0.95, 0.99, 0.96}, // table: its top
    {{0.20, 0.25}, {0.20, 0.25}, {0.80, 1.00}, 0, 0, 0},          // chair
    {{0.70, 1.00}, {0.38, 0.45}, {0.75, 0.90}, 0.10, 0.50, 0.92}, // sofa: its seat
    {{0.40, 0.70}, {0.16, 0.22}, {0.80, 1.40}, 0.05, 0.96, 0.93}, // chest of drawers
    {{0.08, 0.20}, {0.08, 0.20}, {0.30, 1.60}, 0, 0, 0},          // lamp, bin, plant
};
enum { FURNITURE_KINDS = sizeof furniture_kinds / sizeof *furniture_kinds };

typedef struct interior_room {
    double x, z, floor;             // the middle
    double ways[4][2];              // from the middle to the doors
    double taken[PIECES_A_ROOM][3]; // x, z, radius, from the middle
    int way_count, taken_count;
} interior_room;

static void add_way(interior_room *room, const interior_door *door, double x, double z)
{
    if (!door || !door->exists) return;
    double half = INTERIOR_ROOM / 2, *way = room->ways[room->way_count++];
    way[0] = x != 0 ? x * half : door->offset;
    way[1] = z != 0 ? z * half : door->offset;
}

static interior_room describe_room(const interior_plan *plan, double floor, uint32_t band,
                                   uint32_t row, uint32_t column)
{
    interior_room room = {(column + 0.5) * INTERIOR_ROOM,
                          interior_row_z(band, row) + INTERIOR_ROOM / 2,
                          floor,
                          {{0}},
                          {{0}},
                          0,
                          0};
    double front = row == 0 ? 1 : -1;
    add_way(&room, interior_front(plan, band, row, column), 0, front);
    add_way(&room, interior_back(plan, band + row, column), 0, -front);
    add_way(&room, interior_side(plan, band, row, column), -1, 0);
    add_way(&room, interior_side(plan, band, row, column + 1), 1, 0);
    return room;
}

// Distance of a point from the way that leads straight from the room's middle to a door.
static double distance_to_way(const double *way, double x, double z)
{
    double t = (x * way[0] + z * way[1]) / (way[0] * way[0] + way[1] * way[1]);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double away_x = x - t * way[0], away_z = z - t * way[1];
    return sqrt(away_x * away_x + away_z * away_z);
}

static bool is_free(const interior_room *room, double x, double z, double radius)
{
    for (int i = 0; i < room->way_count; i++)
        if (distance_to_way(room->ways[i], x, z) < radius + AISLE) return false;
    for (int i = 0; i < room->taken_count; i++) {
        double away_x = x - room->taken[i][0], away_z = z - room->taken[i][1];
        if (sqrt(away_x * away_x + away_z * away_z) < radius + room->taken[i][2]) return false;
    }
    return true;
}

static bool find_place(interior_room *room, steady_random *random, double radius)
{
    double reach = (INTERIOR_ROOM - INTERIOR_WALL) / 2 - radius;
    for (int i = 0; i < TRIES; i++) {
        double x = steady_between(random, -reach, reach);
        double z = steady_between(random, -reach, reach);
        if (!is_free(room, x, z, radius)) continue;
        double *place = room->taken[room->taken_count++];
        place[0] = x;
        place[1] = z;
        place[2] = radius;
        return true;
    }
    return false;
}

static double draw(steady_random *random, const double range[2])
{
    return steady_between(random, range[0], range[1]);
}

static void place_piece(obs_scene *scene, interior_room *room, steady_random *random,
                        const furniture_kind *kind)
{
    double width = draw(random, kind->width);
    double depth = draw(random, kind->depth);
    double height = draw(random, kind->height);
    double angle = 1.5707963267948966 * steady_below(random, 4);
    angle += steady_between(random, -0.1, 0.1);
    if (!find_place(room, random, sqrt(width * width + depth * depth))) return;
    const double *place = room->taken[room->taken_count - 1];
    double x = room->x + place[0], z = room->z + place[1];
    occ_box box = scenes_box(x, room->floor + height / 2, z, width, height / 2, depth);
    box = scenes_turned(&box, angle);
    uint32_t owner = obs_add_object(scene, &box);
    if (kind->solid == 0) return;
    double middle = (kind->low + kind->high) / 2 * height;
    double half = (kind->high - kind->low) / 2 * height;
    occ_box solid =
        scenes_box(x, room->floor + middle, z, width * kind->solid, half, depth * kind->solid);
    solid = scenes_turned(&solid, angle);
    obs_add_occluder(scene, &solid, owner);
}

void interior_furnish(obs_scene *scene, steady_random *random, const interior_plan *plan,
                      double floor, uint32_t band, uint32_t row, uint32_t column)
{
    interior_room room = describe_room(plan, floor, band, row, column);
    for (int i = 0; i < PIECES_A_ROOM; i++)
        place_piece(scene, &room, random, &furniture_kinds[steady_below(random, FURNITURE_KINDS)]);
    occ_box lamp = scenes_box(room.x, floor + INTERIOR_HEIGHT - 0.08, room.z, 0.6, 0.04, 0.15);
    obs_add_object(scene, &lamp); // glass: nothing of it is solid
}
