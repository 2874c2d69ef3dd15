// SPDX-License-Identifier: Apache-2.0
// A kernel with a data race, one past the end of its buffer, one that reads what nobody wrote, and
// a call with a wrong argument: what oclgrind has to report.

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
#include <string.h>

enum { ITEMS = 16 };

static const char *const source =
    "__kernel void clean(__global int *o) { o[get_global_id(0)] = (int)get_global_id(0); }\n"
    "__kernel void race(__global int *o) { o[0] = (int)get_global_id(0); }\n"
    "__kernel void overflow(__global int *o) { o[get_global_id(0) + 1] = 1; }\n"
    "__kernel void uninitialized(__global int *o) { if (o[get_global_id(0)] > 0) o[0] = 1; }\n"
    "__kernel void argument(__global int *o) { o[get_global_id(0)] = 0; }\n";

static cl_int run_kernel(cl_device_id device, const char *name)
{
    cl_int error = CL_SUCCESS;
    cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, &error);
    cl_program program =
        clCreateProgramWithSource(context, 1, (const char **)&source, NULL, &error);
    clBuildProgram(program, 1, &device, "", NULL, NULL);
    cl_kernel kernel = clCreateKernel(program, name, &error);
    if (error != CL_SUCCESS) {
        return error;
    }
    cl_mem memory = clCreateBuffer(context, CL_MEM_READ_WRITE, ITEMS * sizeof(int), NULL, &error);
    clSetKernelArg(kernel, 0, sizeof memory, &memory);
    if (strcmp(name, "argument") == 0) {
        clSetKernelArg(kernel, 1, sizeof memory, &memory);
    }
    const size_t items = ITEMS;
    error = clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &items, &items, 0, NULL, NULL);
    int out[ITEMS];
    clEnqueueReadBuffer(queue, memory, CL_TRUE, 0, sizeof out, out, 0, NULL, NULL);
    clReleaseMemObject(memory);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    return error;
}

int main(int argc, char **argv)
{
    cl_platform_id platform;
    cl_device_id device;
    if (argc != 2 || clGetPlatformIDs(1, &platform, NULL) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL) != CL_SUCCESS) {
        fprintf(stderr, "no device\n");
        return 2;
    }
    cl_int error = run_kernel(device, argv[1]);
    printf("%s: %d\n", argv[1], error);
    return error == CL_SUCCESS ? 0 : 2;
}
