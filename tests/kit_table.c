// SPDX-License-Identifier: Apache-2.0
#include "kit_table.h"

#include "scenes.h"

#include <stdlib.h>
#include <string.h>

kit_crowd kit_make_crowd(const char *name, uint32_t count)
{
    kit_crowd made;
    ck_assert(scenes_make(name, count, 2, &made.file));
    uint32_t occluders = made.file.occluder_count;
    made.owners = calloc(occluders + 1, sizeof *made.owners);
    ck_assert_ptr_nonnull(made.owners);
    ck_assert_int_eq(occ_scene_create(NULL, &made.occluders), OCC_SUCCESS);
    for (uint32_t i = 0; i < occluders; i++) {
        occ_occluder handle;
        made.owners[i] = made.file.occluders[i].owner;
        ck_assert_int_eq(occ_scene_add_occluder(made.occluders, &made.file.occluders[i].box,
                                                (occ_object){0}, &handle),
                         OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(made.occluders), OCC_SUCCESS);
    return made;
}

void kit_free_crowd(kit_crowd *crowd)
{
    occ_scene_destroy(crowd->occluders);
    free(crowd->owners);
    obs_free(&crowd->file);
}

occ_cl_shape kit_shape(int i)
{
    cl_platform_id platform;
    char name[64] = "";
    ck_assert_int_eq(clGetPlatformIDs(1, &platform, NULL), CL_SUCCESS);
    (void)clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, NULL);
    if (strcmp(name, "Portable Computing Language") == 0) return OCC_CL_SHAPE_AUTO;
    return i % 2 ? OCC_CL_SHAPE_WIDE : OCC_CL_SHAPE_NARROW;
}

occ_cl_table *kit_make_table(uint32_t capacity, occ_cl_shape shape)
{
    occ_cl_table *table = NULL;
    occ_cl_table_desc desc = {.capacity = capacity, .shape = shape};
    occ_result result = occ_cl_table_create(&desc, &table);
    ck_assert_msg(result == OCC_SUCCESS, "%s", occ_result_name(result));
    return table;
}

// One frame on the device against the same in plain C.
kit_flat_counts kit_table_compare(occ_cl_table *table, const kit_flat *rows, const kit_crowd *crowd,
                                  const occ_camera_desc *camera, const occ_cull_desc *knobs)
{
    occ_cl_frame frame = {.occluders = crowd->occluders,
                          .owners = crowd->owners,
                          .camera = camera,
                          .knobs = knobs,
                          .outputs = OCC_CL_HOST_MASK};
    const uint32_t *words;
    size_t count;
    kit_flat_counts counts;
    ck_assert_int_eq(occ_cl_table_cull(table, &frame, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &count), OCC_SUCCESS);
    uint32_t *expected =
        kit_flat_mask(rows, crowd->occluders, crowd->owners, camera, knobs, &counts);
    ck_assert_uint_eq(count, OCC_MASK_WORDS(rows->count));
    for (size_t w = 0; w < count; w++)
        KIT_CHECK(words[w] == expected[w], "word %zu is %08x, plain C's %08x", w, words[w],
                  expected[w]);
    free(expected);
    return counts;
}
