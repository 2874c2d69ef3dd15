// SPDX-License-Identifier: Apache-2.0
/// @file
/// Scene files (.obs): objects, occluders and a camera path. Little-endian, packed. Version 1 holds
/// boxes alone, version 2 sheets too:
///
///     "OBS1"  u32 objects  u32 occluders  u32 frames
///     "OBS2"  u32 objects  u32 occluders  u32 sheets  u32 frames
///     objects   x 12 f32: center, axis[3]
///     occluders x 12 f32 as above, u32 owner
///     sheets    x u32 corners (3 to 8), u32 sides, 24 f32: corner[8] (those not used 0), u32 owner
///     frames    x 38 f32: eye[3], dir[3], view[16], proj[16]
///
/// In version 2 an owner may be 0xffffffff: part of no object. Both are read; version 1 is written
/// where there are no sheets and every occluder has an owner. Boxes and sheets share one row of
/// occluder numbers: boxes come first, then the sheets.
#ifndef OCC_BENCH_OBS_H
#define OCC_BENCH_OBS_H

#include <occlude/scene.h>

/// The owner of an occluder that is part of no object.
#define OBS_NO_OWNER UINT32_MAX

/// A solid box or flat one, and the index of the object that it is part of.
typedef struct obs_occluder {
    occ_box box;
    uint32_t owner;
} obs_occluder;

/// A sheet, and the index of the object that it is part of.
typedef struct obs_sheet {
    occ_sheet sheet;
    uint32_t owner;
} obs_sheet;

/// A camera. The matrices are column-major with OpenGL's conventions (clip z in [-w, w]).
typedef struct obs_frame {
    float eye[3], dir[3], view[16], proj[16];
} obs_frame;

/// What a scene file holds. All zero is an empty scene; obs_free() it when done.
typedef struct obs_scene {
    uint32_t object_count, occluder_count, sheet_count, frame_count;
    occ_box *objects;
    obs_occluder *occluders; ///< Those that are boxes.
    obs_sheet *sheets;
    obs_frame *frames;
    uint32_t object_capacity, occluder_capacity, sheet_capacity, frame_capacity;
    bool out_of_memory; ///< An obs_add_…() has failed: obs_write() will refuse.
} obs_scene;

/// Reads a scene. On failure says on standard error which file, at which byte, and what was
/// expected, zeroes `scene` and returns false.
bool obs_read(const char *path, obs_scene *scene);

/// The same from memory. `name` stands for the file in messages; NULL: no messages.
bool obs_parse(const void *bytes, size_t size, const char *name, obs_scene *scene);

/// Writes a scene whole or not at all. On failure says why and returns false.
bool obs_write(const char *path, const obs_scene *scene);

/// Frees what a scene holds and zeroes it.
void obs_free(obs_scene *scene);

/// Appends an object and returns its index. When memory runs out, sets `out_of_memory` and returns
/// UINT32_MAX, as the next three do.
uint32_t obs_add_object(obs_scene *scene, const occ_box *box);

/// Appends an occluder, part of the object `owner` or OBS_NO_OWNER, and returns its index.
uint32_t obs_add_occluder(obs_scene *scene, const occ_box *box, uint32_t owner);

/// Appends a sheet, part of the object `owner` or OBS_NO_OWNER, and returns its index. Corners
/// beyond its count become 0.
uint32_t obs_add_sheet(obs_scene *scene, const occ_sheet *sheet, uint32_t owner);

/// Appends a frame and returns its index.
uint32_t obs_add_frame(obs_scene *scene, const obs_frame *frame);

/// How many occluders a scene has, boxes and sheets together.
static inline uint32_t obs_occluder_total(const obs_scene *scene)
{
    return scene->occluder_count + scene->sheet_count;
}

/// The sheet that occluder `number` is, or NULL where it is a box.
static inline const occ_sheet *obs_occluder_sheet(const obs_scene *scene, uint32_t number)
{
    uint32_t boxes = scene->occluder_count;
    return number < boxes ? NULL : &scene->sheets[number - boxes].sheet;
}

/// The object that occluder `number`, a box or a sheet, is part of, or OBS_NO_OWNER.
static inline uint32_t obs_occluder_owner(const obs_scene *scene, uint32_t number)
{
    uint32_t boxes = scene->occluder_count;
    return number < boxes ? scene->occluders[number].owner : scene->sheets[number - boxes].owner;
}

/// A perspective frame: eye, direction of view (any length but zero; y is up unless it looks
/// straight up or down), cotangent of half the vertical field of view, width over height, and the
/// near and far distances. 60 degrees is cotangent sqrt(3).
obs_frame obs_look(const double eye[3], const double direction[3], double cotangent, double aspect,
                   double near_z, double far_z);

/// proj * view, multiplied in double and rounded once.
void obs_view_projection(const obs_frame *frame, float out[16]);

/// Reads a whole file. Returns NULL after a message, else memory to free(); never NULL for an empty
/// file.
void *obs_read_bytes(const char *path, size_t *size);

#endif
