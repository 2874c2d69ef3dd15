// SPDX-License-Identifier: Apache-2.0
#include "interior_plan.h"

#include <math.h>
#include <stdlib.h>

enum { DOORS_A_COLUMN = 5, OBJECTS_A_ROOM = 18 };

bool interior_plan_create(interior_plan *plan, uint32_t count)
{
    uint32_t rooms = (count + OBJECTS_A_ROOM - 1) / OBJECTS_A_ROOM;
    plan->storeys = rooms < 100 ? 1 : rooms < 1000 ? 2 : 4;
    double share = (double)rooms / plan->storeys;
    double bands = floor(sqrt(share / 4.8) + 0.5); // about as deep as wide
    plan->bands = bands < 1 ? 1 : (uint32_t)bands;
    double columns = floor(share / (2.0 * plan->bands) + 0.5);
    plan->columns = columns < 2 ? 2 : (uint32_t)columns;
    plan->doors = calloc((size_t)plan->bands * plan->columns, DOORS_A_COLUMN * sizeof *plan->doors);
    return plan->doors != NULL;
}

void interior_plan_destroy(interior_plan *plan)
{
    free(plan->doors);
    *plan = (interior_plan){0};
}

static interior_door draw_door(steady_random *random, double exists, double closed)
{
    interior_door door;
    door.exists = steady_unit(random) < exists;
    door.closed = steady_unit(random) < closed;
    door.offset = steady_between(random, -1.2, 1.2);
    return door;
}

void interior_plan_doors(interior_plan *plan, steady_random *random)
{
    for (uint32_t band = 0; band < plan->bands; band++)
        for (uint32_t column = 0; column < plan->columns; column++) {
            for (uint32_t row = 0; row < 2; row++) {
                *interior_front(plan, band, row, column) = draw_door(random, 1, 0.4);
                if (column > 0)
                    *interior_side(plan, band, row, column) = draw_door(random, 0.35, 0.3);
            }
            if (band > 0) *interior_back(plan, band, column) = draw_door(random, 0.35, 0.3);
        }
}

double interior_row_z(uint32_t band, uint32_t row)
{
    return band * (2 * INTERIOR_ROOM + INTERIOR_CORRIDOR) +
           row * (INTERIOR_ROOM + INTERIOR_CORRIDOR);
}

double interior_front_z(uint32_t band, uint32_t row)
{
    return interior_row_z(band, row) + (row == 0 ? INTERIOR_ROOM : 0);
}

static interior_door *door_at(const interior_plan *plan, uint32_t band, uint32_t column,
                              uint32_t which)
{
    return &plan->doors[((size_t)band * plan->columns + column) * DOORS_A_COLUMN + which];
}

interior_door *interior_front(const interior_plan *plan, uint32_t band, uint32_t row,
                              uint32_t column)
{
    return door_at(plan, band, column, row);
}

interior_door *interior_side(const interior_plan *plan, uint32_t band, uint32_t row,
                             uint32_t column)
{
    bool is_outer = column == 0 || column >= plan->columns;
    return is_outer ? NULL : door_at(plan, band, column, 2 + row);
}

interior_door *interior_back(const interior_plan *plan, uint32_t band, uint32_t column)
{
    return band == 0 || band >= plan->bands ? NULL : door_at(plan, band, column, 4);
}
