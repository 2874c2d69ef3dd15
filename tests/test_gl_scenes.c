// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// timeout: 120
// The library's masks and the sampling oracle against OpenGL's occlusion queries, on named scenes.
// As in test_gl_judge.c all of OpenGL's roundings are on the side that makes a right answer pass:
//   - what has a sample, behind occluders drawn a little larger and nearer, must be in the mask;
//   - the samples that the oracle counts lie between those counted with larger occluders and
//   smaller
//     objects, and those counted with smaller occluders and larger objects.
#include "gl_queries.h"
#include "scenes.h"
#include "truth_sample.h"

#include "support.h"
#include "worlds.h"

#include <stdio.h>
#include <stdlib.h>

// --- a scene on both sides -----------------------------------------------------------------------

typedef struct gl_stage {
    obs_scene file;
    gl_queries *queries;
    int width, height;
    // the frame
    double eye[3];
    occ_camera_desc camera;
    glb_camera view;
    // a box for each occluder or object that is left, with room for all
    occ_box *boxes;
    uint32_t *numbers, *owners, *samples;
} gl_stage;

static gl_stage *open_stage(const char *name, uint32_t count, int width, int height)
{
    gl_stage *s = calloc(1, sizeof *s);
    ck_assert_ptr_nonnull(s);
    ck_assert(scenes_make(name, count, 1, &s->file));
    size_t most = (size_t)s->file.object_count + s->file.occluder_count;
    s->boxes = malloc(most * sizeof *s->boxes);
    s->numbers = malloc(most * sizeof *s->numbers);
    s->owners = malloc(most * sizeof *s->owners);
    s->samples = malloc(most * sizeof *s->samples);
    ck_assert(s->boxes && s->numbers && s->owners && s->samples);
    s->width = width;
    s->height = height;
    s->queries = glq_open(width, height);
    return s;
}

static void close_stage(gl_stage *s)
{
    glq_close(s->queries);
    obs_free(&s->file);
    free(s->boxes);
    free(s->numbers);
    free(s->owners);
    free(s->samples);
    free(s);
}

static void go_to_frame(gl_stage *s, uint32_t frame)
{
    const obs_frame *from = &s->file.frames[frame];
    s->camera = (occ_camera_desc){.eye = s->eye};
    for (int j = 0; j < 3; j++)
        s->eye[j] = (double)from->eye[j];
    obs_view_projection(from, s->camera.view_projection);
    s->view = glq_camera(s->queries, &s->camera, s->width, s->height);
}

// Draws occluders larger and nearer, or smaller and farther.
static void draw_occluders(gl_stage *s, glb_manner manner)
{
    double margin = GLB_MARGIN * s->view.tolerance;
    size_t count = 0;
    for (uint32_t i = 0; i < s->file.occluder_count; i++) {
        const occ_box *box = &s->file.occluders[i].box;
        if (!glb_grow(&s->view, box, manner == GLB_GENEROUS ? margin : -margin, &s->boxes[count]))
            continue; // it has no area, or is too small to be drawn
        if (manner == GLB_SPARING && glb_is_cut_by_near(&s->view, box)) continue;
        if (manner == GLB_GENEROUS && glb_is_open(&s->view, box)) continue; // the eye is in it
        bool opens = manner == GLB_GENEROUS && glb_is_open(&s->view, &s->boxes[count]);
        KIT_CHECK(!opens, "occluder %u is open only if it is grown", i);
        s->owners[count++] = s->file.occluders[i].owner;
    }
    glq_rect all = glq_frustum(&s->view, 0);
    glq_occlude(s->queries, &s->view, &all, s->boxes, s->owners, count, manner);
}

// Counts the samples of all objects, larger or smaller by so many tolerances. samples[i] is of
// object i.
static void count_objects(gl_stage *s, double margin, glb_manner manner, int inset)
{
    size_t count = 0;
    for (uint32_t i = 0; i < s->file.object_count; i++) {
        occ_box *box = &s->boxes[count];
        *box = s->file.objects[i];
        if (margin != 0.0 &&
            !glb_grow(&s->view, &s->file.objects[i], margin * s->view.tolerance, box))
            continue;
        s->numbers[count++] = i;
    }
    glq_rect rect = glq_frustum(&s->view, inset);
    glq_count(s->queries, &s->view, &rect, s->boxes, s->numbers, count, manner, s->samples);
    for (uint32_t i = s->file.object_count; i-- > 0;) // to its number, which is not below
        s->samples[i] = count > 0 && s->numbers[count - 1] == i ? s->samples[--count] : 0;
}

// --- masks ---------------------------------------------------------------------------------------

// Scene and view of the library, with object i in slot i.
typedef struct gl_library {
    occ_scene *scene;
    occ_view *view;
} gl_library;

static gl_library fill_library(const obs_scene *file)
{
    world_occluder *occluders = calloc((size_t)file->occluder_count + 1, sizeof *occluders);
    ck_assert_ptr_nonnull(occluders);
    for (uint32_t i = 0; i < file->occluder_count; i++)
        occluders[i] = (world_occluder){file->occluders[i].box, (int)file->occluders[i].owner};
    gl_library library = {
        .scene = world_scene(file->objects, file->object_count, occluders, file->occluder_count, 0),
        .view = world_view(OCC_BACKEND_PLAIN, 1)};
    free(occluders);
    return library;
}

typedef struct gl_counts {
    unsigned drawn, visible, hidden; // by OpenGL, by the library, and neither
} gl_counts;

// How many objects OpenGL sees though the mask leaves them out; `first` is the first of them. `lie`
// leaves out one more, which both see.
static unsigned count_false(const gl_stage *s, const occ_view *view, bool lie, gl_counts *counts,
                            uint32_t *first)
{
    unsigned wrong = 0;
    *counts = (gl_counts){0};
    for (uint32_t i = 0; i < s->file.object_count; i++) {
        bool visible = world_sees(view, i), drawn = s->samples[i] > 0;
        if (lie && visible && drawn) lie = visible = false;
        if (drawn && !visible && wrong++ == 0) *first = i;
        counts->drawn += drawn;
        counts->visible += visible;
        counts->hidden += !drawn && !visible;
    }
    return wrong;
}

static void check_masks(gl_stage *s, const gl_library *library, const char *name, uint32_t frame)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_FUSED, OCC_METHOD_PAIRWISE};
    for (int m = 0; m < 3; m++) {
        occ_cull_desc knobs = world_knobs(methods[m]);
        gl_counts counts;
        uint32_t first = 0;
        kit_cull(library->view, library->scene, &s->camera, &knobs);
        unsigned wrong = count_false(s, library->view, false, &counts, &first);
        printf("%s, frame %u: OpenGL sees %u, method %d %u of %u objects\n", name, frame,
               counts.drawn, m, counts.visible, s->file.object_count);
        fflush(stdout);
        KIT_CHECK(
            wrong == 0,
            "%s, frame %u, method %d: %u objects are left out that OpenGL (%s) sees, the first "
            "is %u with %u samples",
            name, frame, m, wrong, glq_renderer(s->queries), first, s->samples[first]);
        ck_assert_uint_gt(counts.drawn, 0);
        ck_assert_uint_gt(counts.hidden, 0);
        ck_assert_uint_eq(count_false(s, library->view, true, &counts, &first),
                          1); // and that is found
    }
}

static void compare_masks(const char *name, uint32_t count, const uint32_t *frames, int frame_count)
{
    gl_stage *s = open_stage(name, count, 1280, 720);
    gl_library library = fill_library(&s->file);
    for (int i = 0; i < frame_count; i++) {
        go_to_frame(s, frames[i]);
        draw_occluders(s, GLB_GENEROUS);
        count_objects(s, 0.0, GLB_SPARING, 1);
        check_masks(s, &library, name, frames[i]);
    }
    occ_view_destroy(library.view);
    occ_scene_destroy(library.scene);
    close_stage(s);
}

static const uint32_t along_the_path[] = {0, 20, 40};

START_TEST(masks_of_a_city)
{
    compare_masks("city", 10000, along_the_path, 3);
}
END_TEST

START_TEST(masks_of_a_forest)
{
    compare_masks("forest", 10000, along_the_path, 3);
}
END_TEST

START_TEST(masks_of_a_soup)
{
    compare_masks("soup", 10000, along_the_path, 3);
}
END_TEST

START_TEST(masks_of_rooms)
{
    compare_masks("interior", 10000, along_the_path, 3);
}
END_TEST

START_TEST(masks_of_the_seed_scene)
{
    compare_masks("seedscene", 1000, along_the_path, 1);
}
END_TEST

// --- the sampling oracle -------------------------------------------------------------------------

// Samples of all objects together.
typedef struct gl_sums {
    uint64_t least, truth, most;
    unsigned seen, surely_seen; // objects; by OpenGL at its most sparing
} gl_sums;

static void compare_frame(gl_stage *s, uint32_t frame, truth_verdict *truth, uint32_t *least,
                          gl_sums *sums)
{
    go_to_frame(s, frame);
    draw_occluders(s, GLB_GENEROUS);
    count_objects(s, -GLB_MARGIN, GLB_SPARING, 0);
    memcpy(least, s->samples, s->file.object_count * sizeof *least);
    draw_occluders(s, GLB_SPARING);
    count_objects(s, GLB_MARGIN, GLB_GENEROUS, 0);
    const char *complaint =
        truth_sample(&s->file, frame, (uint32_t)s->width, (uint32_t)s->height, truth);
    ck_assert_msg(!complaint, "%s", complaint);
    for (uint32_t i = 0; i < s->file.object_count; i++) {
        uint32_t samples = truth[i].samples, most = s->samples[i];
        if (glb_is_open(&s->view, &s->file.objects[i])) continue; // the eye is in it
        KIT_CHECK(least[i] <= samples && samples <= most,
                  "frame %u, object %u: %u samples, but OpenGL (%s) counts %u to %u", frame, i,
                  samples, glq_renderer(s->queries), least[i], most);
        sums->least += least[i];
        sums->truth += samples;
        sums->most += most;
        sums->seen += samples > 0;
        sums->surely_seen += least[i] > 0;
    }
}

// `spread`: how far apart the two counts of OpenGL may be, as a share of all samples.
static void compare_samples(const char *name, uint32_t count, int frame_count, double spread)
{
    gl_stage *s = open_stage(name, count, 640, 360);
    truth_verdict *truth = calloc(s->file.object_count, sizeof *truth);
    uint32_t *least = calloc(s->file.object_count, sizeof *least);
    ck_assert(truth && least);
    gl_sums sums = {0};
    for (int i = 0; i < frame_count; i++)
        compare_frame(s, along_the_path[i], truth, least, &sums);
    printf("%s: %llu samples of %u objects; OpenGL counts %llu of %u to %llu\n", name,
           (unsigned long long)sums.truth, sums.seen, (unsigned long long)sums.least,
           sums.surely_seen, (unsigned long long)sums.most);
    fflush(stdout);
    free(truth);
    free(least);
    close_stage(s);
    ck_assert_uint_gt(sums.seen, 0);
    ck_assert_double_le((double)(sums.most - sums.least), spread * (double)sums.truth);
    ck_assert_double_ge(sums.surely_seen, 0.7 * sums.seen); // what is small may be left out
}

START_TEST(samples_of_a_city)
{
    compare_samples("city", 10000, 3, 0.05);
}
END_TEST

START_TEST(samples_of_a_forest)
{
    compare_samples("forest", 10000, 3, 0.05);
}
END_TEST

START_TEST(samples_of_a_soup)
{
    compare_samples("soup", 10000, 3, 0.3); // the near plane cuts many
}
END_TEST

START_TEST(samples_of_rooms)
{
    compare_samples("interior", 10000, 3, 0.05);
}
END_TEST

START_TEST(samples_of_the_seed_scene)
{
    compare_samples("seedscene", 1000, 1, 0.05);
}
END_TEST

int main(void)
{
    int skipped = glq_skip();
    if (skipped) return skipped;
    Suite *suite = suite_create("gl_scenes");
    TCase *city = tcase_create("city"); // by itself, for its twin
    tcase_add_test(city, masks_of_a_city);
    suite_add_tcase(suite, city);
    TCase *masks = tcase_create("masks");
    tcase_add_test(masks, masks_of_a_forest);
    tcase_add_test(masks, masks_of_a_soup);
    tcase_add_test(masks, masks_of_rooms);
    tcase_add_test(masks, masks_of_the_seed_scene);
    suite_add_tcase(suite, masks);
    TCase *samples = tcase_create("samples");
    tcase_add_test(samples, samples_of_a_city);
    tcase_add_test(samples, samples_of_a_forest);
    tcase_add_test(samples, samples_of_a_soup);
    tcase_add_test(samples, samples_of_rooms);
    tcase_add_test(samples, samples_of_the_seed_scene);
    suite_add_tcase(suite, samples);
    return test_run_suite(suite);
}
