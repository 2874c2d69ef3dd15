// SPDX-License-Identifier: Apache-2.0
// Tables on a device, and crowds of objects to fill them.
#ifndef OCC_TEST_KIT_TABLE_H
#define OCC_TEST_KIT_TABLE_H

#include "kit_flat.h"
#include "obs.h"

#include <occlude/opencl.h>

// A scene's occluders without its objects, and whose they are.
typedef struct kit_crowd {
    obs_scene file;
    occ_scene *occluders;
    uint32_t *owners;
} kit_crowd;

kit_crowd kit_make_crowd(const char *name, uint32_t count);
void kit_free_crowd(kit_crowd *crowd);

// The i-th shape to try. PoCL 3.1 takes minutes to compile kernels with as many barriers as the
// wide ones have: there it is always the device's own.
occ_cl_shape kit_shape(int i);

occ_cl_table *kit_make_table(uint32_t capacity, occ_cl_shape shape);

// One frame on the device against the same in plain C: fails the test unless the masks are the
// same.
kit_flat_counts kit_table_compare(occ_cl_table *table, const kit_flat *rows, const kit_crowd *crowd,
                                  const occ_camera_desc *camera, const occ_cull_desc *knobs);

#endif
