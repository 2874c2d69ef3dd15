// SPDX-License-Identifier: Apache-2.0
// Rooms, corridors, doorways. Seen from above, a storey is a stack of bands:
//
//      z |  room room room room    row 1     x: columns of ROOM metres
//        |  corridor corridor...             back walls lie between bands
//        |  room room room room    row 0
//
// Walls are boxes ROOM long and WALL thick that reach into one another at their ends, so that no
// crack is left at a corner. Random numbers are drawn one to a statement.
#include "scenes.h"

#include "interior_furniture.h"
#include "interior_path.h"
#include "interior_plan.h"
#include "steady.h"

static const double DOOR_HEIGHT = 2.1, HALF_DOOR = 0.5, OVERLAP = 0.05;

typedef struct interior_builder {
    obs_scene *scene;
    steady_random *random;
    const interior_plan *plan;
    double floor; ///< Height of the storey's floor.
} interior_builder;

static void add_solid(obs_scene *scene, const occ_box *box)
{
    obs_add_occluder(scene, box, obs_add_object(scene, box));
}

// A piece of wall that runs along x (or z) from `from` to `to` at `line` on the other axis.
static void add_piece(const interior_builder *builder, bool along_x, double line, double from,
                      double to, double bottom, double top)
{
    double middle = (from + to) / 2, half = (to - from) / 2;
    double y = builder->floor + (bottom + top) / 2, half_y = (top - bottom) / 2;
    occ_box box = along_x ? scenes_box(middle, y, line, half, half_y, INTERIOR_WALL / 2)
                          : scenes_box(line, y, middle, INTERIOR_WALL / 2, half_y, half);
    add_solid(builder->scene, &box);
}

// A wall of one room's length from `from`, with or without a doorway.
static void add_wall(const interior_builder *builder, bool along_x, double line, double from,
                     double length, const interior_door *door)
{
    const double bottom = -OVERLAP, top = INTERIOR_HEIGHT + OVERLAP, ends = INTERIOR_WALL / 2;
    double to = from + length;
    if (!door || !door->exists) {
        add_piece(builder, along_x, line, from - ends, to + ends, bottom, top);
        return;
    }
    double left = from + length / 2 + door->offset - HALF_DOOR, right = left + 2 * HALF_DOOR;
    add_piece(builder, along_x, line, from - ends, left, bottom, top);
    add_piece(builder, along_x, line, right, to + ends, bottom, top);
    add_piece(builder, along_x, line, left - OVERLAP, right + OVERLAP, DOOR_HEIGHT, top);
    if (door->closed) // the leaf fills the doorway
        add_piece(builder, along_x, line, left - OVERLAP, right + OVERLAP, -OVERLAP,
                  DOOR_HEIGHT + OVERLAP);
}

static void add_slab(const interior_builder *builder, double x, double z, double depth, double y)
{
    occ_box box = scenes_box(x + INTERIOR_ROOM / 2, y - INTERIOR_SLAB / 2, z + depth / 2,
                             INTERIOR_ROOM / 2 + OVERLAP, INTERIOR_SLAB / 2, depth / 2 + OVERLAP);
    add_solid(builder->scene, &box);
}

static void add_floors(const interior_builder *builder, double y)
{
    const interior_plan *plan = builder->plan;
    for (uint32_t band = 0; band < plan->bands; band++)
        for (uint32_t column = 0; column < plan->columns; column++) {
            double x = column * INTERIOR_ROOM, z = interior_row_z(band, 0);
            add_slab(builder, x, z, INTERIOR_ROOM, y);
            add_slab(builder, x, z + INTERIOR_ROOM, INTERIOR_CORRIDOR, y);
            add_slab(builder, x, interior_row_z(band, 1), INTERIOR_ROOM, y);
        }
}

static void add_side_walls(const interior_builder *builder, uint32_t band)
{
    const interior_plan *plan = builder->plan;
    for (uint32_t row = 0; row < 2; row++)
        for (uint32_t line = 0; line <= plan->columns; line++)
            add_wall(builder, false, line * INTERIOR_ROOM, interior_row_z(band, row), INTERIOR_ROOM,
                     interior_side(plan, band, row, line));
    double corridor = interior_row_z(band, 0) + INTERIOR_ROOM;
    add_wall(builder, false, 0, corridor, INTERIOR_CORRIDOR, NULL);
    add_wall(builder, false, plan->columns * INTERIOR_ROOM, corridor, INTERIOR_CORRIDOR, NULL);
}

static void add_long_walls(const interior_builder *builder, uint32_t band)
{
    const interior_plan *plan = builder->plan;
    for (uint32_t column = 0; column < plan->columns; column++) {
        double x = column * INTERIOR_ROOM;
        add_wall(builder, true, interior_row_z(band, 0), x, INTERIOR_ROOM,
                 interior_back(plan, band, column));
        for (uint32_t row = 0; row < 2; row++)
            add_wall(builder, true, interior_front_z(band, row), x, INTERIOR_ROOM,
                     interior_front(plan, band, row, column));
        if (band + 1 == plan->bands)
            add_wall(builder, true, interior_row_z(band + 1, 0), x, INTERIOR_ROOM, NULL);
    }
}

static void add_storey(const interior_builder *builder)
{
    const interior_plan *plan = builder->plan;
    add_floors(builder, builder->floor);
    for (uint32_t band = 0; band < plan->bands; band++) {
        add_side_walls(builder, band);
        add_long_walls(builder, band);
        for (uint32_t row = 0; row < 2; row++)
            for (uint32_t column = 0; column < plan->columns; column++)
                interior_furnish(builder->scene, builder->random, plan, builder->floor, band, row,
                                 column);
    }
}

void scenes_interior(obs_scene *scene, uint32_t count, uint64_t seed)
{
    steady_random random = steady_seed(seed, "interior");
    interior_plan plan;
    if (!interior_plan_create(&plan, count)) {
        scene->out_of_memory = true;
        return;
    }
    interior_builder builder = {scene, &random, &plan, 0};
    uint32_t walked = plan.storeys / 2;
    for (uint32_t storey = 0; storey < plan.storeys; storey++) {
        builder.floor = storey * (INTERIOR_HEIGHT + INTERIOR_SLAB);
        interior_plan_doors(&plan, &random);
        if (storey == walked) interior_walk(scene, &random, &plan, builder.floor);
        add_storey(&builder);
    }
    add_floors(&builder, plan.storeys * (INTERIOR_HEIGHT + INTERIOR_SLAB)); // the roof
    interior_plan_destroy(&plan);
}
