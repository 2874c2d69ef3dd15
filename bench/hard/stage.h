// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the families build their worlds on: a place of their own, in whose units all numbers are
/// small, with the camera near its origin. The stage turns, scales and moves what is put on it.
///
/// The world is place + unit * turn * local. `turn` has small whole numbers in it, its columns are
/// at right angles and equally long, and `unit` has eight bits: multiples of 1/16 up to some
/// hundred come out exact in float, and a multiple of 1 at a distance where floats can tell units
/// apart.
#ifndef OCC_HARD_STAGE_H
#define OCC_HARD_STAGE_H

#include "family.h"

/// A box in the stage's own coordinates.
typedef struct stage_box {
    double center[3], axis[3][3];
} stage_box;

/// A sheet in the stage's own coordinates.
typedef struct stage_sheet {
    uint32_t count;
    double corner[OCC_SHEET_CORNERS][3];
} stage_sheet;

typedef struct stage {
    family_world *world;
    steady_random random;
    double turn[3][3], unit, place[3];
    double length;          ///< Of one local unit, in world units.
    double eye[3], back[3]; ///< Of the camera; `back` is against its direction.
    bool parallel;          ///< The camera is orthographic.
    /// As they were put up; then, in the place of sheets, parallelograms that lie about where they
    /// do.
    stage_box occluders[FAMILY_OCCLUDERS + FAMILY_SHEETS];
} stage;

/// Empties the world and draws the turn.
void stage_begin(stage *s, family_world *world, const family_place *place, const char *name);

/// In a quarter of the worlds, moves some of the numbers of boxes and sheets to a neighbouring
/// float.
void stage_end(stage *s);

/// To world units, without the place.
void stage_carry(const stage *s, const double local[3], double out[3]);

// --- numbers -------------------------------------------------------------------------------------
// C leaves open in which order arguments are evaluated, and compilers differ. So no expression may
// draw twice: ranges are passed instead, and drawn from in order.

/// low, low + step, ... high.
typedef struct stage_range {
    double low, high, step;
} stage_range;

static inline stage_range stage_ones(double low, double high)
{
    return (stage_range){low, high, 1.0};
}

static inline stage_range stage_parts(double low, double high)
{
    return (stage_range){low, high, 0.0625};
}

static inline stage_range stage_just(double value)
{
    return (stage_range){value, value, 1.0};
}

double stage_draw(stage *s, stage_range range);

/// One in `count`.
bool stage_chance(stage *s, uint32_t count);

/// A whole number from `low` to `high`, both included.
double stage_whole(stage *s, int low, int high);

/// A multiple of 1/16 from `low` to `high`, both included.
double stage_part(stage *s, double low, double high);

/// 1 or -1.
double stage_sign(stage *s);

/// A whole number from `low` to `high`, with either sign.
double stage_signed(stage *s, int low, int high);

/// 2 to the power of minus `least` to minus `most`, with either sign.
double stage_sliver(stage *s, int least, int most);

// --- boxes ---------------------------------------------------------------------------------------

/// Aligned with the stage's axes.
stage_box stage_brick(double x, double y, double z, double a, double b, double c);

/// The same, each number drawn from a range.
stage_box stage_any_brick(stage *s, stage_range x, stage_range y, stage_range z, stage_range a,
                          stage_range b, stage_range c);

/// Of any shape, around a point.
stage_box stage_any(stage *s, world_shape shape, const double center[3], double size);

/// The corner whose bit k says which end of axis k it is at.
void stage_corner(const stage_box *box, unsigned corner, double out[3]);

/// Puts a box up and returns its number, or -1 if there is no room.
int stage_object(stage *s, stage_box box);
int stage_occluder(stage *s, stage_box box, int owner);

// --- sheets --------------------------------------------------------------------------------------

/// A rectangle across z, counterclockwise for a camera that looks along -z.
stage_sheet stage_quad(double low_x, double high_x, double low_y, double high_y, double z);

/// An octagon across z around (x, y): a square of half size `a` with corners cut off by `cut`.
stage_sheet stage_octagon(double x, double y, double z, double a, double cut);

/// Moves every corner along z by so much for one unit of x and of y.
void stage_lean(stage_sheet *sheet, double by_x, double by_y);

/// Turns the order of the corners round.
void stage_turn_round(stage_sheet *sheet);

/// Puts a sheet up. Returns a number that stage_behind() and stage_on_rim() take, or -1 if there is
/// no room.
int stage_put(stage *s, stage_sheet sheet, occ_sides sides, int owner);

/// Either, for a sheet whose sides do not matter.
occ_sides stage_any_sides(stage *s);

/// The world's sheet of that number.
world_sheet *stage_world_sheet(stage *s, int occluder);

// --- the camera ----------------------------------------------------------------------------------

/// Any lens, half of them plain perspective.
world_lens stage_lens(stage *s);

/// A point drawn from ranges.
void stage_point(stage *s, stage_range x, stage_range y, stage_range z, double out[3]);

/// A camera at a whole point near the origin: straight along -z in half of the worlds, else
/// looking up to `aside` sixteenths of its way aside.
void stage_look_about(stage *s, double aside, const world_lens *lens);

/// The camera at `eye`, straight along -z if `target` is NULL. Lengths of the lens are local.
void stage_look(stage *s, const double eye[3], const double target[3], const world_lens *lens);

// --- crowds --------------------------------------------------------------------------------------

/// Objects until there are `count`: behind the occluders, on the rims of their shadows, touching
/// them, and anywhere in the picture. `shape` is WORLD_SHAPES for any.
void stage_crowd(stage *s, uint32_t count, world_shape shape);

/// An object on the line from the eye through a point inside an occluder (a sheet: near it),
/// `times` as far.
void stage_behind(stage *s, int occluder, double times, world_shape shape);

/// An aligned object that touches the plane through the eye and an edge of an occluder, or the ray
/// through its corner, from inside or outside of the shadow.
void stage_on_rim(stage *s, int occluder);

#endif
