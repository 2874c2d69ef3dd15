// SPDX-License-Identifier: Apache-2.0
#include "image_report.h"

#include "build_info.h"
#include "timing.h"

#include <inttypes.h>
#include <stdlib.h>

// Of a pass: sums over the frames, and medians of the times.
typedef struct pass_sum {
    uint64_t draws, triangles;
    double cpu_ms, gpu_ms, whole_ms;
} pass_sum;

typedef struct image_sum {
    uint64_t differing, in_frustum, visible, seen, triangles_in_frustum;
    pass_sum full, culled;
    double cull_ms;
} image_sum;

static void add_pass(pass_sum *sum, const image_pass *pass)
{
    sum->draws += pass->draws;
    sum->triangles += pass->triangles;
}

// Which time of a row.
typedef double image_time(const image_row *row);

static double cull_of(const image_row *row)
{
    return row->cull_ms;
}

static double full_cpu_of(const image_row *row)
{
    return row->full.cpu_ms;
}

static double full_gpu_of(const image_row *row)
{
    return row->full.gpu_ms;
}

static double full_whole_of(const image_row *row)
{
    return row->full.whole_ms;
}

static double culled_cpu_of(const image_row *row)
{
    return row->culled.cpu_ms;
}

static double culled_gpu_of(const image_row *row)
{
    return row->culled.gpu_ms;
}

static double culled_whole_of(const image_row *row)
{
    return row->culled.whole_ms + row->cull_ms;
}

static double median_of(image_time *time_of, const image_row *rows, uint32_t count, double *scratch)
{
    for (uint32_t i = 0; i < count; i++)
        scratch[i] = time_of(&rows[i]);
    return timing_median(scratch, count);
}

// False when memory runs out.
static bool add_up(const image_wish *wish, const image_result *result, image_sum *sum)
{
    const image_row *rows = result->rows;
    uint32_t count = wish->frame_count;
    double *scratch = malloc(((size_t)count + 1) * sizeof *scratch);
    *sum = (image_sum){0};
    if (!scratch) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        sum->differing += rows[i].differing;
        sum->in_frustum += rows[i].in_frustum;
        sum->visible += rows[i].visible;
        sum->seen += rows[i].seen;
        sum->triangles_in_frustum += rows[i].triangles_in_frustum;
        add_pass(&sum->full, &rows[i].full);
        add_pass(&sum->culled, &rows[i].culled);
    }
    sum->cull_ms = median_of(cull_of, rows, count, scratch);
    sum->full.cpu_ms = median_of(full_cpu_of, rows, count, scratch);
    sum->full.gpu_ms = median_of(full_gpu_of, rows, count, scratch);
    sum->full.whole_ms = median_of(full_whole_of, rows, count, scratch);
    sum->culled.cpu_ms = median_of(culled_cpu_of, rows, count, scratch);
    sum->culled.gpu_ms = median_of(culled_gpu_of, rows, count, scratch);
    sum->culled.whole_ms = median_of(culled_whole_of, rows, count, scratch);
    free(scratch);
    return true;
}

static double share_gone(uint64_t left, uint64_t all)
{
    return all > 0 ? 100.0 * (1.0 - (double)left / (double)all) : 0.0;
}

static void print_line(const char *what, double full, double culled)
{
    printf("%-24s %14.2f %14.2f %14.2f\n", what, full, culled, full - culled);
}

static void print_table(const image_names *names, const image_wish *wish, const image_sum *sum)
{
    double frames = wish->frame_count;
    const char *whole = wish->against_frustum ? "frustum" : "all objects";
    uint64_t unseen = sum->in_frustum - sum->seen, gone = sum->in_frustum - sum->visible;
    printf(
        "objects %.1f in the frustum, %.1f of them seen in a pixel; %s leaves %.1f: of those not\n"
        "        seen it culls %.1f %%\n",
        (double)sum->in_frustum / frames, (double)sum->seen / frames, names->method,
        (double)sum->visible / frames, unseen > 0 ? 100.0 * (double)gone / (double)unseen : 0.0);
    printf("%-24s %14s %14s %14s\n", "a frame", whole, names->method, "saved");
    const pass_sum *full = &sum->full, *culled = &sum->culled;
    print_line("draw calls", (double)full->draws / frames, (double)culled->draws / frames);
    print_line("triangles", (double)full->triangles / frames, (double)culled->triangles / frames);
    print_line("CPU ms, draw calls", full->cpu_ms, culled->cpu_ms);
    print_line("CPU ms, culling", 0.0, sum->cull_ms);
    print_line("GPU ms, OpenGL's clock", full->gpu_ms, culled->gpu_ms);
    print_line("ms until all is drawn", full->whole_ms, culled->whole_ms);
}

static void print_last_line(const image_names *names, const image_wish *wish,
                            const image_parts *parts, const image_sum *sum)
{
    const pass_sum *full = &sum->full, *culled = &sum->culled;
    printf("frames=%u differing_pixels=%" PRIu64 " triangles_drawn=%" PRIu64
           " triangles_saved=%" PRIu64,
           wish->frame_count, sum->differing, culled->triangles,
           full->triangles - culled->triangles);
    printf(" draws=%" PRIu64 " draws_saved=%" PRIu64 " objects=%u in_frustum=%" PRIu64
           " visible=%" PRIu64 " seen=%" PRIu64 " objects_culled_pct=%.2f"
           " triangles_in_frustum=%" PRIu64 " triangles_culled_pct=%.2f",
           culled->draws, full->draws - culled->draws, parts->object_count, sum->in_frustum,
           sum->visible, sum->seen, share_gone(sum->visible, sum->in_frustum),
           sum->triangles_in_frustum, share_gone(culled->triangles, sum->triangles_in_frustum));
    printf(" cull_ms=%.4f cpu_ms=%.4f cpu_ms_saved=%.4f gpu_ms=%.4f gpu_ms_saved=%.4f"
           " whole_ms=%.4f whole_ms_saved=%.4f method=%s backend=%s against=%s\n",
           sum->cull_ms, culled->cpu_ms, full->cpu_ms - culled->cpu_ms - sum->cull_ms,
           culled->gpu_ms, full->gpu_ms - culled->gpu_ms, culled->whole_ms,
           full->whole_ms - culled->whole_ms, names->method, names->backend,
           wish->against_frustum ? "frustum" : "all");
}

bool image_print(const image_names *names, const image_wish *wish, const image_parts *parts,
                 const image_result *result, uint64_t *differing)
{
    image_sum sum;
    if (!add_up(wish, result, &sum)) return false;
    printf("model   %u triangles in %u objects, %u of them see-through; %u occluders\n",
           parts->triangle_count, parts->object_count, parts->see_through_count, names->occluders);
    printf("drawn   %ux%u, %s, by %s\n", wish->gl.width, wish->gl.height,
           wish->gl.one_sided ? "front faces" : "both faces", result->renderer);
    print_table(names, wish, &sum);
    print_last_line(names, wish, parts, &sum);
    *differing = sum.differing;
    return true;
}

void image_write_rows(FILE *stream, const image_names *names, const image_wish *wish,
                      const image_result *result)
{
    build_info_write(stream, result->renderer);
    fprintf(stream, "# method=%s\n# backend=%s\n# against=%s\n# size=%ux%u\n", names->method,
            names->backend, wish->against_frustum ? "frustum" : "all", wish->gl.width,
            wish->gl.height);
    fputs("frame,in_frustum,visible,seen,triangles_in_frustum,differing_pixels,draws_full,draws,"
          "triangles_full,triangles,cull_ms,cpu_full_ms,cpu_ms,gpu_full_ms,gpu_ms,whole_full_ms,"
          "whole_ms\n",
          stream);
    for (uint32_t i = 0; i < wish->frame_count; i++) {
        const image_row *row = &result->rows[i];
        const image_pass *full = &row->full, *culled = &row->culled;
        fprintf(stream,
                "%u,%u,%u,%u,%u,%" PRIu64 ",%u,%u,%u,%u,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n",
                row->frame, row->in_frustum, row->visible, row->seen, row->triangles_in_frustum,
                row->differing, full->draws, culled->draws, full->triangles, culled->triangles,
                row->cull_ms, full->cpu_ms, culled->cpu_ms, full->gpu_ms, culled->gpu_ms,
                full->whole_ms, culled->whole_ms + row->cull_ms);
    }
}
