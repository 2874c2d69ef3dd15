// SPDX-License-Identifier: Apache-2.0
#include "image_report.h"

#include "build_info.h"

#include <inttypes.h>

// Of a pass, over all frames.
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
    sum->cpu_ms += pass->cpu_ms;
    sum->gpu_ms += pass->gpu_ms;
    sum->whole_ms += pass->whole_ms;
}

static image_sum add_up(const image_wish *wish, const image_result *result)
{
    image_sum sum = {0};
    for (uint32_t i = 0; i < wish->frame_count; i++) {
        const image_row *row = &result->rows[i];
        sum.differing += row->differing;
        sum.in_frustum += row->in_frustum;
        sum.visible += row->visible;
        sum.seen += row->seen;
        sum.triangles_in_frustum += row->triangles_in_frustum;
        sum.cull_ms += row->cull_ms;
        add_pass(&sum.full, &row->full);
        add_pass(&sum.culled, &row->culled);
    }
    return sum;
}

static double share_gone(uint64_t left, uint64_t all)
{
    return all > 0 ? 100.0 * (1.0 - (double)left / (double)all) : 0.0;
}

static void print_line(const char *what, double frames, double full, double culled)
{
    printf("%-24s %14.2f %14.2f %14.2f\n", what, full / frames, culled / frames,
           (full - culled) / frames);
}

static void print_table(const image_names *names, const image_wish *wish, const image_sum *sum)
{
    double frames = wish->frame_count;
    const char *whole = wish->against_frustum ? "frustum" : "all objects";
    uint64_t unseen = sum->in_frustum - sum->seen, culled = sum->in_frustum - sum->visible;
    printf("objects %.1f in the frustum, %.1f left by %s, %.1f seen in a pixel: of those not seen\n"
           "        %.1f %% are culled\n",
           (double)sum->in_frustum / frames, (double)sum->visible / frames, names->method,
           (double)sum->seen / frames, unseen > 0 ? 100.0 * (double)culled / (double)unseen : 0.0);
    printf("%-24s %14s %14s %14s\n", "a frame, on the average", whole, names->method, "saved");
    print_line("draw calls", frames, (double)sum->full.draws, (double)sum->culled.draws);
    print_line("triangles", frames, (double)sum->full.triangles, (double)sum->culled.triangles);
    print_line("CPU ms, draw calls", frames, sum->full.cpu_ms, sum->culled.cpu_ms);
    print_line("CPU ms, culling", frames, 0.0, sum->cull_ms);
    print_line("GPU ms, OpenGL's clock", frames, sum->full.gpu_ms, sum->culled.gpu_ms);
    print_line("ms until all is drawn", frames, sum->full.whole_ms,
               sum->culled.whole_ms + sum->cull_ms);
}

uint64_t image_print(const image_names *names, const image_wish *wish, const image_parts *parts,
                     const image_result *result)
{
    image_sum sum = add_up(wish, result);
    double frames = wish->frame_count;
    printf("model   %u triangles in %u objects, %u of them see-through; %u occluders\n",
           parts->triangle_count, parts->object_count, parts->see_through_count, names->occluders);
    printf("drawn   %ux%u, %s, by %s\n", wish->gl.width, wish->gl.height,
           wish->gl.one_sided ? "front faces" : "both faces", result->renderer);
    print_table(names, wish, &sum);
    printf("frames=%u differing_pixels=%" PRIu64 " triangles_drawn=%" PRIu64
           " triangles_saved=%" PRIu64,
           wish->frame_count, sum.differing, sum.culled.triangles,
           sum.full.triangles - sum.culled.triangles);
    printf(" draws=%" PRIu64 " draws_saved=%" PRIu64 " objects=%u in_frustum=%" PRIu64
           " visible=%" PRIu64 " seen=%" PRIu64
           " objects_culled_pct=%.2f triangles_in_frustum=%" PRIu64 " triangles_culled_pct=%.2f",
           sum.culled.draws, sum.full.draws - sum.culled.draws, parts->object_count, sum.in_frustum,
           sum.visible, sum.seen, share_gone(sum.visible, sum.in_frustum), sum.triangles_in_frustum,
           share_gone(sum.culled.triangles, sum.triangles_in_frustum));
    printf(
        " cull_ms=%.4f cpu_ms=%.4f cpu_ms_saved=%.4f gpu_ms=%.4f gpu_ms_saved=%.4f whole_ms=%.4f "
        "whole_ms_saved=%.4f method=%s backend=%s against=%s\n",
        sum.cull_ms / frames, sum.culled.cpu_ms / frames,
        (sum.full.cpu_ms - sum.culled.cpu_ms - sum.cull_ms) / frames, sum.culled.gpu_ms / frames,
        (sum.full.gpu_ms - sum.culled.gpu_ms) / frames,
        (sum.culled.whole_ms + sum.cull_ms) / frames,
        (sum.full.whole_ms - sum.culled.whole_ms - sum.cull_ms) / frames, names->method,
        names->backend, wish->against_frustum ? "frustum" : "all");
    return sum.differing;
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
