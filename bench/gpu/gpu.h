// SPDX-License-Identifier: Apache-2.0
/// @file
/// Measuring the tables of opencl.h.
#ifndef OCC_BENCH_GPU_H
#define OCC_BENCH_GPU_H

#include "obs.h"
#include "vis.h"

#include <occlude/opencl.h>

/// What is measured.
typedef struct gpu_settings {
    uint32_t repeats; ///< Of each frame.
    uint32_t every;   ///< Only each so-many-th frame.
    uint32_t devices; ///< Sub-devices that the table is spread over; 1: the device as it is.
    uint32_t strips;  // 0: as many as a table has by default
    bool arrange;     ///< Along an octree's curve rather than as the scene has them.
    bool move;        ///< All boxes travel in every frame.
    occ_cull_desc knobs;
} gpu_settings;

/// What came out. Milliseconds are medians over the frames of medians over their repeats.
typedef struct gpu_result {
    char device[256];
    double fill_ms;    ///< From the caller's boxes to a table that can be culled.
    double frame_ms;   ///< From the call to the mask on the host.
    double p99_ms;     ///< Of the frames.
    double walk_ms;    ///< Of it: choosing occluders on the host.
    double enqueue_ms; ///< Of it: the rest of the call.
    double blocks_ms, objects_ms, fusion_ms; ///< The kernels, by events.
    double copy_gbs;                         ///< Device to device, bytes read and written.
    double pinned_gbs;                       ///< Pinned host memory to the device.
    double move_gbs;  ///< Boxes sent, over the whole frame's time; 0 without `move`.
    double occluders; ///< Used, mean over the frames.
    double visible;   ///< Mean over the frames.
    uint64_t device_bytes;
    uint64_t hash; ///< FNV-1a over the masks of all frames.
    uint32_t frames;
} gpu_result;

/// Culls every frame of a scene with a table on the device that a view would choose. `masks` (may
/// be NULL) receives the verdicts. On failure says why and returns false.
bool gpu_measure(const obs_scene *scene, const gpu_settings *settings, gpu_result *result,
                 vis_result *masks);

/// Copy rates in GB/s of a queue's device: within it, and to it from pinned memory. Both 0 if it
/// cannot.
void gpu_copy_rates(cl_command_queue queue, double *copy, double *pinned);

#endif
