// SPDX-License-Identifier: Apache-2.0
#include "gpu.h"

#include "timing.h"

#include <occlude/occlude.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_DEVICES 16u
#define KINDS        6u

// Everything that lives while a scene is measured.
typedef struct gpu_bench {
    const obs_scene *file;
    const gpu_settings *settings;
    gpu_result *result;
    cl_context context;
    cl_device_id devices[MOST_DEVICES];
    cl_command_queue queues[MOST_DEVICES];
    uint32_t queue_count;
    occ_scene *occluders;
    uint32_t *owners;
    occ_cl_table *table;
    double *times; // [KINDS][frame]
} gpu_bench;

static bool complain(const char *what, int code)
{
    fprintf(stderr, "occlude-bench gpu: %s: %d\n", what, code);
    return false;
}

static void say(occ_log_level level, const char *message, void *user_data)
{
    (void)user_data;
    if (level == OCC_LOG_ERROR) fprintf(stderr, "occlude-bench gpu: %s\n", message);
}

// --- devices -------------------------------------------------------------------------------------

// The device that a view takes, or parts of it.
static bool open_devices(gpu_bench *bench)
{
    occ_view *view;
    occ_result result = occ_cl_view_create(NULL, NULL, &view);
    if (result) return complain(occ_result_message(result), (int)result);
    cl_device_id device = occ_cl_view_device(view);
    occ_view_destroy(view);
    char name[128] = "", driver[100] = "";
    (void)clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof name - 1, name, NULL);
    (void)clGetDeviceInfo(device, CL_DRIVER_VERSION, sizeof driver - 1, driver, NULL);
    snprintf(bench->result->device, sizeof bench->result->device, "%s, driver %s", name, driver);
    bench->devices[0] = device;
    bench->queue_count = bench->settings->devices;
    if (bench->queue_count == 1) return true;
    cl_uint units = 0, made = 0;
    (void)clGetDeviceInfo(device, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof units, &units, NULL);
    cl_device_partition_property each = (cl_device_partition_property)(units / bench->queue_count);
    cl_device_partition_property wish[] = {CL_DEVICE_PARTITION_EQUALLY, each, 0};
    cl_int error = clCreateSubDevices(device, wish, MOST_DEVICES, bench->devices, &made);
    if (error) return complain("clCreateSubDevices", error);
    if (made < bench->queue_count) return complain("sub-devices", (int)made);
    return true;
}

static bool open_queues(gpu_bench *bench)
{
    cl_int error;
    bench->context = clCreateContext(NULL, bench->queue_count, bench->devices, NULL, NULL, &error);
    if (error) return complain("clCreateContext", error);
    for (uint32_t i = 0; i < bench->queue_count; i++) {
        bench->queues[i] = clCreateCommandQueue(bench->context, bench->devices[i],
                                                CL_QUEUE_PROFILING_ENABLE, &error);
        if (error) return complain("clCreateCommandQueue", error);
    }
    gpu_copy_rates(bench->queues[0], &bench->result->copy_gbs, &bench->result->pinned_gbs);
    return true;
}

// --- the scene -----------------------------------------------------------------------------------

static bool add_occluders(gpu_bench *bench)
{
    const obs_scene *file = bench->file;
    uint32_t boxes = file->occluder_count, count = obs_occluder_total(file);
    occ_scene_desc desc = {.occluder_count = count};
    occ_box *box = malloc(((size_t)boxes + 1) * sizeof *box);
    occ_sheet *sheet = malloc(((size_t)file->sheet_count + 1) * sizeof *sheet);
    bench->owners = malloc(((size_t)count + 1) * sizeof *bench->owners);
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    if (box && sheet && bench->owners) result = occ_scene_create(&desc, &bench->occluders);
    for (uint32_t i = 0; i < count && !result; i++) {
        if (i < boxes) {
            box[i] = file->occluders[i].box;
        } else {
            sheet[i - boxes] = *obs_occluder_sheet(file, i);
        }
        bench->owners[i] = obs_occluder_owner(file, i);
    }
    if (!result) result = occ_scene_add_occluders(bench->occluders, box, NULL, boxes, NULL);
    if (!result) {
        result = occ_scene_add_sheets(bench->occluders, sheet, NULL, file->sheet_count, NULL);
    }
    if (!result) result = occ_scene_commit(bench->occluders);
    free(box);
    free(sheet);
    return result ? complain(occ_result_message(result), (int)result) : true;
}

static bool fill_table(gpu_bench *bench)
{
    occ_cl_table_desc desc = {.logger = {.log = say},
                              .capacity = bench->file->object_count,
                              .queues = bench->queues,
                              .queue_count = bench->queue_count,
                              .strips = bench->settings->strips};
    double start = timing_now();
    occ_result result = occ_cl_table_create(&desc, &bench->table);
    if (!result && bench->settings->arrange) {
        result = occ_cl_table_arrange(bench->table, bench->file->objects);
    } else if (!result) {
        result = occ_cl_table_write(bench->table, 0, desc.capacity, bench->file->objects);
    }
    for (uint32_t i = 0; i < bench->queue_count && !result; i++)
        (void)clFinish(bench->queues[i]);
    bench->result->fill_ms = timing_now() - start;
    return result ? complain(occ_result_message(result), (int)result) : true;
}

// Fills both pieces of pinned memory, so that a frame that moves everything only sends.
static bool fill_stages(gpu_bench *bench)
{
    uint32_t count = bench->file->object_count;
    for (int i = 0; i < 2 && bench->settings->move; i++) {
        occ_box *staged;
        occ_result result = occ_cl_table_stage(bench->table, count, &staged);
        if (result) return complain(occ_result_message(result), (int)result);
        memcpy(staged, bench->file->objects, count * sizeof *staged);
        result = occ_cl_table_send(bench->table, 0, count);
        if (result) return complain(occ_result_message(result), (int)result);
    }
    return true;
}

// --- frames --------------------------------------------------------------------------------------

static occ_result run_frame(gpu_bench *bench, const occ_camera_desc *camera, double *time,
                            const uint32_t **words, size_t *count)
{
    occ_cl_frame frame = {.occluders = bench->occluders,
                          .owners = bench->owners,
                          .camera = camera,
                          .knobs = &bench->settings->knobs,
                          .outputs = OCC_CL_HOST_MASK};
    occ_result result = OCC_SUCCESS;
    occ_box *staged;
    if (bench->settings->move) {
        result = occ_cl_table_stage(bench->table, bench->file->object_count, &staged);
    }
    double start = timing_now();
    if (!result && bench->settings->move) {
        result = occ_cl_table_send(bench->table, 0, bench->file->object_count);
    }
    if (!result) result = occ_cl_table_cull(bench->table, &frame, NULL);
    if (!result) result = occ_cl_table_map_mask(bench->table, words, count);
    *time = timing_now() - start;
    return result;
}

static void hash_words(uint64_t *hash, const uint32_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        *hash = (*hash ^ words[i]) * 0x100000001b3u;
}

// One frame, several times: its times, and what it is about.
static bool measure_frame(gpu_bench *bench, uint32_t index, double *rows, vis_result *masks)
{
    const obs_frame *from = &bench->file->frames[index];
    uint32_t repeats = bench->settings->repeats;
    double eye[3] = {from->eye[0], from->eye[1], from->eye[2]};
    occ_camera_desc camera = {.eye = eye};
    obs_view_projection(from, camera.view_projection);
    const uint32_t *words = NULL;
    size_t count = 0;
    for (uint32_t r = 0; r <= repeats; r++) { // the first is to warm up
        double time;
        occ_cl_table_stats stats;
        occ_result result = run_frame(bench, &camera, &time, &words, &count);
        if (!result) result = occ_cl_table_get_stats(bench->table, &stats);
        if (result) return complain(occ_result_message(result), (int)result);
        const double values[KINDS] = {
            time,           stats.walk_ms, stats.enqueue_ms, stats.blocks_ms, stats.objects_ms,
            stats.fusion_ms};
        for (uint32_t k = 0; k < KINDS && r; k++)
            rows[k * repeats + r - 1] = values[k];
        if (r == repeats) bench->result->occluders += stats.occluders_used;
        bench->result->device_bytes = stats.device_bytes;
    }
    for (size_t w = 0; w < count; w++)
        bench->result->visible += __builtin_popcount(words[w]);
    hash_words(&bench->result->hash, words, count);
    if (masks) vis_set_frame(masks, index, words);
    return true;
}

static void sum_up(gpu_bench *bench, double *frames)
{
    gpu_result *result = bench->result;
    uint32_t count = result->frames;
    double *to[KINDS] = {&result->frame_ms,  &result->walk_ms,    &result->enqueue_ms,
                         &result->blocks_ms, &result->objects_ms, &result->fusion_ms};
    for (uint32_t k = 0; k < KINDS; k++)
        *to[k] = timing_median(frames + k * (size_t)count, count);
    result->p99_ms = timing_percentile(frames, count, 99);
    result->occluders /= count;
    result->visible /= count;
    if (bench->settings->move) {
        double bytes = (double)bench->file->object_count * sizeof(occ_box);
        result->move_gbs = bytes * 1e-6 / result->frame_ms;
    }
}

static bool measure_frames(gpu_bench *bench, vis_result *masks)
{
    const gpu_settings *settings = bench->settings;
    uint32_t count = (bench->file->frame_count + settings->every - 1) / settings->every;
    bench->result->frames = count;
    bench->result->hash = 0xcbf29ce484222325u;
    double *frames = calloc((size_t)count * KINDS + 1, sizeof *frames);
    double *rows = calloc((size_t)settings->repeats * KINDS, sizeof *rows);
    bool good = frames && rows && count;
    if (!good) (void)complain("frames", (int)count);
    for (uint32_t i = 0; i < count && good; i++) {
        good = measure_frame(bench, i * settings->every, rows, masks);
        for (uint32_t k = 0; k < KINDS && good; k++)
            frames[k * (size_t)count + i] =
                timing_median(rows + (size_t)k * settings->repeats, settings->repeats);
    }
    if (good) sum_up(bench, frames);
    free(frames);
    free(rows);
    return good;
}

static void close_bench(gpu_bench *bench)
{
    occ_cl_table_destroy(bench->table);
    occ_scene_destroy(bench->occluders);
    free(bench->owners);
    for (uint32_t i = 0; i < bench->queue_count; i++)
        if (bench->queues[i]) (void)clReleaseCommandQueue(bench->queues[i]);
    if (bench->context) (void)clReleaseContext(bench->context);
    for (uint32_t i = 0; i < bench->queue_count && bench->queue_count > 1; i++)
        if (bench->devices[i]) (void)clReleaseDevice(bench->devices[i]);
}

bool gpu_measure(const obs_scene *scene, const gpu_settings *settings, gpu_result *result,
                 vis_result *masks)
{
    gpu_bench bench = {.file = scene, .settings = settings, .result = result};
    *result = (gpu_result){.frames = 0};
    bool good = open_devices(&bench) && open_queues(&bench) && add_occluders(&bench) &&
                fill_table(&bench) && fill_stages(&bench) && measure_frames(&bench, masks);
    close_bench(&bench);
    return good;
}
