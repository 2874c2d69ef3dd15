// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "model.h"

#include "model_import.h"

#include <assimp/GltfMaterial.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <errno.h>
#include <fnmatch.h>
#include <math.h>
#include <occlude/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// An affine map in double: rows of a 3 x 4 matrix.
typedef struct transform {
    double m[3][4];
} transform;

typedef struct import {
    const char *path;
    const model_options *options;
    const struct aiScene *scene;
    model *out;
    uint32_t *slots; // Hash table over the vertices; UINT32_MAX is free.
    size_t slot_mask;
    size_t vertex_room, triangle_room;
} import;

static bool out_of_memory(const char *path)
{
    fprintf(stderr, "occlude-bench: %s: out of memory\n", path);
    return false;
}

static transform compose(const transform *parent, const struct aiMatrix4x4 *local)
{
    const double b[3][4] = {
        {(double)local->a1, (double)local->a2, (double)local->a3, (double)local->a4},
        {(double)local->b1, (double)local->b2, (double)local->b3, (double)local->b4},
        {(double)local->c1, (double)local->c2, (double)local->c3, (double)local->c4}};
    transform out;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            double sum = c == 3 ? parent->m[r][3] : 0.0;
            for (int k = 0; k < 3; k++)
                sum += parent->m[r][k] * b[k][c];
            out.m[r][c] = sum;
        }
    return out;
}

// The world position of a vertex; adding +0 turns -0 into +0, so that equal numbers have equal
// bits.
static void place(const transform *t, const struct aiVector3D *v, float out[3])
{
    const double p[3] = {(double)v->x, (double)v->y, (double)v->z};
    for (int r = 0; r < 3; r++) {
        double sum = t->m[r][0] * p[0] + t->m[r][1] * p[1] + t->m[r][2] * p[2] + t->m[r][3];
        out[r] = (float)sum + 0.0f;
    }
}

static size_t hash_position(const float p[3])
{
    uint32_t bits[3];
    memcpy(bits, p, sizeof bits);
    uint64_t h = 0x9E3779B97F4A7C15u;
    for (int k = 0; k < 3; k++) {
        h ^= bits[k];
        h *= 0xBF58476D1CE4E5B9u;
        h ^= h >> 29;
    }
    return (size_t)h;
}

static uint32_t weld(import *in, const float p[3])
{
    model *out = in->out;
    size_t slot = hash_position(p) & in->slot_mask;
    while (in->slots[slot] != UINT32_MAX) {
        const float *q = out->positions[in->slots[slot]];
        if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) return in->slots[slot];
        slot = (slot + 1) & in->slot_mask;
    }
    in->slots[slot] = out->vertex_count;
    memcpy(out->positions[out->vertex_count], p, 3 * sizeof(float));
    return out->vertex_count++;
}

static bool matches(const import *in, const char *name)
{
    for (size_t i = 0; i < in->options->see_through_count; i++)
        if (fnmatch(in->options->see_through[i], name, 0) == 0) return true;
    return false;
}

static bool float_key_is(const struct aiMaterial *material, const char *key, float opaque)
{
    ai_real value = opaque;
    if (aiGetMaterialFloat(material, key, 0, 0, &value) != aiReturn_SUCCESS) return true;
    return value == opaque;
}

static bool is_opaque(const struct aiMaterial *material)
{
    if (!float_key_is(material, "$mat.opacity", 1.0f)) return false;
    if (!float_key_is(material, "$mat.transmission.factor", 0.0f)) return false;
    if (aiGetMaterialTextureCount(material, aiTextureType_OPACITY) != 0) return false;
    struct aiString mode;
    if (aiGetMaterialString(material, AI_MATKEY_GLTF_ALPHAMODE, &mode) != aiReturn_SUCCESS)
        return true;
    return strcmp(mode.data, "OPAQUE") == 0;
}

static bool is_see_through(const import *in, const struct aiMesh *mesh)
{
    if (matches(in, mesh->mName.data)) return true;
    if (mesh->mMaterialIndex >= in->scene->mNumMaterials) return false;
    const struct aiMaterial *material = in->scene->mMaterials[mesh->mMaterialIndex];
    struct aiString name;
    if (aiGetMaterialString(material, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS &&
        matches(in, name.data)) {
        return true;
    }
    return !is_opaque(material);
}

static bool check_position(const import *in, const struct aiMesh *mesh, unsigned vertex,
                           const float p[3])
{
    for (int k = 0; k < 3; k++) {
        if (fabsf(p[k]) <= OCC_MAX_COORDINATE) continue; // false for NaN
        fprintf(stderr,
                "occlude-bench: %s: mesh \"%s\", vertex %u: %c is %g, expected a number between "
                "-%g and %g\n",
                in->path, mesh->mName.data, vertex, "xyz"[k], (double)p[k],
                (double)OCC_MAX_COORDINATE, (double)OCC_MAX_COORDINATE);
        return false;
    }
    return true;
}

static bool take_face(import *in, const struct aiMesh *mesh, const transform *t, unsigned face,
                      bool see_through)
{
    const struct aiFace *f = &mesh->mFaces[face];
    model *out = in->out;
    if (f->mNumIndices != 3) {
        out->skipped_faces++;
        return true;
    }
    uint32_t *corners = out->corners[out->triangle_count];
    for (int k = 0; k < 3; k++) {
        float p[3];
        if (f->mIndices[k] >= mesh->mNumVertices) {
            fprintf(stderr, "occlude-bench: %s: mesh \"%s\", face %u: no vertex %u among %u\n",
                    in->path, mesh->mName.data, face, f->mIndices[k], mesh->mNumVertices);
            return false;
        }
        place(t, &mesh->mVertices[f->mIndices[k]], p);
        if (!check_position(in, mesh, f->mIndices[k], p)) return false;
        corners[k] = weld(in, p);
    }
    out->see_through[out->triangle_count++] = see_through;
    out->see_through_count += see_through;
    return true;
}

static bool take_mesh(import *in, unsigned number, const transform *t)
{
    const struct aiMesh *mesh = number < in->scene->mNumMeshes ? in->scene->mMeshes[number] : NULL;
    if (!mesh || (mesh->mNumFaces && (!mesh->mFaces || !mesh->mVertices))) {
        fprintf(stderr, "occlude-bench: %s: mesh %u of %u has no vertices\n", in->path, number,
                in->scene->mNumMeshes);
        return false;
    }
    bool see_through = is_see_through(in, mesh);
    model_part *part = &in->out->parts[in->out->part_count++];
    *part = (model_part){.mesh = number, .first = in->out->triangle_count};
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++)
            part->matrix[4 * c + r] = r < 3 ? (float)t->m[r][c] : c == 3 ? 1.0f : 0.0f;
    for (unsigned f = 0; f < mesh->mNumFaces; f++)
        if (!take_face(in, mesh, t, f, see_through)) return false;
    part->count = in->out->triangle_count - part->first;
    return true;
}

static bool take_node(import *in, const struct aiNode *node, const transform *parent)
{
    transform t = compose(parent, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (!take_mesh(in, node->mMeshes[i], &t)) return false;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!take_node(in, node->mChildren[i], &t)) return false;
    return true;
}

// Adds up what the nodes name.
static void count_named(const struct aiScene *scene, const struct aiNode *node, size_t *faces,
                        size_t *parts)
{
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] < scene->mNumMeshes)
            *faces += scene->mMeshes[node->mMeshes[i]]->mNumFaces;
    *parts += node->mNumMeshes;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        count_named(scene, node->mChildren[i], faces, parts);
}

static bool reserve(import *in)
{
    size_t faces = 0, parts = 0;
    count_named(in->scene, in->scene->mRootNode, &faces, &parts);
    if (faces > UINT32_MAX / 4) {
        fprintf(stderr, "occlude-bench: %s: %zu faces, expected at most %u\n", in->path, faces,
                UINT32_MAX / 4);
        return false;
    }
    size_t slots = 64;
    while (slots < 6 * faces)
        slots *= 2;
    size_t room = faces ? faces : 1;
    in->slot_mask = slots - 1;
    in->slots = malloc(slots * sizeof *in->slots);
    in->out->positions = calloc(3 * room, sizeof *in->out->positions);
    in->out->corners = malloc(room * sizeof *in->out->corners);
    in->out->see_through = malloc(room * sizeof *in->out->see_through);
    in->out->parts = calloc(parts + 1, sizeof *in->out->parts);
    if (!in->slots || !in->out->positions || !in->out->corners || !in->out->see_through ||
        !in->out->parts) {
        return out_of_memory(in->path);
    }
    memset(in->slots, 0xFF, slots * sizeof *in->slots);
    return true;
}

static void measure(model *m)
{
    for (int k = 0; k < 3; k++) {
        m->min[k] = INFINITY;
        m->max[k] = -INFINITY;
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            m->min[k] = fminf(m->min[k], m->positions[v][k]);
            m->max[k] = fmaxf(m->max[k], m->positions[v][k]);
        }
    }
}

static bool is_gltf(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0);
}

static model_up guess_up(const char *path, const model *m)
{
    if (is_gltf(path)) return MODEL_UP_Y;
    return m->max[2] - m->min[2] < m->max[1] - m->min[1] ? MODEL_UP_Z : MODEL_UP_Y;
}

// Turns z up to y up: a change of names and a sign, so nothing is rounded.
static void set_upright(import *in)
{
    model *m = in->out;
    m->up = in->options->up;
    if (m->up == MODEL_UP_GUESS) m->up = guess_up(in->path, m);
    if (m->up == MODEL_UP_Y) return;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        float y = m->positions[v][1];
        m->positions[v][1] = m->positions[v][2];
        m->positions[v][2] = 0.0f - y;
    }
    for (uint32_t i = 0; i < m->part_count; i++)
        for (int c = 0; c < 4; c++) {
            float *column = m->parts[i].matrix + 4 * (size_t)c;
            float y = column[1];
            column[1] = column[2];
            column[2] = 0.0f - y;
        }
    measure(m);
}

static bool has_extent(const import *in)
{
    for (int k = 0; k < 3; k++)
        if (in->out->min[k] < in->out->max[k]) return true;
    fprintf(stderr, "occlude-bench: %s: all of it is one point\n", in->path);
    return false;
}

static bool take_scene(import *in)
{
    static const transform identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const struct aiNode *root = in->scene->mRootNode;
    bool done = root && reserve(in) && take_node(in, root, &identity);
    free(in->slots);
    if (done && !model_take_meshes(in->scene, in->out)) return out_of_memory(in->path);
    if (done && in->out->triangle_count == 0) {
        fprintf(stderr, "occlude-bench: %s: no triangles in it\n", in->path);
        return false;
    }
    if (!done) return false;
    measure(in->out);
    set_upright(in);
    return has_extent(in);
}

bool model_read(const char *path, const model_options *options, model *out)
{
    static const model_options nothing = {0};
    *out = (model){0};
    FILE *probe = fopen(path, "rb");
    if (!probe) {
        fprintf(stderr, "occlude-bench: %s: %s\n", path, strerror(errno));
        return false;
    }
    fclose(probe);
    const struct aiScene *scene = aiImportFile(path, aiProcess_Triangulate);
    if (!scene) {
        fprintf(stderr, "occlude-bench: %s: %s\n", path, aiGetErrorString());
        return false;
    }
import in = {.path = path, .options = options ? options: & nothing, .scene = scene, .out = out };
    bool done = take_scene(&in);
    aiReleaseImport(scene);
    if (!done) model_free(out);
    return done;
}
