// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "measure.h"

#include "build_info.h"
#include "counting.h"
#include "measure_build.h"
#include "peer.h"
#include "progress.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Everything that lives while a scene is measured.
typedef struct measure_bench {
    const obs_scene *file;
    const measure_settings *settings;
    measure_result *result;
    counting_heap heap;
    occ_scene *scene;
    occ_view *view;
    occ_cull_desc knobs;
    uint32_t *mask, *list;
    double *times;           // [3][repeat] of a frame: whole, walk, test
    const peer_method *peer; // NULL: the library's own
    void *peer_state;
    uint64_t peer_bytes;
} measure_bench;

measure_settings measure_defaults(void)
{
    return (measure_settings){.method = "fused",
                              .repeats = 5,
                              .every = 1,
                              .builds = 1,
                              .rays_width = 85,
                              .rays_height = 48};
}

static bool find_method(const char *name, occ_method *method)
{
    static const char *const names[] = {"single", "frustum", "pairwise", "fused"};
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_FRUSTUM, OCC_METHOD_PAIRWISE,
                                         OCC_METHOD_FUSED};
    for (int i = 0; i < 4; i++)
        if (strcmp(name, names[i]) == 0) {
            *method = methods[i];
            return true;
        }
    return false;
}

bool measure_method(const char *name, occ_method *method)
{
    return find_method(name, method);
}

bool measure_preset(const char *name, occ_preset *preset)
{
    static const char *const names[] = {"balanced", "fast", "thorough"};
    static const occ_preset presets[] = {OCC_PRESET_BALANCED, OCC_PRESET_FAST, OCC_PRESET_THOROUGH};
    for (int i = 0; i < 3; i++)
        if (strcmp(name, names[i]) == 0) {
            *preset = presets[i];
            return true;
        }
    return false;
}

bool measure_backend(const char *name, occ_backend *backend)
{
    static const char *const names[] = {"openmp", "plain", "opencl"};
    static const occ_backend backends[] = {OCC_BACKEND_OPENMP, OCC_BACKEND_PLAIN,
                                           OCC_BACKEND_OPENCL};
    for (int i = 0; i < 3; i++)
        if (strcmp(name, names[i]) == 0) {
            *backend = backends[i];
            return true;
        }
    return false;
}

const char *measure_complete(measure_settings *settings)
{
    occ_method method;
    occ_backend backend;
    const peer_method *peer = peer_find(settings->method);
    if (!settings->backend) settings->backend = peer ? "plain" : "openmp";
    if (!peer && !find_method(settings->method, &method))
        return "expected frustum, thesis, embree-depth, embree-rays, pairwise, single or fused "
               "after "
               "--method";
    if (!measure_backend(settings->backend, &backend))
        return "expected plain, openmp or opencl after --backend";
    if (peer && peer->missing) return "built without Embree 3, which this method needs";
    if (!peer || backend == OCC_BACKEND_PLAIN) return NULL;
    if (!peer->takes_threads) return "the thesis's method runs on --backend plain alone";
    return backend == OCC_BACKEND_OPENMP ? NULL : "Embree runs on --backend plain or openmp alone";
}

const char *measure_warning(const measure_settings *settings, const obs_scene *scene)
{
    double objects = scene->object_count, occluders = obs_occluder_total(scene);
    const peer_method *peer = peer_find(settings->method);
    if (peer && peer->is_quadratic && objects > 5000)
        return "the thesis's method tries all pairs of objects: --force runs it on more than 5000";
    if (strcmp(settings->method, "pairwise") == 0 && objects * occluders > 1e9)
        return "pairwise tries all pairs: --force runs it on more than 1e9 of them";
    return NULL;
}

static uint32_t thread_count(const measure_settings *settings)
{
    if (strcmp(settings->backend, "openmp") != 0) return 1;
    if (settings->threads > 0) return settings->threads;
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return processors > 0 ? (uint32_t)processors : 1;
}

static void print_log_line(occ_log_level level, const char *line, void *user_data)
{
    (void)user_data;
    if (level != OCC_LOG_INFO) fprintf(stderr, "occlude: %s\n", line);
}

static bool succeeded(occ_result result, const char *what)
{
    if (result == OCC_SUCCESS) return true;
    fprintf(stderr, "occlude-bench: %s: %s (%s)\n", what, occ_result_message(result),
            occ_result_name(result));
    return false;
}

static bool is_out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

// --- building ------------------------------------------------------------------------------------

static bool build_scene(measure_bench *bench)
{
    occ_scene_desc desc = {.allocator = counting_allocator(&bench->heap),
                           .logger = {print_log_line, NULL},
                           .threads = bench->result->threads};
    measure_build build;
    occ_result result = measure_building(bench->file, &desc, bench->settings->builds, &build);
    bench->scene = build.scene;
    bench->result->build_ms = build.build_ms;
    bench->result->commit_ms = build.commit_ms;
    return succeeded(result, build.step);
}

static bool make_view(measure_bench *bench)
{
    occ_view_desc desc = {.allocator = counting_allocator(&bench->heap),
                          .logger = {print_log_line, NULL},
                          .threads = bench->result->threads};
    if (!measure_backend(bench->settings->backend, &desc.backend)) return false;
    if (!succeeded(occ_view_create(&desc, &bench->view), "making the view")) return false;
    build_info_device(bench->view, bench->result->driver, sizeof bench->result->driver);
    return true;
}

static bool open_peer(measure_bench *bench)
{
    measure_result *result = bench->result;
    const measure_settings *settings = bench->settings;
    const peer_options options = {.threads = result->threads,
                                  .rays_width = settings->rays_width,
                                  .rays_height = settings->rays_height};
    peer_info info = {0};
    double start = timing_now();
    bench->peer_state = bench->peer->open(bench->file, &options, &info);
    if (!bench->peer_state) return false;
    result->build_ms = timing_now() - start;
    bench->peer_bytes = info.bytes;
    if (info.driver[0]) snprintf(result->driver, sizeof result->driver, "%s", info.driver);
    return true;
}

// --- culling -------------------------------------------------------------------------------------

occ_result measure_cull(occ_view *view, const occ_scene *scene, const obs_frame *frame,
                        const occ_cull_desc *knobs)
{
    double eye[3] = {(double)frame->eye[0], (double)frame->eye[1], (double)frame->eye[2]};
    occ_camera_desc camera = {.eye = eye};
    obs_view_projection(frame, camera.view_projection);
    return occ_cull(view, scene, &camera, knobs);
}

// Returns the number of visible objects.
static size_t list_from_mask(const uint32_t *mask, uint32_t count, uint32_t *list)
{
    size_t visible = 0, words = OCC_MASK_WORDS(count);
    for (size_t word = 0; word < words; word++)
        for (uint32_t left = mask[word]; left != 0; left &= left - 1)
            list[visible++] = (uint32_t)(32 * word) + (uint32_t)__builtin_ctz(left);
    return visible;
}

static void cull_as_peer(measure_bench *bench, const obs_frame *frame, measure_frame *row)
{
    uint32_t count = bench->file->object_count;
    row->stats = (occ_view_stats){.objects = count};
    double start = timing_now();
    bench->peer->cull(bench->peer_state, frame, bench->mask, &row->stats);
    row->stats.visible = (uint32_t)list_from_mask(bench->mask, count, bench->list);
    row->ms = timing_now() - start;
}

// One cull with its hand-over, timed into `row`.
static bool cull_once(measure_bench *bench, measure_frame *row)
{
    const obs_frame *frame = &bench->file->frames[row->index];
    if (bench->peer) {
        cull_as_peer(bench, frame, row);
        return true;
    }
    size_t words, visible = 0, capacity = bench->file->object_count;
    double start = timing_now();
    occ_result result = measure_cull(bench->view, bench->scene, frame, &bench->knobs);
    if (result == OCC_SUCCESS)
        result = occ_view_read_mask(bench->view, bench->mask, OCC_MASK_WORDS(capacity), &words);
    if (result == OCC_SUCCESS)
        result = occ_view_read_visible(bench->view, bench->list, capacity, &visible);
    row->ms = timing_now() - start;
    if (result == OCC_SUCCESS) result = occ_view_get_stats(bench->view, &row->stats);
    if (!succeeded(result, "culling")) return false;
    return true;
}

static bool count_in_frustum(measure_bench *bench)
{
    const occ_view_desc desc = {.logger = {print_log_line, NULL}, .backend = OCC_BACKEND_PLAIN};
    const occ_cull_desc frustum = {.method = OCC_METHOD_FRUSTUM};
    occ_view *view;
    if (!succeeded(occ_view_create(&desc, &view), "making a view")) return false;
    bool good = true;
    for (uint32_t i = 0; good && i < bench->result->frame_count; i++) {
        measure_frame *row = &bench->result->frames[i];
        occ_view_stats stats = {0};
        occ_result result =
            measure_cull(view, bench->scene, &bench->file->frames[row->index], &frustum);
        if (result == OCC_SUCCESS) result = occ_view_get_stats(view, &stats);
        good = succeeded(result, "culling by the frustum");
        row->in_frustum = stats.visible;
    }
    occ_view_destroy(view);
    return good;
}

// The first pass: untimed, and its masks are what the timed ones must equal.
static bool warm_up(measure_bench *bench)
{
    measure_result *result = bench->result;
    for (uint32_t i = 0; i < result->frame_count; i++) {
        if (!cull_once(bench, &result->frames[i])) return false;
        vis_set_frame(&result->verdicts, i, bench->mask);
    }
    return true;
}

static bool equals_first_pass(const measure_bench *bench, uint32_t frame)
{
    uint32_t different = vis_differences(&bench->result->verdicts, frame, bench->mask);
    if (different == 0) return true;
    fprintf(stderr, "occlude-bench: frame %u: %u objects got another verdict when repeated\n",
            bench->result->frames[frame].index, different);
    return false;
}

// A frame right after another one, and then again and again.
static bool time_frame(measure_bench *bench, uint32_t i)
{
    measure_frame *frame = &bench->result->frames[i];
    uint32_t repeats = bench->settings->repeats;
    for (uint32_t r = 0; r <= repeats; r++) {
        uint64_t before = bench->heap.calls;
        if (!cull_once(bench, frame)) return false;
        bench->result->timed_allocations += bench->heap.calls - before;
        if (!equals_first_pass(bench, i)) return false;
        progress_step((size_t)i * (repeats + 1) + r + 1);
        if (!r) {
            frame->moved_ms = frame->ms;
            continue;
        }
        bench->times[r - 1] = frame->ms;
        bench->times[repeats + r - 1] = frame->stats.walk_ms;
        bench->times[2 * repeats + r - 1] = frame->stats.test_ms;
    }
    frame->ms = timing_median(bench->times, repeats);
    frame->walk_ms = timing_median(bench->times + repeats, repeats);
    frame->test_ms = timing_median(bench->times + 2 * (size_t)repeats, repeats);
    return true;
}

static bool time_frames(measure_bench *bench)
{
    for (uint32_t i = 0; i < bench->result->frame_count; i++)
        if (!time_frame(bench, i)) return false;
    return true;
}

static bool ask_for_sizes(measure_bench *bench)
{
    measure_result *result = bench->result;
    if (bench->peer) { // the library's scene was only there to count what is in the frustum
        result->scene_bytes = result->held_bytes = bench->peer_bytes;
        return true;
    }
    occ_scene_stats scene;
    if (!succeeded(occ_scene_get_stats(bench->scene, &scene), "asking for the scene's size"))
        return false;
    result->scene_bytes = scene.bytes;
    result->held_bytes = bench->heap.bytes;
    if (result->frame_count == 0) return true;
    result->view_bytes = result->frames[0].stats.bytes;
    result->device_bytes = result->frames[0].stats.device_bytes;
    return true;
}

static bool run_all(measure_bench *bench)
{
    if (!build_scene(bench) || !count_in_frustum(bench)) return false;
    if (bench->peer ? !open_peer(bench) : !make_view(bench)) return false;
    progress_begin("culling frames",
                   (size_t)bench->result->frame_count * (1 + bench->settings->repeats));
    bool good = warm_up(bench) && time_frames(bench);
    progress_end();
    if (!good) return false;
    return ask_for_sizes(bench);
}

static bool allocate_bench(measure_bench *bench)
{
    measure_result *result = bench->result;
    uint32_t every = bench->settings->every, objects = bench->file->object_count;
    result->frame_count = (bench->file->frame_count + every - 1) / every;
    result->frames = calloc((size_t)result->frame_count + 1, sizeof *result->frames);
    bench->mask = calloc(OCC_MASK_WORDS(objects) + 1, sizeof *bench->mask);
    bench->list = calloc((size_t)objects + 1, sizeof *bench->list);
    bench->times = calloc((size_t)bench->settings->repeats + 1, 3 * sizeof(double));
    bool good = vis_create(&result->verdicts, objects, result->frame_count);
    if (!good || !result->frames || !bench->mask || !bench->list || !bench->times)
        return is_out_of_memory();
    for (uint32_t i = 0; i < result->frame_count; i++)
        result->frames[i].index = i * every;
    return true;
}

bool measure_run(const measure_settings *settings, const obs_scene *scene, measure_result *result)
{
    *result = (measure_result){.threads = thread_count(settings), .driver = "none"};
    measure_bench bench = {.file = scene, .settings = settings, .result = result};
    bench.peer = peer_find(settings->method);
    bench.knobs = settings->knobs;
    if (!bench.peer && !find_method(settings->method, &bench.knobs.method)) return false;
    bool good = allocate_bench(&bench) && run_all(&bench);
    if (bench.peer_state) bench.peer->close(bench.peer_state);
    occ_view_destroy(bench.view);
    occ_scene_destroy(bench.scene);
    free(bench.mask);
    free(bench.list);
    free(bench.times);
    if (!good) measure_free(result);
    return good;
}

void measure_free(measure_result *result)
{
    free(result->frames);
    vis_free(&result->verdicts);
    *result = (measure_result){0};
}
