// SPDX-License-Identifier: Apache-2.0
/// @file
/// The plan of a storey of the scene "interior": how many rooms, and where the doors are.
#ifndef OCC_BENCH_INTERIOR_PLAN_H
#define OCC_BENCH_INTERIOR_PLAN_H

#include "steady.h"

#include <stdbool.h>

// Metres.
#define INTERIOR_ROOM     6.0
#define INTERIOR_CORRIDOR 2.4
#define INTERIOR_WALL     0.2
#define INTERIOR_HEIGHT   3.0
#define INTERIOR_SLAB     0.3

/// What a wall between two rooms has in it.
typedef struct interior_door {
    bool exists, closed;
    double offset; ///< From the wall's middle.
} interior_door;

/// Two rows of `columns` rooms to a band, on both sides of its corridor.
typedef struct interior_plan {
    uint32_t storeys, bands, columns;
    interior_door *doors; ///< Of one storey: five for each column of each band.
} interior_plan;

/// Chooses sizes for about `count` objects. False when memory runs out.
bool interior_plan_create(interior_plan *plan, uint32_t count);
void interior_plan_destroy(interior_plan *plan);

/// Draws the doors of the next storey.
void interior_plan_doors(interior_plan *plan, steady_random *random);

/// Where a row begins, and where its wall towards the corridor is.
double interior_row_z(uint32_t band, uint32_t row);
double interior_front_z(uint32_t band, uint32_t row);

/// The door from a room to its corridor.
interior_door *interior_front(const interior_plan *plan, uint32_t band, uint32_t row,
                              uint32_t column);

/// The door in the wall before `column`; NULL in the outer walls.
interior_door *interior_side(const interior_plan *plan, uint32_t band, uint32_t row,
                             uint32_t column);

/// The door between row 0 of a band and row 1 of the band before; NULL in the outer walls.
interior_door *interior_back(const interior_plan *plan, uint32_t band, uint32_t column);

#endif
