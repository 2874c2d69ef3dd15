// SPDX-License-Identifier: Apache-2.0
/// @file
/// Culls the frames of a scene file with one method and backend, and times it.
///
/// The time of a frame is what a user waits for: the call of occ_cull() (or of a peer), the copy of
/// the mask and the copy of the list of visible objects. All frames are culled once before anything
/// is timed; then they are culled in order, as often as `repeats` says, so that no frame finds its
/// own data in the caches.
#ifndef OCC_BENCH_MEASURE_H
#define OCC_BENCH_MEASURE_H

#include "obs.h"
#include "vis.h"

#include <occlude/cull.h>

/// What to run. measure_defaults() begins it, measure_complete() ends it.
typedef struct measure_settings {
    const char *method;  ///< frustum, pairwise, single, or a peer's (peer.h).
    const char *backend; ///< plain, openmp or opencl. NULL: measure_complete() chooses.
    uint32_t threads;    ///< Of the OpenMP backend. 0: as many as processors.
    uint32_t rays_width, rays_height; ///< Of embree-depth's buffer.
    uint32_t repeats;                 ///< Timed culls of each frame.
    uint32_t every;                   ///< Only every so-manieth frame.
    uint32_t builds;                  ///< How often the scene is built, from nothing each time.
    occ_cull_desc knobs;              ///< Its `method` follows from the name.
} measure_settings;

/// A frame's figures. Times are medians over its repeats, which follow each other, in milliseconds.
typedef struct measure_frame {
    uint32_t index; ///< In the file.
    double ms, walk_ms, test_ms;
    double moved_ms; ///< Once, right after the frame before it in the file.
    uint32_t in_frustum;
    occ_view_stats stats; ///< For a peer only objects, tested, visible and times are set.
} measure_frame;

/// What came out. measure_free() it when done.
typedef struct measure_result {
    uint32_t frame_count, threads;
    measure_frame *frames;
    vis_result verdicts; ///< One row for each entry of `frames`.
    /// Adding and committing all objects and occluders (or a peer's likewise), and the commit
    /// alone: medians over the builds.
    double build_ms, commit_ms;
    uint64_t scene_bytes, view_bytes, device_bytes; ///< As the library or the peer says.
    uint64_t held_bytes;        ///< As the allocator hooks count: scene and view together.
    uint64_t timed_allocations; ///< Seen by the allocator hooks while frames were timed.
    char driver[256];           ///< The OpenCL device and its driver, Embree, or "none".
} measure_result;

/// Method fused, the OpenMP backend, five repeats, every frame.
measure_settings measure_defaults(void);

/// Chooses the backend where none is named. Returns NULL, or what is wrong with the names.
const char *measure_complete(measure_settings *settings);

/// NULL, or why this method should not be run on this scene: a quadratic one on a large scene.
const char *measure_warning(const measure_settings *settings, const obs_scene *scene);

/// The library's method of that name. False if it is not one of the library's.
bool measure_method(const char *name, occ_method *method);

/// The preset of that name: fast, balanced or thorough. False if there is none.
bool measure_preset(const char *name, occ_preset *preset);

/// The backend of that name: plain, openmp or opencl. False if there is none.
bool measure_backend(const char *name, occ_backend *backend);

/// occ_cull() with the camera of a file's frame.
occ_result measure_cull(occ_view *view, const occ_scene *scene, const obs_frame *frame,
                        const occ_cull_desc *knobs);

/// Runs. On failure says why on standard error, zeroes `result` and returns false.
bool measure_run(const measure_settings *settings, const obs_scene *scene, measure_result *result);

void measure_free(measure_result *result);

/// Median, 99th percentile, and mean counts over the frames.
typedef struct measure_summary {
    double median_ms, p99_ms, max_ms, walk_ms, test_ms, moved_ms;
    double in_frustum, visible, tested;
} measure_summary;

/// False when memory runs out.
bool measure_summarize(const measure_result *result, measure_summary *summary);

#endif
