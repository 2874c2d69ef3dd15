// SPDX-License-Identifier: Apache-2.0
#include "model.h"

#include <stdlib.h>

const model_part *model_part_of(const model *m, uint32_t triangle)
{
    uint32_t low = 0, high = m->part_count;
    while (low < high) { // the first part that begins beyond the triangle
        uint32_t middle = low + (high - low) / 2;
        if (m->parts[middle].first <= triangle)
            low = middle + 1;
        else
            high = middle;
    }
    return low ? &m->parts[low - 1] : NULL;
}

bool model_is_instance(const model *m, const model_part *part)
{
    return part && m->meshes[part->mesh].places > 1 && part->count > 0;
}

void model_free(model *m)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        free(m->meshes[i].name);
        free(m->meshes[i].positions);
        free(m->meshes[i].corners);
    }
    for (uint32_t i = 0; i < m->material_count; i++)
        free(m->materials[i]);
    free(m->meshes);
    free(m->materials);
    free(m->parts);
    free(m->positions);
    free(m->corners);
    free(m->see_through);
    *m = (model){0};
}
