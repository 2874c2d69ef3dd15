// SPDX-License-Identifier: Apache-2.0
#include "measure_build.h"

#include "timing.h"

#include <stdlib.h>

// A build's input, and how long each took.
typedef struct build_arrays {
    occ_object *objects, *owners;
    occ_box *boxes;
    occ_sheet *sheets;
    double *whole, *commit;
} build_arrays;

static occ_result fill_scene(const obs_scene *file, const build_arrays *arrays,
                             measure_build *build)
{
    build->step = "adding the objects";
    occ_result result =
        occ_scene_add_many(build->scene, file->objects, file->object_count, arrays->objects);
    if (result) return result;
    for (uint32_t i = 0; i < obs_occluder_total(file); i++) {
        uint32_t owner = obs_occluder_owner(file, i);
        arrays->owners[i] = owner == OBS_NO_OWNER ? (occ_object){0} : arrays->objects[owner];
    }
    build->step = "adding the occluders";
    uint32_t boxes = file->occluder_count;
    result = occ_scene_add_occluders(build->scene, arrays->boxes, arrays->owners, boxes, NULL);
    if (result) return result;
    build->step = "adding the sheets";
    return occ_scene_add_sheets(build->scene, arrays->sheets, arrays->owners + boxes,
                                file->sheet_count, NULL);
}

// Builds a fresh scene, the i-th.
static occ_result build_once(const obs_scene *file, const occ_scene_desc *desc,
                             const build_arrays *arrays, measure_build *build, uint32_t i)
{
    occ_scene_destroy(build->scene);
    build->step = "making the scene";
    occ_result result = occ_scene_create(desc, &build->scene);
    if (result) return result;
    double start = timing_now();
    result = fill_scene(file, arrays, build);
    if (result) return result;
    double added = timing_now();
    build->step = "committing the scene";
    result = occ_scene_commit(build->scene);
    arrays->commit[i] = timing_now() - added;
    arrays->whole[i] = timing_now() - start;
    return result;
}

static occ_result build_often(const obs_scene *file, const occ_scene_desc *desc, uint32_t builds,
                              const build_arrays *arrays, measure_build *build)
{
    for (uint32_t i = 0; i < file->occluder_count; i++)
        arrays->boxes[i] = file->occluders[i].box;
    for (uint32_t i = 0; i < file->sheet_count; i++)
        arrays->sheets[i] = file->sheets[i].sheet;
    occ_scene_desc reserving = *desc;
    reserving.object_count = file->object_count;
    reserving.occluder_count = obs_occluder_total(file);
    for (uint32_t i = 0; i < builds; i++) {
        occ_result result = build_once(file, &reserving, arrays, build, i);
        if (result) return result;
    }
    build->build_ms = timing_median(arrays->whole, builds);
    build->commit_ms = timing_median(arrays->commit, builds);
    return OCC_SUCCESS;
}

occ_result measure_building(const obs_scene *file, const occ_scene_desc *desc, uint32_t builds,
                            measure_build *build)
{
    size_t boxes = (size_t)file->occluder_count + 1, sheets = (size_t)file->sheet_count + 1;
    build_arrays arrays = {.objects = calloc((size_t)file->object_count + 1, sizeof(occ_object)),
                           .owners = calloc(boxes + sheets, sizeof(occ_object)),
                           .boxes = calloc(boxes, sizeof(occ_box)),
                           .sheets = calloc(sheets, sizeof(occ_sheet)),
                           .whole = calloc(builds, sizeof(double)),
                           .commit = calloc(builds, sizeof(double))};
    *build = (measure_build){.step = "building the scene"};
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    if (arrays.objects && arrays.owners && arrays.boxes && arrays.sheets && arrays.whole &&
        arrays.commit)
        result = build_often(file, desc, builds, &arrays, build);
    free(arrays.objects);
    free(arrays.owners);
    free(arrays.boxes);
    free(arrays.sheets);
    free(arrays.whole);
    free(arrays.commit);
    return result;
}
