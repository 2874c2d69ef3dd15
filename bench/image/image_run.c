// SPDX-License-Identifier: Apache-2.0
#include "image_run.h"

#include "image_camera.h"
#include "image_compare.h"
#include "loaded.h"
#include "measure.h"
#include "progress.h"
#include "timing.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

// Objects named in a frame, and occluders of one: more are only counted.
enum { MOST_NAMED = 10, MOST_OCCLUDERS = 16 };

// A list of objects, ascending.
typedef struct object_list {
    uint32_t *at;
    size_t count;
} object_list;

// Everything that lives while frames are drawn.
typedef struct image_job {
    const image_wish *wish;
    const image_parts *parts;
    loaded_scene loaded;
    occ_view *view, *frustum;
    image_gl *gl;
    image_pixels full, culled;
    object_list all, in_frustum, visible;
    bool *is_drawn, *is_seen;
    uint32_t *culprits;
} image_job;

static bool out_of_memory(void)
{
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

// --- culling -------------------------------------------------------------------------------------

static bool cull(const image_job *job, occ_view *view, const obs_frame *frame,
                 const occ_cull_desc *knobs, object_list *out)
{
    return loaded_succeeded(measure_cull(view, job->loaded.scene, frame, knobs), "culling") &&
           loaded_succeeded(
               occ_view_read_visible(view, out->at, job->parts->object_count, &out->count),
               "reading the visible objects");
}

static bool cull_both(image_job *job, const obs_frame *frame, image_row *row)
{
    const occ_cull_desc frustum = {.method = OCC_METHOD_FRUSTUM};
    if (!cull(job, job->frustum, frame, &frustum, &job->in_frustum)) return false;
    double start = timing_now();
    if (!cull(job, job->view, frame, &job->wish->knobs, &job->visible)) return false;
    row->cull_ms = timing_now() - start;
    row->in_frustum = (uint32_t)job->in_frustum.count;
    row->visible = (uint32_t)job->visible.count;
    row->triangles_in_frustum = 0;
    for (size_t i = 0; i < job->in_frustum.count; i++) {
        const uint32_t *first = &job->parts->first[job->in_frustum.at[i]];
        row->triangles_in_frustum += first[1] - first[0];
    }
    return true;
}

// --- naming --------------------------------------------------------------------------------------

static void print_occluders(const image_job *job, size_t count)
{
    for (size_t i = 0; i < count && i < MOST_OCCLUDERS; i++) {
        uint32_t owner = obs_occluder_owner(job->loaded.file, job->culprits[i]);
        fprintf(stderr, "%s %u", i ? "," : "", job->culprits[i]);
        if (owner != OBS_NO_OWNER) fprintf(stderr, " (of object %u)", owner);
    }
    fprintf(stderr, count > MOST_OCCLUDERS ? " and %zu more\n" : "\n", count - MOST_OCCLUDERS);
}

static bool name_missing(const image_job *job, uint32_t frame, const image_missing *m)
{
    occ_fate fate;
    size_t count;
    char triangle[32] = "see-through";
    if (!loaded_explain(&job->loaded, job->view, m->object, &fate, job->culprits, &count))
        return false;
    if (m->triangle != UINT32_MAX) snprintf(triangle, sizeof triangle, "triangle %u", m->triangle);
    fprintf(stderr,
            "occlude-bench: frame %u: object %u shows in %u pixels, first at %u,%u (%s): ", frame,
            m->object, m->pixels, m->x, m->y, triangle);
    if (fate == OCC_FATE_HIDDEN) {
        fputs("hidden by occluders", stderr);
        print_occluders(job, count);
    } else {
        fputs(fate == OCC_FATE_OUTSIDE ? "outside the frustum\n" : "visible, but not drawn\n",
              stderr);
    }
    return true;
}

static bool write_pictures(const image_job *job, uint32_t frame)
{
    const image_pixels *const pictures[2] = {&job->full, &job->culled};
    static const char *const names[2] = {"full", "culled"};
    char path[4096];
    for (int i = 0; i < 2; i++) {
        int length =
            snprintf(path, sizeof path, "%s-frame%u-%s.png", job->wish->pictures, frame, names[i]);
        if (length < 0 || (size_t)length >= sizeof path) {
            fputs("occlude-bench: the name after --pictures is too long\n", stderr);
            return false;
        }
        if (!image_write_png(pictures[i], path)) return false;
    }
    return true;
}

static bool name_all(const image_job *job, uint32_t frame, const image_difference *d)
{
    fprintf(stderr, "occlude-bench: frame %u: %" PRIu64 " pixels differ, %u objects are missing\n",
            frame, d->pixels, d->count);
    for (uint32_t i = 0; i < d->count && i < MOST_NAMED; i++)
        if (!name_missing(job, frame, &d->missing[i])) return false;
    if (d->count > MOST_NAMED)
        fprintf(stderr, "occlude-bench: frame %u: and %u objects more\n", frame,
                d->count - MOST_NAMED);
    if (d->unnamed > 0)
        fprintf(stderr,
                "occlude-bench: frame %u: in %" PRIu64 " pixels no object is missing: OpenGL drew "
                "the same triangles in another way\n",
                frame, d->unnamed);
    return write_pictures(job, frame);
}

static bool probe_veil(void *state, uint32_t object, uint32_t *veil)
{
    return image_gl_veil(state, object, veil);
}

static bool compare(image_job *job, image_row *row)
{
    for (uint32_t i = 0; i < job->parts->object_count; i++)
        job->is_drawn[i] = false;
    for (size_t i = 0; i < job->visible.count; i++)
        job->is_drawn[job->visible.at[i]] = true;
    image_difference d;
    if (!image_compare(&job->full, &job->culled, job->parts, job->is_drawn, probe_veil, job->gl,
                       &d))
        return false;
    row->differing = d.pixels;
    bool good = d.pixels == 0 || name_all(job, row->frame, &d);
    image_difference_free(&d);
    return good;
}

// --- drawing -------------------------------------------------------------------------------------

static bool draw(const image_job *job, const double clip[16], const object_list *objects,
                 image_pixels *pixels, image_pass *pass)
{
    return image_gl_draw(job->gl, clip, objects->at, objects->count, pass) &&
           image_gl_read(job->gl, pixels->front, pixels->veil);
}

// Behind what can be seen through an object may be seen as well, so these are taken for seen.
static void count_seen(image_job *job, image_row *row)
{
    const image_parts *p = job->parts;
    size_t pixels = (size_t)job->full.width * job->full.height;
    for (uint32_t i = 0; i < p->object_count; i++)
        job->is_seen[i] = p->see_through[i] < p->first[i + 1];
    uint32_t latest = 0; // pixels beside each other are mostly of one triangle
    for (size_t i = 0; i < pixels; i++) {
        if (job->full.front[i] == latest) continue;
        latest = job->full.front[i];
        if (latest > 0) job->is_seen[image_parts_object(p, latest - 1)] = true;
    }
    row->seen = 0;
    for (size_t i = 0; i < job->in_frustum.count; i++)
        row->seen += job->is_seen[job->in_frustum.at[i]];
}

static bool run_frame(image_job *job, image_row *row)
{
    const obs_frame *frame = &job->loaded.file->frames[row->frame];
    const object_list *whole = job->wish->against_frustum ? &job->in_frustum : &job->all;
    double clip[16];
    if (!image_camera_of(frame, clip)) {
        fprintf(stderr, "occlude-bench: frame %u: its camera has no eye\n", row->frame);
        return false;
    }
    if (!cull_both(job, frame, row) || !draw(job, clip, whole, &job->full, &row->full) ||
        !draw(job, clip, &job->visible, &job->culled, &row->culled))
        return false;
    count_seen(job, row);
    return compare(job, row);
}

static bool run_frames(image_job *job, image_row *rows)
{
    const image_wish *wish = job->wish;
    double clip[16];
    image_row warm = {.frame = wish->frames[0]};
    const obs_frame *first = &job->loaded.file->frames[warm.frame];
    progress_begin("drawing frames", wish->frame_count);
    // Once untimed: what is made when it is first needed is made now.
    bool good = cull_both(job, first, &warm);
    if (good && image_camera_of(first, clip))
        good = draw(job, clip, &job->all, &job->full, &warm.full);
    for (uint32_t i = 0; good && i < wish->frame_count; i++) {
        rows[i].frame = wish->frames[i];
        good = run_frame(job, &rows[i]);
        progress_step(i + 1);
    }
    progress_end();
    return good;
}

// --- opening -------------------------------------------------------------------------------------

static void print_log_line(occ_log_level level, const char *line, void *user_data)
{
    (void)user_data;
    if (level != OCC_LOG_INFO) fprintf(stderr, "occlude: %s\n", line);
}

static bool make_views(image_job *job)
{
    const occ_view_desc plain = {.logger = {print_log_line, NULL}, .backend = OCC_BACKEND_PLAIN};
    const occ_view_desc desc = {.logger = {print_log_line, NULL},
                                .backend = job->wish->backend,
                                .threads = job->wish->threads};
    return loaded_succeeded(occ_view_create(&plain, &job->frustum), "making a view") &&
           loaded_succeeded(occ_view_create(&desc, &job->view), "making the view");
}

static bool allocate(image_job *job)
{
    size_t objects = (size_t)job->parts->object_count + 1;
    object_list *const lists[3] = {&job->all, &job->in_frustum, &job->visible};
    bool good = true;
    for (int i = 0; i < 3; i++) {
        lists[i]->at = calloc(objects, sizeof *lists[i]->at);
        good = good && lists[i]->at;
    }
    job->is_drawn = calloc(objects, sizeof *job->is_drawn);
    job->is_seen = calloc(objects, sizeof *job->is_seen);
    job->culprits = calloc((size_t)obs_occluder_total(job->loaded.file) + 1, sizeof *job->culprits);
    uint32_t width = job->wish->gl.width, height = job->wish->gl.height;
    good = good && job->is_drawn && job->is_seen && job->culprits &&
           image_pixels_create(&job->full, width, height) &&
           image_pixels_create(&job->culled, width, height);
    if (!good) return out_of_memory();
    job->all.count = job->parts->object_count;
    for (uint32_t i = 0; i < job->parts->object_count; i++)
        job->all.at[i] = i;
    return true;
}

static void close_job(image_job *job)
{
    image_gl_close(job->gl);
    occ_view_destroy(job->view);
    occ_view_destroy(job->frustum);
    loaded_free(&job->loaded);
    image_pixels_free(&job->full);
    image_pixels_free(&job->culled);
    free(job->all.at);
    free(job->in_frustum.at);
    free(job->visible.at);
    free(job->is_drawn);
    free(job->is_seen);
    free(job->culprits);
}

bool image_run(const image_wish *wish, const obs_scene *scene, const image_parts *parts,
               image_result *out)
{
    image_job job = {.wish = wish, .parts = parts};
    *out = (image_result){.rows = calloc((size_t)wish->frame_count + 1, sizeof *out->rows)};
    bool good = out->rows ? loaded_build(scene, &job.loaded) : out_of_memory();
    good = good && allocate(&job) && make_views(&job);
    if (good) job.gl = image_gl_open(parts, &wish->gl);
    good = good && job.gl;
    if (good) snprintf(out->renderer, sizeof out->renderer, "%s", image_gl_renderer(job.gl));
    good = good && run_frames(&job, out->rows);
    close_job(&job);
    if (!good) image_result_free(out);
    return good;
}

void image_result_free(image_result *result)
{
    free(result->rows);
    *result = (image_result){0};
}
