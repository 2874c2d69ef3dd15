// SPDX-License-Identifier: Apache-2.0
// What hid an object: the families of hard worlds, random worlds and named scenes. Every object
// that a mask leaves out is explained, the occluders named took part, and the exact judge is shown
// these alone: they must hide the object. All backends say the same. labels: unit property oracle
// timeout: 120
#include "families.h"
#include "judge.h"
#include "obs.h"
#include "scenes.h"

#include "kit_obs.h"
#include "support.h"
#include "worlds.h"

#include <stdlib.h>

enum { MOST_NAMED = 64 };

// --- worlds --------------------------------------------------------------------------------------

// A committed scene and what it was made of.
typedef struct explained_world {
    const char *name;
    uint64_t seed;
    occ_camera_desc camera;
    const occ_box *objects;
    const world_occluder *occluders;
    const world_sheet *sheets; // their handles come after those of the boxes
    uint32_t object_count, occluder_count, sheet_count;
    occ_scene *scene;
    occ_object *handles;
    occ_occluder *occluder_handles;
} explained_world;

static void *room_for(size_t count, size_t size)
{
    void *room = calloc(count + 1, size);
    ck_assert_ptr_nonnull(room);
    return room;
}

static uint32_t handle_count(const explained_world *w)
{
    return w->occluder_count + w->sheet_count;
}

static void add_sheets(explained_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++) {
        int owner = w->sheets[i].owner;
        const occ_object of = owner < 0 ? (occ_object){0, 0} : w->handles[owner];
        ck_assert_int_eq(occ_scene_add_sheet(w->scene, &w->sheets[i].sheet, of,
                                             &w->occluder_handles[w->occluder_count + i]),
                         OCC_SUCCESS);
    }
}

static void build(explained_world *w, uint32_t leaf_objects)
{
    const occ_scene_desc desc = {.leaf_objects = leaf_objects};
    w->handles = room_for(w->object_count, sizeof *w->handles);
    w->occluder_handles = room_for(handle_count(w), sizeof *w->occluder_handles);
    occ_box *boxes = room_for(w->occluder_count, sizeof *boxes);
    occ_object *owners = room_for(w->occluder_count, sizeof *owners);
    for (uint32_t i = 0; i < w->occluder_count; i++)
        boxes[i] = w->occluders[i].box;
    ck_assert_int_eq(occ_scene_create(&desc, &w->scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_many(w->scene, w->objects, w->object_count, w->handles),
                     OCC_SUCCESS);
    for (uint32_t i = 0; i < w->occluder_count; i++)
        if (w->occluders[i].owner >= 0) owners[i] = w->handles[w->occluders[i].owner];
    ck_assert_int_eq(
        occ_scene_add_occluders(w->scene, boxes, owners, w->occluder_count, w->occluder_handles),
        OCC_SUCCESS);
    add_sheets(w);
    ck_assert_int_eq(occ_scene_commit(w->scene), OCC_SUCCESS);
    free(boxes);
    free(owners);
}

static void tear_down(explained_world *w)
{
    occ_scene_destroy(w->scene);
    free(w->handles);
    free(w->occluder_handles);
}

// --- one explanation -----------------------------------------------------------------------------

typedef struct explanation {
    occ_fate fate;
    size_t count;
    occ_occluder named[MOST_NAMED];
} explanation;

static explanation explain(const occ_view *view, const explained_world *w, uint32_t object)
{
    explanation e = {.count = 0};
    occ_result result = occ_view_explain(view, w->scene, w->handles[object], &e.fate, e.named,
                                         MOST_NAMED, &e.count);
    KIT_CHECK(result == OCC_SUCCESS, "%s %llu: object %u: %s", w->name, (unsigned long long)w->seed,
              object, occ_result_name(result));
    return e;
}

// The occluder's place in the world.
static uint32_t place_of(const explained_world *w, occ_occluder named)
{
    for (uint32_t i = 0; i < handle_count(w); i++)
        if (kit_same_bits(&w->occluder_handles[i], &named, sizeof named)) return i;
    ck_abort_msg("occluder {%u, %u} is none", named.index, named.generation);
}

// `format` goes on from "family 3: object 5 ".
#define CHECK_OBJECT(condition, w, object, format, ...)                                            \
    KIT_CHECK(condition, "%s %llu: object %u " format, (w)->name, (unsigned long long)(w)->seed,   \
              (unsigned)(object), __VA_ARGS__)

typedef struct explained_counts {
    uint64_t outside, by_one, by_several, by_sheets;
} explained_counts;

// The occluders that took part.
typedef struct participants {
    occ_occluder *list;
    size_t count;
} participants;

static participants read_participants(const occ_view *view, const explained_world *w)
{
    participants p = {room_for(handle_count(w), sizeof *p.list), 0};
    ck_assert_int_eq(occ_view_read_occluders(view, p.list, handle_count(w), &p.count), OCC_SUCCESS);
    return p;
}

// That the named are among them, in their order.
static void check_order(const explained_world *w, const participants *p, const explanation *e)
{
    size_t at = 0;
    for (size_t i = 0; i < e->count; i++, at++) {
        while (at < p->count && !kit_same_bits(&p->list[at], &e->named[i], sizeof e->named[i]))
            at++;
        KIT_CHECK(at < p->count, "%s %llu: occluder %zu took no part, or is out of order", w->name,
                  (unsigned long long)w->seed, i);
    }
}

// That the named alone hide the object. Returns how many of them are sheets.
static size_t check_hidden(judge *j, const explained_world *w, uint32_t object,
                           const explanation *e)
{
    occ_box boxes[MOST_NAMED];
    occ_sheet sheets[MOST_NAMED];
    size_t box_count = 0, sheet_count = 0;
    const occ_box *box = &w->objects[object];
    CHECK_OBJECT(e->count > 0, w, object, "is hidden by %zu", e->count);
    for (size_t i = 0; i < e->count; i++) {
        uint32_t place = place_of(w, e->named[i]);
        bool is_sheet = place >= w->occluder_count;
        const world_sheet *sheet = is_sheet ? &w->sheets[place - w->occluder_count] : NULL;
        int owner = is_sheet ? sheet->owner : w->occluders[place].owner;
        CHECK_OBJECT(owner != (int)object, w, object, "is hidden by its own: %zu", i);
        if (is_sheet)
            sheets[sheet_count++] = sheet->sheet;
        else
            boxes[box_count++] = w->occluders[place].box;
    }
    judge_set_occluders(j, boxes, NULL, box_count);
    judge_add_sheets(j, sheets, NULL, sheet_count);
    CHECK_OBJECT(!judge_sees(j, box, -1), w, object, "can be seen past the %zu that hide it",
                 e->count);
    if (e->count == 1 && box_count == 1 && judge_frustum(j, box) == JUDGE_INSIDE)
        CHECK_OBJECT(judge_single(j, box, &boxes[0]) == JUDGE_HIDDEN, w, object,
                     "can be seen past the %zu", e->count);
    return sheet_count;
}

static void check_object(judge *j, const explained_world *w, const occ_view *view,
                         const participants *p, uint32_t object, explained_counts *counts)
{
    explanation e = explain(view, w, object);
    bool visible = occ_view_is_visible(view, w->handles[object]);
    CHECK_OBJECT(visible == (e.fate == OCC_FATE_VISIBLE), w, object, "has fate %d", (int)e.fate);
    counts->outside += e.fate == OCC_FATE_OUTSIDE;
    counts->by_one += e.count == 1;
    counts->by_several += e.count > 1;
    if (e.fate == OCC_FATE_HIDDEN) {
        counts->by_sheets += check_hidden(j, w, object, &e);
        check_order(w, p, &e);
        return;
    }
    CHECK_OBJECT(e.count == 0, w, object, "is not hidden, but by %zu", e.count);
    if (e.fate == OCC_FATE_OUTSIDE)
        CHECK_OBJECT(judge_frustum(j, &w->objects[object]) == JUDGE_OUTSIDE, w, object,
                     "is in the frustum: fate %d", (int)e.fate);
}

// Every object of a culled world.
static void check_world(const explained_world *w, const occ_view *view, explained_counts *counts)
{
    judge *j = judge_of_camera(&w->camera);
    ck_assert_ptr_nonnull(j);
    participants p = read_participants(view, w);
    for (uint32_t i = 0; i < w->object_count; i++)
        check_object(j, w, view, &p, i, counts);
    free(p.list);
    judge_free(j);
}

static void check_same(const explained_world *w, const occ_view *a, const occ_view *b)
{
    for (uint32_t i = 0; i < w->object_count; i++) {
        explanation x = explain(a, w, i), y = explain(b, w, i);
        CHECK_OBJECT(kit_same_bits(&x, &y, sizeof x), w, i, "is explained by %zu and %zu", x.count,
                     y.count);
    }
}

// --- hard worlds ---------------------------------------------------------------------------------

enum { KNOBS = 4 };

static occ_cull_desc knobs_of(int k)
{
    if (k == 0) return world_knobs(OCC_METHOD_FUSED);
    if (k == 1) return (occ_cull_desc){.method = OCC_METHOD_FUSED, .max_splits = 4};
    return world_knobs(k == 2 ? OCC_METHOD_SINGLE : OCC_METHOD_PAIRWISE);
}

// False if the library refuses its camera.
static bool make_hard(explained_world *w, family_world *made, const family *f, uint64_t number)
{
    family_place place = family_sweep(number);
    f->make(made, &place);
    *w = (explained_world){.name = f->name,
                           .seed = number,
                           .camera = made->camera,
                           .objects = made->objects,
                           .occluders = made->occluders,
                           .sheets = made->sheets,
                           .object_count = made->object_count,
                           .occluder_count = made->occluder_count,
                           .sheet_count = made->sheet_count};
    judge *j = judge_of_camera(&w->camera);
    if (j) judge_free(j);
    return j != NULL;
}

static void cull_and_check(const explained_world *w, const occ_cull_desc *knobs, occ_view *plain,
                           occ_view *openmp, explained_counts *counts)
{
    kit_cull(plain, w->scene, &w->camera, knobs);
    kit_cull(openmp, w->scene, &w->camera, knobs);
    check_world(w, plain, counts);
    check_same(w, plain, openmp);
}

START_TEST(what_a_hard_world_hides_is_hidden_by_those_named)
{
    occ_view *plain = world_view(OCC_BACKEND_PLAIN, 0);
    occ_view *openmp = world_view(OCC_BACKEND_OPENMP, 2);
    explained_counts counts[KNOBS] = {{0}};
    family_world made;
    explained_world w;
    for (const family *f = families; f->name; f++)
        for (uint64_t i = 0; i < WORLD_SHARE(84); i++) {
            if (!make_hard(&w, &made, f, i)) continue;
            build(&w, 4);
            for (int k = 0; k < KNOBS; k++) {
                occ_cull_desc knobs = knobs_of(k);
                cull_and_check(&w, &knobs, plain, openmp, &counts[k]);
            }
            tear_down(&w);
        }
    for (int k = 0; k < KNOBS; k++) {
        ck_assert_uint_gt(counts[k].by_one, WORLD_SHARE(1000));
        ck_assert_uint_gt(counts[k].outside, WORLD_SHARE(1000));
        ck_assert_uint_gt(counts[k].by_sheets, WORLD_SHARE(1000));
        if (k < 2) ck_assert_uint_gt(counts[k].by_several, WORLD_SHARE(200));
        if (k >= 2) ck_assert_uint_eq(counts[k].by_several, 0);
    }
    occ_view_destroy(plain);
    occ_view_destroy(openmp);
}
END_TEST

START_TEST(a_device_says_the_same)
{
    occ_view *plain = world_view(OCC_BACKEND_PLAIN, 0);
    occ_view *device = world_view(OCC_BACKEND_OPENCL, 0);
    occ_cull_desc knobs = knobs_of(0);
    family_world made;
    explained_world w;
    for (const family *f = families; f->name && device; f++)
        for (uint64_t i = 0; i < 4; i++) {
            if (!make_hard(&w, &made, f, i)) continue;
            build(&w, 4);
            kit_cull(plain, w.scene, &w.camera, &knobs);
            kit_cull(device, w.scene, &w.camera, &knobs);
            check_same(&w, plain, device);
            tear_down(&w);
        }
    occ_view_destroy(plain);
    occ_view_destroy(device);
}
END_TEST

// --- random worlds -------------------------------------------------------------------------------

enum { RANDOM_OBJECTS = 120, RANDOM_OCCLUDERS = 40 };

// Objects in heaps, so that whole nodes fall, behind panels and boxes of any kind.
static void fill_random(kit_random *random, occ_box *objects, world_occluder *occluders)
{
    double heap[3] = {0, 0, 0};
    for (int i = 0; i < RANDOM_OBJECTS; i++) {
        double center[3];
        for (int j = 0; j < 3; j++) {
            if (i % 12 == 0) heap[j] = world_between(random, -12, 12) - (j == 2 ? 25.0 : 0.0);
            center[j] = heap[j] + world_between(random, -1, 1);
        }
        world_shape shape = (world_shape)kit_below(random, WORLD_SHAPES);
        objects[i] = world_box(random, shape, center, world_scale(random, 0.1, 1));
    }
    for (int i = 0; i < RANDOM_OCCLUDERS; i++) {
        double center[3] = {world_between(random, -7, 7), world_between(random, -5, 5),
                            world_between(random, -12, -4)};
        world_shape shape =
            kit_below(random, 3) ? WORLD_ALIGNED : (world_shape)kit_below(random, WORLD_SHAPES);
        int owner = kit_below(random, 2) ? -1 : (int)kit_below(random, RANDOM_OBJECTS);
        occluders[i] =
            (world_occluder){world_box(random, shape, center, world_between(random, 1, 4)), owner};
    }
}

START_TEST(what_a_random_world_hides_is_hidden_by_those_named)
{
    occ_view *plain = world_view(OCC_BACKEND_PLAIN, 0);
    occ_view *openmp = world_view(OCC_BACKEND_OPENMP, 2);
    explained_counts counts = {0};
    uint64_t fallen = 0;
    for (uint64_t seed = 1; seed <= WORLD_SHARE(600); seed++) {
        kit_random random = {seed};
        occ_box objects[RANDOM_OBJECTS];
        world_occluder occluders[RANDOM_OCCLUDERS];
        world_lens lens = {.projection = (world_projection)kit_below(&random, WORLD_PROJECTIONS)};
        const float eye[3] = {kit_between(&random, -2, 2), kit_between(&random, -2, 2), 0};
        const float target[3] = {0, 0, -20};
        fill_random(&random, objects, occluders);
        explained_world w = {.name = "random",
                             .seed = seed,
                             .camera = world_camera(eye, target, &lens),
                             .objects = objects,
                             .occluders = occluders,
                             .object_count = RANDOM_OBJECTS,
                             .occluder_count = RANDOM_OCCLUDERS};
        build(&w, 1 + kit_below(&random, 8));
        occ_cull_desc knobs = {.method = OCC_METHOD_FUSED,
                               .grain = 1 + kit_below(&random, 16),
                               .max_splits = 1u << kit_below(&random, 8)};
        cull_and_check(&w, &knobs, plain, openmp, &counts);
        occ_view_stats stats;
        ck_assert_int_eq(occ_view_get_stats(plain, &stats), OCC_SUCCESS);
        fallen += stats.walk_hidden;
        tear_down(&w);
    }
    ck_assert_uint_gt(fallen, WORLD_SHARE(100));
    ck_assert_uint_gt(counts.by_one, WORLD_SHARE(100));
    ck_assert_uint_gt(counts.by_several, WORLD_SHARE(100));
    occ_view_destroy(plain);
    occ_view_destroy(openmp);
}
END_TEST

// --- named scenes --------------------------------------------------------------------------------

static const char *const scene_names[] = {"city", "soup", "interior"};

START_TEST(what_a_scene_hides_is_hidden_by_those_named)
{
    obs_scene file;
    ck_assert(scenes_make(scene_names[_i], 3000, 1, &file));
    world_occluder *occluders = room_for(file.occluder_count, sizeof *occluders);
    for (uint32_t i = 0; i < file.occluder_count; i++)
        occluders[i] = (world_occluder){file.occluders[i].box, (int)file.occluders[i].owner};
    explained_world w = {.name = scene_names[_i],
                         .objects = file.objects,
                         .occluders = occluders,
                         .object_count = file.object_count,
                         .occluder_count = file.occluder_count};
    build(&w, 16);
    occ_view *plain = world_view(OCC_BACKEND_PLAIN, 0);
    occ_view *openmp = world_view(OCC_BACKEND_OPENMP, 2);
    explained_counts counts = {0};
    for (uint32_t f = 0; f < file.frame_count; f += file.frame_count / WORLD_SHARE(20) + 1) {
        double eye[3];
        w.seed = f;
        w.camera = kit_obs_camera(&file.frames[f], eye);
        occ_cull_desc knobs = {
            .method = OCC_METHOD_FUSED, .preset = (occ_preset)(f % 3), .grain = 16};
        cull_and_check(&w, &knobs, plain, openmp, &counts);
    }
    ck_assert_uint_gt(counts.by_one, WORLD_SHARE(1000));
    ck_assert_uint_gt(counts.by_several, WORLD_SHARE(20));
    tear_down(&w);
    free(occluders);
    obs_free(&file);
    occ_view_destroy(plain);
    occ_view_destroy(openmp);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("explain");
    TCase *judged = tcase_create("judged");
    tcase_add_test(judged, what_a_hard_world_hides_is_hidden_by_those_named);
    tcase_add_test(judged, what_a_random_world_hides_is_hidden_by_those_named);
    suite_add_tcase(suite, judged);
    TCase *scenes = tcase_create("scenes");
    tcase_add_loop_test(scenes, what_a_scene_hides_is_hidden_by_those_named, 0,
                        sizeof scene_names / sizeof *scene_names);
    suite_add_tcase(suite, scenes);
    TCase *device = tcase_create("device");
    tcase_add_test(device, a_device_says_the_same);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
