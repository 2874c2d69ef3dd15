// SPDX-License-Identifier: Apache-2.0
#include "kit_cl.h"

#include <string.h>

kit_cl kit_cl_state;

void kit_cl_reset(void)
{
    kit_cl_state = (kit_cl){.live = kit_cl_state.live,
                            .buffer_bytes = kit_cl_state.buffer_bytes,
                            .in_flight = kit_cl_state.in_flight};
}

// Counts a call and says whether it is the one to fail.
static bool fails(const char *name)
{
    if (++kit_cl_state.calls != kit_cl_state.fail_at) return false;
    kit_cl_state.failed = name;
    kit_cl_state.failures++;
    return true;
}

// Counts what a call has made.
static void hold(cl_int error)
{
    kit_cl_state.live += error == CL_SUCCESS;
    kit_cl_state.created += error == CL_SUCCESS;
}

// Counts the event that a command was asked for.
static cl_int note(cl_int error, const cl_event *event)
{
    kit_cl_state.live += error == CL_SUCCESS && event;
    return error;
}

#define REAL(type, name, parameters)                                                               \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters

// A call that only asks or sets: it fails without having done anything.
#define WRAP(name, parameters, arguments)                                                          \
    REAL(cl_int, name, parameters)                                                                 \
    {                                                                                              \
        return fails(#name) ? kit_cl_state.code : __real_##name arguments;                         \
    }

// A call that returns an object and its error through the last parameter.
#define WRAP_CREATE(type, name, parameters, arguments)                                             \
    REAL(type, name, parameters)                                                                   \
    {                                                                                              \
        cl_int own, *where = error ? error : &own;                                                 \
        type made = NULL;                                                                          \
        *where = kit_cl_state.code;                                                                \
        if (!fails(#name)) made = __real_##name arguments;                                         \
        hold(*where);                                                                              \
        return made;                                                                               \
    }

// A release that fails has released all the same: there is no second try.
#define WRAP_RELEASE(name, type)                                                                   \
    REAL(cl_int, name, (type object))                                                              \
    {                                                                                              \
        bool failed = fails(#name);                                                                \
        cl_int error = __real_##name(object);                                                      \
        kit_cl_state.live -= error == CL_SUCCESS;                                                  \
        return failed ? kit_cl_state.code : error;                                                 \
    }

#define WRAP_RETAIN(name, type)                                                                    \
    REAL(cl_int, name, (type object))                                                              \
    {                                                                                              \
        cl_int error = fails(#name) ? kit_cl_state.code : __real_##name(object);                   \
        kit_cl_state.live += error == CL_SUCCESS;                                                  \
        return error;                                                                              \
    }

WRAP_RELEASE(clReleaseContext, cl_context)
WRAP_RELEASE(clReleaseCommandQueue, cl_command_queue)
WRAP_RELEASE(clReleaseProgram, cl_program)
WRAP_RELEASE(clReleaseKernel, cl_kernel)
WRAP_RETAIN(clRetainContext, cl_context)
WRAP_RETAIN(clRetainCommandQueue, cl_command_queue)

WRAP_CREATE(cl_context, clCreateContext,
            (const cl_context_properties *properties, cl_uint count, const cl_device_id *devices,
             void(CL_CALLBACK *notify)(const char *, const void *, size_t, void *), void *user_data,
             cl_int *error),
            (properties, count, devices, notify, user_data, where))
WRAP_CREATE(cl_command_queue, clCreateCommandQueue,
            (cl_context context, cl_device_id device, cl_command_queue_properties properties,
             cl_int *error),
            (context, device, properties, where))
WRAP_CREATE(cl_kernel, clCreateKernel, (cl_program program, const char *name, cl_int *error),
            (program, name, where))

WRAP(clBuildProgram,
     (cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
      void(CL_CALLBACK *notify)(cl_program, void *), void *user_data),
     (program, count, devices, options, notify, user_data))
WRAP(clGetProgramBuildInfo,
     (cl_program program, cl_device_id device, cl_program_build_info name, size_t size, void *value,
      size_t *needed),
     (program, device, name, size, value, needed))
WRAP(clGetCommandQueueInfo,
     (cl_command_queue queue, cl_command_queue_info name, size_t size, void *value, size_t *needed),
     (queue, name, size, value, needed))
WRAP(clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void *value),
     (kernel, index, size, value))

REAL(cl_program, clCreateProgramWithSource,
     (cl_context context, cl_uint count, const char **texts, const size_t *sizes, cl_int *error))
{
    static const char broken[] = "\n#line 1 \"broken.cl\"\nthis is no kernel;\n";
    const char *all[16];
    size_t lengths[16];
    ck_assert_uint_lt(count, 16);
    memcpy(all, texts, count * sizeof *all);
    memcpy(lengths, sizes, count * sizeof *lengths);
    all[count] = broken;
    lengths[count] = sizeof broken - 1;
    cl_program made = NULL;
    *error = kit_cl_state.code;
    if (!fails("clCreateProgramWithSource")) {
        made = __real_clCreateProgramWithSource(context, count + kit_cl_state.broken_kernels, all,
                                                lengths, error);
    }
    hold(*error);
    return made;
}

REAL(cl_mem, clCreateBuffer,
     (cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error))
{
    cl_mem made = NULL;
    *error = kit_cl_state.code;
    if (!fails("clCreateBuffer")) made = __real_clCreateBuffer(context, flags, size, host, error);
    hold(*error);
    if (made) kit_cl_state.buffer_bytes += size;
    return made;
}

REAL(cl_int, clReleaseMemObject, (cl_mem buffer))
{
    bool failed = fails("clReleaseMemObject");
    size_t size = 0;
    ck_assert_int_eq(clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof size, &size, NULL), CL_SUCCESS);
    cl_int error = __real_clReleaseMemObject(buffer);
    kit_cl_state.live -= error == CL_SUCCESS;
    kit_cl_state.buffer_bytes -= size;
    return failed ? kit_cl_state.code : error;
}

// --- what there is -------------------------------------------------------------------------------

REAL(cl_int, clGetPlatformIDs, (cl_uint room, cl_platform_id *platforms, cl_uint *count))
{
    if (fails("clGetPlatformIDs")) return kit_cl_state.code;
    if (kit_cl_state.no_platform) return -1001;
    cl_int error = __real_clGetPlatformIDs(room, platforms, count);
    if (kit_cl_state.zero_platforms) *count = 0;
    return error;
}

REAL(cl_int, clGetDeviceIDs,
     (cl_platform_id platform, cl_device_type type, cl_uint room, cl_device_id *devices,
      cl_uint *count))
{
    if (fails("clGetDeviceIDs")) return kit_cl_state.code;
    if (kit_cl_state.no_device) return CL_DEVICE_NOT_FOUND;
    return __real_clGetDeviceIDs(platform, type, room, devices, count);
}

REAL(cl_int, clGetDeviceInfo,
     (cl_device_id device, cl_device_info name, size_t size, void *value, size_t *needed))
{
    if (fails("clGetDeviceInfo")) return kit_cl_state.code;
    cl_int error = __real_clGetDeviceInfo(device, name, size, value, needed);
    if (kit_cl_state.largest && name == CL_DEVICE_MAX_MEM_ALLOC_SIZE) {
        memcpy(value, &kit_cl_state.largest, sizeof kit_cl_state.largest);
    }
    return error;
}

REAL(cl_int, clGetKernelWorkGroupInfo,
     (cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info name, size_t size,
      void *value, size_t *needed))
{
    if (fails("clGetKernelWorkGroupInfo")) return kit_cl_state.code;
    cl_int error = __real_clGetKernelWorkGroupInfo(kernel, device, name, size, value, needed);
    if (kit_cl_state.group && name == CL_KERNEL_WORK_GROUP_SIZE) {
        memcpy(value, &kit_cl_state.group, sizeof kit_cl_state.group);
    }
    return error;
}

// --- what goes through the queue -----------------------------------------------------------------

REAL(cl_int, clEnqueueWriteBuffer,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
      const void *from, cl_uint waits, const cl_event *wait_list, cl_event *event))
{
    if (fails("clEnqueueWriteBuffer")) return kit_cl_state.code;
    kit_cl_state.in_flight = blocking ? 0 : kit_cl_state.in_flight + 1;
    kit_cl_state.whole++;
    kit_cl_state.whole_bytes += size;
    return note(__real_clEnqueueWriteBuffer(queue, buffer, blocking, offset, size, from, waits,
                                            wait_list, event),
                event);
}

REAL(cl_int, clEnqueueWriteBufferRect,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocking, const size_t *origin,
      const size_t *host_origin, const size_t *region, size_t row_pitch, size_t slice_pitch,
      size_t host_row_pitch, size_t host_slice_pitch, const void *from, cl_uint waits,
      const cl_event *wait_list, cl_event *event))
{
    if (fails("clEnqueueWriteBufferRect")) return kit_cl_state.code;
    kit_cl_state.in_flight = blocking ? 0 : kit_cl_state.in_flight + 1;
    kit_cl_send *send = &kit_cl_state.row[kit_cl_state.rows++ % KIT_CL_SENDS];
    memcpy(send->origin, origin, sizeof send->origin);
    memcpy(send->region, region, sizeof send->region);
    return __real_clEnqueueWriteBufferRect(queue, buffer, blocking, origin, host_origin, region,
                                           row_pitch, slice_pitch, host_row_pitch, host_slice_pitch,
                                           from, waits, wait_list, event);
}

REAL(cl_int, clEnqueueNDRangeKernel,
     (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
      const size_t *global, const size_t *local, cl_uint waits, const cl_event *wait_list,
      cl_event *event))
{
    if (fails("clEnqueueNDRangeKernel")) return kit_cl_state.code;
    kit_cl_state.in_flight++;
    return note(__real_clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local,
                                              waits, wait_list, event),
                event);
}

REAL(cl_int, clEnqueueReadBuffer,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, void *to,
      cl_uint waits, const cl_event *wait_list, cl_event *event))
{
    if (fails("clEnqueueReadBuffer")) return kit_cl_state.code;
    kit_cl_state.in_flight = blocking ? 0 : kit_cl_state.in_flight + 1;
    return __real_clEnqueueReadBuffer(queue, buffer, blocking, offset, size, to, waits, wait_list,
                                      event);
}

REAL(cl_int, clEnqueueFillBuffer,
     (cl_command_queue queue, cl_mem buffer, const void *pattern, size_t pattern_size,
      size_t offset, size_t size, cl_uint waits, const cl_event *wait_list, cl_event *event))
{
    if (fails("clEnqueueFillBuffer")) return kit_cl_state.code;
    kit_cl_state.in_flight++;
    return note(__real_clEnqueueFillBuffer(queue, buffer, pattern, pattern_size, offset, size,
                                           waits, wait_list, event),
                event);
}

REAL(cl_int, clEnqueueMarkerWithWaitList,
     (cl_command_queue queue, cl_uint waits, const cl_event *wait_list, cl_event *event))
{
    if (fails("clEnqueueMarkerWithWaitList")) return kit_cl_state.code;
    return note(__real_clEnqueueMarkerWithWaitList(queue, waits, wait_list, event), event);
}

REAL(void *, clEnqueueMapBuffer,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags, size_t offset,
      size_t size, cl_uint waits, const cl_event *wait_list, cl_event *event, cl_int *error))
{
    void *mapped = NULL;
    *error = kit_cl_state.code;
    if (!fails("clEnqueueMapBuffer")) {
        mapped = __real_clEnqueueMapBuffer(queue, buffer, blocking, flags, offset, size, waits,
                                           wait_list, event, error);
    }
    kit_cl_state.live += *error == CL_SUCCESS;
    return mapped;
}

// As a release.
REAL(cl_int, clEnqueueUnmapMemObject,
     (cl_command_queue queue, cl_mem buffer, void *mapped, cl_uint waits, const cl_event *wait_list,
      cl_event *event))
{
    bool failed = fails("clEnqueueUnmapMemObject");
    cl_int error = __real_clEnqueueUnmapMemObject(queue, buffer, mapped, waits, wait_list, event);
    kit_cl_state.live -= error == CL_SUCCESS;
    return failed ? kit_cl_state.code : error;
}

WRAP_RELEASE(clReleaseEvent, cl_event)
WRAP(clFlush, (cl_command_queue queue), (queue))
WRAP(clGetEventProfilingInfo,
     (cl_event event, cl_profiling_info name, size_t size, void *value, size_t *needed),
     (event, name, size, value, needed))

REAL(cl_int, clWaitForEvents, (cl_uint count, const cl_event *events))
{
    bool failed = fails("clWaitForEvents");
    kit_cl_state.in_flight = 0;
    cl_int error = __real_clWaitForEvents(count, events);
    return failed ? kit_cl_state.code : error;
}

// Like a release: one that fails has waited all the same.
REAL(cl_int, clFinish, (cl_command_queue queue))
{
    bool failed = fails("clFinish");
    kit_cl_state.in_flight = 0;
    cl_int error = __real_clFinish(queue);
    return failed ? kit_cl_state.code : error;
}
