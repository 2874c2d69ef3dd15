// SPDX-License-Identifier: Apache-2.0
/// @file
/// A model file as one plain soup of triangles in world space, whatever its format and nodes were.
#ifndef OCC_BENCH_MODEL_H
#define OCC_BENCH_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Which way is up in the file. In a model read it is always y.
typedef enum model_up {
    MODEL_UP_GUESS = 0, ///< y for glTF, which says so; else y or z, whichever extends less.
    MODEL_UP_Y = 1,
    MODEL_UP_Z = 2 ///< (x, y, z) becomes (x, z, -y).
} model_up;

/// A mesh of the file.
typedef struct model_mesh {
    char *name;
    uint32_t material; ///< An index into the model's materials, or UINT32_MAX.
    uint32_t places;   ///< How many parts it is.
    /// Its triangles in its own coordinates, if it has several places; else 0 and NULL.
    uint32_t vertex_count, triangle_count;
    float (*positions)[3];
    uint32_t (*corners)[3];
} model_mesh;

/// A mesh at one of its places: its triangles in the same order.
typedef struct model_part {
    uint32_t mesh;
    uint32_t first, count; ///< Triangles of the model.
    float matrix[16];      ///< What led there, column-major.
} model_part;

/// Triangles over shared positions. All zero is empty; model_free() it when done.
///
/// Two corners are the same vertex exactly when their coordinates are the same numbers, so that
/// triangles which touch in the file share an edge here, whatever normals or colours they had.
typedef struct model {
    uint32_t vertex_count, triangle_count;
    float (*positions)[3];  ///< Finite, of magnitude up to OCC_MAX_COORDINATE, never -0.
    uint32_t (*corners)[3]; ///< Vertices of each triangle, in the file's winding.
    bool *see_through;      ///< For each triangle: light may pass, so it must not occlude.
    uint32_t skipped_faces; ///< Points and lines, which were left out.
    uint32_t see_through_count;
    model_part
        *parts; ///< In the order of their triangles. May be none, as in a model made by hand.
    uint32_t part_count;
    model_mesh *meshes;
    uint32_t mesh_count;
    char **materials; ///< Names, as the file has them.
    uint32_t material_count;
    model_up up;          ///< What the file's up was, or was taken to be.
    float min[3], max[3]; ///< Bounds of the positions.
} model;

/// What to know beside the file.
typedef struct model_options {
    const char *const
        *see_through; ///< Patterns (as in a shell) of see-through materials or meshes.
    size_t see_through_count;
    model_up up;
} model_options;

/// Reads anything Assimp reads. On failure says on standard error which file and why, zeroes
/// `out` and returns false.
bool model_read(const char *path, const model_options *options, model *out);

/// The part that a triangle is in, or NULL if the model has none.
const model_part *model_part_of(const model *m, uint32_t triangle);

/// Whether a part is one of several places of its mesh.
bool model_is_instance(const model *m, const model_part *part);

/// Frees what a model holds and zeroes it.
void model_free(model *m);

#endif
