// SPDX-License-Identifier: Apache-2.0
#include "library.h"

#include "progress.h"

#include <stdio.h>

static bool show_progress(float done, void *user_data)
{
    (void)user_data;
    progress_step((size_t)(done * (float)LIBRARY_STEPS));
    return true;
}

occ_soup_work library_work(void)
{
    return (occ_soup_work){.progress = show_progress};
}

bool library_succeeded(occ_result result, const char *what)
{
    if (result == OCC_SUCCESS) return true;
    fprintf(stderr, "occlude-bench: %s: %s (%s)\n", what, occ_result_message(result),
            occ_result_name(result));
    return false;
}

occ_soup library_soup(const model *m, const uint32_t (*corners)[3], uint32_t count)
{
    return (occ_soup){.positions = m->positions[0],
                      .vertex_count = m->vertex_count,
                      .indices = corners[0],
                      .triangle_count = count};
}

occ_soup library_mesh_soup(const model_mesh *mesh)
{
    return (occ_soup){.positions = mesh->positions[0],
                      .vertex_count = mesh->vertex_count,
                      .indices = mesh->corners[0],
                      .triangle_count = mesh->triangle_count};
}
