// SPDX-License-Identifier: Apache-2.0
#include "model_import.h"

#include <assimp/material.h>
#include <stdlib.h>
#include <string.h>

static char *copy_text(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy) memcpy(copy, text, size);
    return copy;
}

static bool take_materials(const struct aiScene *scene, model *out)
{
    out->materials = calloc((size_t)scene->mNumMaterials + 1, sizeof *out->materials);
    if (!out->materials) return false;
    for (unsigned i = 0; i < scene->mNumMaterials; i++) {
        struct aiString name;
        bool named =
            aiGetMaterialString(scene->mMaterials[i], AI_MATKEY_NAME, &name) == aiReturn_SUCCESS;
        out->materials[out->material_count] = copy_text(named ? name.data : "");
        if (!out->materials[out->material_count]) return false;
        out->material_count++;
    }
    return true;
}

// Those faces that parts have, too: the triangles. Assimp's reader has checked the indices by now.
static bool take_triangles(const struct aiMesh *from, model_mesh *to)
{
    to->positions = malloc(((size_t)from->mNumVertices + 1) * sizeof *to->positions);
    to->corners = malloc(((size_t)from->mNumFaces + 1) * sizeof *to->corners);
    if (!to->positions || !to->corners) return false;
    for (unsigned v = 0; v < from->mNumVertices; v++) {
        const struct aiVector3D *p = &from->mVertices[v];
        memcpy(to->positions[v], (float[3]){p->x, p->y, p->z}, sizeof *to->positions);
    }
    for (unsigned f = 0; f < from->mNumFaces; f++)
        if (from->mFaces[f].mNumIndices == 3)
            memcpy(to->corners[to->triangle_count++], from->mFaces[f].mIndices,
                   sizeof *to->corners);
    to->vertex_count = from->mNumVertices;
    return true;
}

bool model_take_meshes(const struct aiScene *scene, model *out)
{
    out->meshes = calloc((size_t)scene->mNumMeshes + 1, sizeof *out->meshes);
    if (!out->meshes || !take_materials(scene, out)) return false;
    for (uint32_t i = 0; i < out->part_count; i++)
        out->meshes[out->parts[i].mesh].places++;
    for (unsigned i = 0; i < scene->mNumMeshes; i++) {
        const struct aiMesh *from = scene->mMeshes[i];
        model_mesh *to = &out->meshes[i];
        out->mesh_count = i + 1;
        to->material =
            from->mMaterialIndex < out->material_count ? from->mMaterialIndex : UINT32_MAX;
        to->name = copy_text(from->mName.data);
        if (!to->name || (to->places > 1 && !take_triangles(from, to))) return false;
    }
    return true;
}
