// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a model takes over from Assimp beside its triangles.
#ifndef OCC_BENCH_MODEL_IMPORT_H
#define OCC_BENCH_MODEL_IMPORT_H

#include "model.h"

#include <assimp/scene.h>

/// Takes the names of materials and meshes, and the triangles of those meshes that several parts
/// are. The parts must be there. Returns false when memory runs out; the model may be freed then.
bool model_take_meshes(const struct aiScene *scene, model *out);

#endif
