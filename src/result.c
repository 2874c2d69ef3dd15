// SPDX-License-Identifier: Apache-2.0
#include <occlude/base.h>

typedef struct result_text {
    occ_result result;
    const char *name;
    const char *message;
} result_text;

static const result_text texts[] = {
    {OCC_SUCCESS, "OCC_SUCCESS", "all is well"},
    {OCC_ERROR_INVALID_ARGUMENT, "OCC_ERROR_INVALID_ARGUMENT",
     "an argument is NULL or has a value that is not allowed"},
    {OCC_ERROR_NOT_FINITE, "OCC_ERROR_NOT_FINITE", "a number is NaN or infinite"},
    {OCC_ERROR_OUT_OF_RANGE, "OCC_ERROR_OUT_OF_RANGE",
     "a coordinate is larger than OCC_MAX_COORDINATE"},
    {OCC_ERROR_STALE_HANDLE, "OCC_ERROR_STALE_HANDLE",
     "the handle names nothing that is in this scene now"},
    {OCC_ERROR_OUT_OF_MEMORY, "OCC_ERROR_OUT_OF_MEMORY",
     "the allocator or the device has no more memory"},
    {OCC_ERROR_BUFFER_TOO_SMALL, "OCC_ERROR_BUFFER_TOO_SMALL",
     "the array passed in is too short for the result"},
    {OCC_ERROR_NOT_COMMITTED, "OCC_ERROR_NOT_COMMITTED",
     "the scene has edits that were not committed"},
    {OCC_ERROR_DEGENERATE_CAMERA, "OCC_ERROR_DEGENERATE_CAMERA",
     "the view-projection matrix is singular"},
    {OCC_ERROR_UNSUPPORTED, "OCC_ERROR_UNSUPPORTED", "this build of the library cannot do that"},
    {OCC_ERROR_NO_DEVICE, "OCC_ERROR_NO_DEVICE", "there is no OpenCL device"},
    {OCC_ERROR_KERNEL_BUILD, "OCC_ERROR_KERNEL_BUILD",
     "the device's compiler did not accept a kernel"},
    {OCC_ERROR_DEVICE, "OCC_ERROR_DEVICE", "the device failed or was lost"},
    {OCC_ERROR_LIMIT, "OCC_ERROR_LIMIT", "there are more items than a 32-bit index can name"},
    {OCC_ERROR_CORRUPT, "OCC_ERROR_CORRUPT", "an invariant of the scene is broken"},
    {OCC_ERROR_NO_RESULT, "OCC_ERROR_NO_RESULT", "nothing was culled with this view yet"},
    {OCC_ERROR_NOT_INSIDE, "OCC_ERROR_NOT_INSIDE", "the box is not where it was claimed to be"},
    {OCC_ERROR_CANCELLED, "OCC_ERROR_CANCELLED", "the caller stopped the work"},
};

static const result_text *find(occ_result result)
{
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        if (texts[i].result == result) return &texts[i];
    }
    return NULL;
}

const char *occ_result_name(occ_result result)
{
    const result_text *text = find(result);
    return text ? text->name : "OCC_UNKNOWN";
}

const char *occ_result_message(occ_result result)
{
    const result_text *text = find(result);
    return text ? text->message : "the number is no result of this library";
}

int occ_version(void)
{
    return OCC_VERSION;
}
