// SPDX-License-Identifier: Apache-2.0
/// @file
/// Views on an OpenCL device that the caller chose. The only header that needs <CL/cl.h>.
#ifndef OCCLUDE_OPENCL_H
#define OCCLUDE_OPENCL_H

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>

#include "cull.h"

/// Which device a view works on. All zero: the first GPU of any platform, else the first device.
typedef struct occ_cl_desc {
    cl_device_id device;    ///< Default: chosen as said above, or the queue's if a queue is given.
    cl_context context;     ///< Default: one of our own for `device`. Retained.
    cl_command_queue queue; ///< In order, of `context`. Default: one of our own. Retained.
} occ_cl_desc;

/// Makes a view whose objects are tested on an OpenCL device. `view_desc` may be NULL; its backend
/// is taken as OpenCL whatever it says. `desc` may be NULL. The view keeps the scene's boxes on the
/// device from one call of occ_cull() to the next and sends only what commits have changed.
OCC_API OCC_NODISCARD occ_result occ_cl_view_create(const occ_view_desc *view_desc,
                                                    const occ_cl_desc *desc, occ_view **view);

/// The device of a view, or NULL if the view has none.
OCC_API cl_device_id occ_cl_view_device(const occ_view *view);

#endif
