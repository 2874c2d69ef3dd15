// SPDX-License-Identifier: Apache-2.0
/// @file
/// Boxes, and the scene that holds them: objects to be culled and occluders that hide.
#ifndef OCCLUDE_SCENE_H
#define OCCLUDE_SCENE_H

#include "base.h"

/// The largest magnitude that a coordinate of a box's corner, or of an eye, may have.
#define OCC_MAX_COORDINATE 1e15f

/// An affine image of the cube [-1,1]^3: its corners are center ± axis[0] ± axis[1] ± axis[2].
/// The axes are half-extent vectors in world units; they need not be orthogonal, may be mirrored,
/// and any of them may be zero (a quad, a segment, a point). 12 floats, no padding.
typedef struct occ_box {
    float center[3];  ///< The middle, in world units.
    float axis[3][3]; ///< axis[k] leads from the middle to the middle of the k-th pair of faces.
} occ_box;

/// The smallest axis-aligned box, up to one rounding outward, that holds every point between `min`
/// and `max` (both 3 floats, `min[k] <= max[k]`).
OCC_API OCC_NODISCARD occ_result occ_box_from_min_max(const float *min, const float *max,
                                                      occ_box *box);

/// A local min/max box carried through a model matrix: `model` is 16 floats, column-major, affine
/// (last row 0 0 0 1, which is checked). Rotation, scale, shear and mirroring are all kept: the box
/// is the exact image of the local one, each of its 12 numbers rounded once to the nearest float.
OCC_API OCC_NODISCARD occ_result occ_box_from_model(const float *model, const float *min,
                                                    const float *max, occ_box *box);

/// The axis-aligned bounds of `count` points (at least one), each three floats at `points` plus a
/// multiple of `stride` bytes (0: 12, tightly packed). Every point lies inside, exactly.
OCC_API OCC_NODISCARD occ_result occ_box_from_points(const float *points, size_t count,
                                                     size_t stride, occ_box *box);

/// Most corners of a sheet.
#define OCC_SHEET_CORNERS 8

/// From where a sheet hides.
typedef enum occ_sides {
    OCC_SIDES_BOTH = 0, ///< From both sides: its surface is drawn from both.
    OCC_SIDES_FRONT = 1 ///< From where its corners go counterclockwise: back faces are not drawn.
} occ_sides;

/// A flat convex polygon, as an occluder: the triangles (0, 1, 2), (0, 2, 3), … of its corners, in
/// order around it. Corners that rounding has moved out of one plane are no error: what a sheet
/// hides is behind all of its corners, so that any opaque surface may take its place that has the
/// same outline and whose points lie within the corners' reach across it. A polygon that is not
/// convex is no error either, but hides less. No padding.
typedef struct occ_sheet {
    uint32_t corner_count;              ///< 3 to OCC_SHEET_CORNERS.
    occ_sides sides;                    ///< Default: both.
    float corner[OCC_SHEET_CORNERS][3]; ///< In world units; beyond `corner_count` not read.
} occ_sheet;

/// Names an object for as long as it is in its scene. All zero is no object. A handle outlives its
/// object safely: using it then gives OCC_ERROR_STALE_HANDLE.
typedef struct occ_object {
    uint32_t index;      ///< Slot + 1.
    uint32_t generation; ///< Tells apart the objects that have had this slot.
} occ_object;

/// Names an occluder, as occ_object names an object. All zero is no occluder.
typedef struct occ_occluder {
    uint32_t index;      ///< Slot + 1.
    uint32_t generation; ///< Tells apart the occluders that have had this slot.
} occ_occluder;

/// The object's place in masks and lists: a number below occ_scene_slot_count(), stable for the
/// object's life and used again after it. `object` must not be zero.
static inline uint32_t occ_object_slot(occ_object object)
{
    return object.index - 1u;
}

/// How a scene is made. All zero, or no desc at all, is a good default.
typedef struct occ_scene_desc {
    occ_allocator allocator; ///< Default: the C library.
    occ_logger logger;       ///< Default: silent.
    uint32_t object_count;   ///< Objects to reserve room for. Default 0: grow as they come.
    uint32_t occluder_count; ///< Occluders to reserve room for. Default 0: grow as they come.
    uint32_t leaf_objects;   ///< Most objects in an octree leaf, 1 to 1024. Default 64.
    uint32_t threads;        ///< OpenMP threads of a commit, 1024 at most. Default 0: what OpenMP
                             ///< offers. A small scene is committed on one all the same.
} occ_scene_desc;

/// Objects, occluders, and an octree over each. See the thread rules in occlude.h.
typedef struct occ_scene occ_scene;

/// Makes an empty scene. `desc` is copied and may be NULL. `*scene` is NULL on failure.
OCC_API OCC_NODISCARD occ_result occ_scene_create(const occ_scene_desc *desc, occ_scene **scene);

/// Frees the scene and all it holds. NULL is accepted. No view may be culling it.
OCC_API void occ_scene_destroy(occ_scene *scene);

/// Adds one object whose box bounds all that is drawn for it.
OCC_API OCC_NODISCARD occ_result occ_scene_add(occ_scene *scene, const occ_box *box,
                                               occ_object *object);

/// Adds `count` objects: all of them, or on an error none. `objects` receives `count` handles; NULL
/// is accepted by who needs none (a scene built once: slots are then 0, 1, 2, … in order).
OCC_API OCC_NODISCARD occ_result occ_scene_add_many(occ_scene *scene, const occ_box *boxes,
                                                    size_t count, occ_object *objects);

/// Gives an object another box. Its occluders stay where they are: move them too.
OCC_API OCC_NODISCARD occ_result occ_scene_move(occ_scene *scene, occ_object object,
                                                const occ_box *box);

/// Gives `count` objects other boxes: all of them, or on an error none.
OCC_API OCC_NODISCARD occ_result occ_scene_move_many(occ_scene *scene, const occ_object *objects,
                                                     const occ_box *boxes, size_t count);

/// Removes an object, and with it the occluders that it owns.
OCC_API OCC_NODISCARD occ_result occ_scene_remove(occ_scene *scene, occ_object object);

/// Adds an occluder: a box that lies wholly inside opaque geometry. A box with one zero axis is a
/// parallelogram and must lie in an opaque surface. `owner` is the object it is part of and never
/// hides; all zero: none.
OCC_API OCC_NODISCARD occ_result occ_scene_add_occluder(occ_scene *scene, const occ_box *box,
                                                        occ_object owner, occ_occluder *occluder);

/// Adds `count` occluders: all of them, or on an error none. `owners` may be NULL (none has one),
/// and so may `occluders`.
OCC_API OCC_NODISCARD occ_result occ_scene_add_occluders(occ_scene *scene, const occ_box *boxes,
                                                         const occ_object *owners, size_t count,
                                                         occ_occluder *occluders);

/// Adds a sheet as an occluder: see occ_sheet. It must lie in an opaque surface, and hides what is
/// strictly behind it. One whose corners lie in a line, or in a point, hides nothing. Handles,
/// owners and limits are those of the other occluders.
OCC_API OCC_NODISCARD occ_result occ_scene_add_sheet(occ_scene *scene, const occ_sheet *sheet,
                                                     occ_object owner, occ_occluder *occluder);

/// Adds `count` sheets: all of them, or on an error none. `owners` may be NULL (none has one), and
/// so may `occluders`.
OCC_API OCC_NODISCARD occ_result occ_scene_add_sheets(occ_scene *scene, const occ_sheet *sheets,
                                                      const occ_object *owners, size_t count,
                                                      occ_occluder *occluders);

/// Gives an occluder another box. If it was a sheet, it is a box from here on.
OCC_API OCC_NODISCARD occ_result occ_scene_move_occluder(occ_scene *scene, occ_occluder occluder,
                                                         const occ_box *box);

/// Gives an occluder another sheet. If it was a box, it is a sheet from here on.
OCC_API OCC_NODISCARD occ_result occ_scene_move_sheet(occ_scene *scene, occ_occluder occluder,
                                                      const occ_sheet *sheet);

/// Removes an occluder.
OCC_API OCC_NODISCARD occ_result occ_scene_remove_occluder(occ_scene *scene, occ_occluder occluder);

/// Brings the octrees up to date with all edits since the last commit. The result is a function of
/// the scene's content alone: a scene edited into a state equals one built in it, whatever the
/// number of threads. The allocator and the logger are called in the caller's thread. On an error
/// the edits are kept, and another commit may be tried.
OCC_API OCC_NODISCARD occ_result occ_scene_commit(occ_scene *scene);

/// Whether the handle names an object that is in this scene now.
OCC_API bool occ_scene_contains(const occ_scene *scene, occ_object object);

/// The box that an object was last given.
OCC_API OCC_NODISCARD occ_result occ_scene_box(const occ_scene *scene, occ_object object,
                                               occ_box *box);

/// The box that an occluder was last given, and the object that owns it. Either result may be NULL.
/// Of a sheet: OCC_ERROR_INVALID_ARGUMENT.
OCC_API OCC_NODISCARD occ_result occ_scene_occluder_box(const occ_scene *scene,
                                                        occ_occluder occluder, occ_box *box,
                                                        occ_object *owner);

/// The sheet that an occluder was last given, zero where it has no corners, and the object that
/// owns it. Either result may be NULL. Of a box: OCC_ERROR_INVALID_ARGUMENT.
OCC_API OCC_NODISCARD occ_result occ_scene_occluder_sheet(const occ_scene *scene,
                                                          occ_occluder occluder, occ_sheet *sheet,
                                                          occ_object *owner);

/// One more than the highest slot ever used: the number of bits in a mask. 0 for NULL.
OCC_API uint32_t occ_scene_slot_count(const occ_scene *scene);

/// Sizes of a scene, for logs and tests.
typedef struct occ_scene_stats {
    uint32_t objects;        ///< Objects in the scene.
    uint32_t occluders;      ///< Occluders in the scene, boxes and sheets.
    uint32_t slots;          ///< occ_scene_slot_count().
    uint32_t object_nodes;   ///< Octree nodes over the objects.
    uint32_t occluder_nodes; ///< Octree nodes over the occluders.
    uint32_t levels;         ///< Levels of the object octree.
    uint64_t bytes;          ///< Everything the scene has allocated and still holds.
} occ_scene_stats;

/// Fills `stats`.
OCC_API OCC_NODISCARD occ_result occ_scene_get_stats(const occ_scene *scene,
                                                     occ_scene_stats *stats);

/// Checks every invariant of a committed scene, in time proportional to its size: OCC_SUCCESS, or
/// OCC_ERROR_CORRUPT with a log line that names the first one broken. For tests and bug reports.
OCC_API OCC_NODISCARD occ_result occ_scene_validate(const occ_scene *scene);

#endif
