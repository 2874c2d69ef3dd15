// SPDX-License-Identifier: Apache-2.0
// In each band: from the back room to the corridor, along it, into the room on the other side, to
// that room's neighbour, and through its back wall into the next band.
#include "interior_path.h"

#include <math.h>

enum { WALK_FRAMES = 60, WALK_BANDS = 4, WALK_POINTS = 9 * WALK_BANDS };
static const double EYE_HEIGHT = 1.65, LOOK_AHEAD = 1.5;
static const double COTANGENT_75 = 1.3032253728412058; // of half of 75 degrees

typedef struct interior_route {
    uint32_t count;
    double points[WALK_POINTS][2]; // x, z
} interior_route;

static void pass(interior_route *route, double x, double z)
{
    route->points[route->count][0] = x;
    route->points[route->count][1] = z;
    route->count++;
}

static double middle_of(uint32_t column)
{
    return (column + 0.5) * INTERIOR_ROOM;
}

// Returns the door's offset.
static double open_up(interior_door *door)
{
    door->exists = true;
    door->closed = false;
    return door->offset;
}

// A column near `column`, and another one where there is a choice.
static uint32_t stray(steady_random *random, uint32_t column, uint32_t columns, uint32_t reach)
{
    uint32_t low = column > reach ? column - reach : 0;
    uint32_t high = column + reach < columns ? column + reach : columns - 1;
    uint32_t chosen = low + steady_below(random, high - low);
    return chosen >= column ? chosen + 1 : chosen;
}

// Returns the column where the walk leaves the band.
static uint32_t cross_band(interior_route *route, steady_random *random, interior_plan *plan,
                           uint32_t band, uint32_t column)
{
    double corridor = interior_front_z(band, 0) + INTERIOR_CORRIDOR / 2;
    double far_row = interior_row_z(band, 1) + INTERIOR_ROOM / 2;
    pass(route, middle_of(column), interior_row_z(band, 0) + INTERIOR_ROOM / 2);
    double door = middle_of(column) + open_up(interior_front(plan, band, 0, column));
    pass(route, door, interior_front_z(band, 0));
    pass(route, door, corridor);

    uint32_t entered = stray(random, column, plan->columns, 3);
    door = middle_of(entered) + open_up(interior_front(plan, band, 1, entered));
    pass(route, door, corridor);
    pass(route, door, interior_front_z(band, 1));
    pass(route, middle_of(entered), far_row);

    uint32_t left = stray(random, entered, plan->columns, 1);
    uint32_t line = left > entered ? left : entered;
    double side = open_up(interior_side(plan, band, 1, line));
    pass(route, line * INTERIOR_ROOM, far_row + side);
    pass(route, middle_of(left), far_row);
    return left;
}

static double leg_length(const interior_route *route, uint32_t leg)
{
    double x = route->points[leg + 1][0] - route->points[leg][0];
    double z = route->points[leg + 1][1] - route->points[leg][1];
    return sqrt(x * x + z * z);
}

// The point `distance` along the route; beyond its end, straight on.
static void point_at(const interior_route *route, double distance, double *x, double *z)
{
    uint32_t leg = 0;
    for (; leg + 2 < route->count && distance > leg_length(route, leg); leg++)
        distance -= leg_length(route, leg);
    double t = distance / leg_length(route, leg);
    const double *from = route->points[leg], *to = route->points[leg + 1];
    *x = from[0] + t * (to[0] - from[0]);
    *z = from[1] + t * (to[1] - from[1]);
}

static void add_frames(obs_scene *scene, const interior_route *route, double height)
{
    double length = 0;
    for (uint32_t leg = 0; leg + 1 < route->count; leg++)
        length += leg_length(route, leg);
    for (int i = 0; i < WALK_FRAMES; i++) {
        double at = length * (i + 0.5) / WALK_FRAMES, x, z, ahead_x, ahead_z;
        point_at(route, at, &x, &z);
        point_at(route, at + LOOK_AHEAD, &ahead_x, &ahead_z);
        const double eye[3] = {x, height, z}, direction[3] = {ahead_x - x, 0, ahead_z - z};
        obs_frame frame = obs_look(eye, direction, COTANGENT_75, 16.0 / 9.0, 0.05, 1000);
        obs_add_frame(scene, &frame);
    }
}

void interior_walk(obs_scene *scene, steady_random *random, interior_plan *plan, double floor)
{
    interior_route route = {0};
    uint32_t bands = plan->bands < WALK_BANDS ? plan->bands : WALK_BANDS;
    uint32_t first = (plan->bands - bands) / 2;
    uint32_t column = plan->columns / 2;
    for (uint32_t band = first; band < first + bands; band++) {
        if (band > first) {
            double door = middle_of(column) + open_up(interior_back(plan, band, column));
            pass(&route, door, interior_row_z(band, 0));
        }
        column = cross_band(&route, random, plan, band, column);
    }
    add_frames(scene, &route, floor + EYE_HEIGHT);
}
