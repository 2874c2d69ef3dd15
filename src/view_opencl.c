// SPDX-License-Identifier: Apache-2.0
#include <occlude/opencl.h>

#include "cl_device.h"
#include "view_data.h"

occ_result occ_cl_view_create(const occ_view_desc *view_desc, const occ_cl_desc *desc,
                              occ_view **view)
{
    if (!view) return OCC_ERROR_INVALID_ARGUMENT;
    *view = NULL;
    occ_view_desc made = {.backend = OCC_BACKEND_OPENCL};
    if (view_desc) made = *view_desc;
    made.backend = OCC_BACKEND_OPENCL;
    return occ_view_make(&made, desc, view);
}

cl_device_id occ_cl_view_device(const occ_view *view)
{
    return view ? occ_backend_opencl_device(view->backend) : NULL;
}
