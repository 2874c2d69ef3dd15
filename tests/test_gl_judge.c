// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// timeout: 120
// The judge of many occluders against OpenGL's occlusion queries, on small worlds. Two sentences
// are tested, each with all of OpenGL's roundings on the side that makes it true of a right judge:
//   - what the judge hides has no sample, where occluders are drawn a little larger and nearer, and
//     the object a little farther;
//   - where the judge sees an object a little smaller past occluders a little larger, there is a
//     sample at the very pixel that it names, occluders being drawn a little farther and the object
//     a little nearer.
// gl_boxes.h says what a little is. The second sentence leaves out what shows by less than that.
#include "gl_queries.h"
#include "judge.h"

#include "support.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>

enum { MOST_OCCLUDERS = 40, OBJECTS = 8, LARGEST = 512 };

// --- worlds --------------------------------------------------------------------------------------

typedef struct gl_world {
    occ_camera_desc camera;
    glb_camera view;
    world_projection projection;
    double eye[3];
    int occluder_count;
    uint32_t owners[MOST_OCCLUDERS];
    occ_box occluders[MOST_OCCLUDERS], grown[MOST_OCCLUDERS], objects[OBJECTS];
} gl_world;

static void point_camera(kit_random *random, const gl_queries *q, gl_world *w)
{
    static const int sizes[][2] = {{64, 64}, {160, 90}, {251, 333}, {LARGEST, LARGEST}};
    const int *size = sizes[kit_below(random, 4)];
    w->projection = (world_projection)kit_below(random, WORLD_PROJECTIONS);
    world_lens lens = {.projection = w->projection, .depth = (occ_depth)kit_below(random, 3)};
    lens.near_z = kit_below(random, 2) ? 0.1f : 1.0f;
    float eye[3], target[3];
    for (int j = 0; j < 3; j++) {
        eye[j] = (float)w->eye[j];
        target[j] = kit_between(random, -1, 1);
    }
    w->camera = world_camera(eye, target, &lens);
    w->view = glq_camera(q, &w->camera, size[0], size[1]);
    for (int r = 0; r < 2; r++) // centers of pixels are nowhere in particular
        w->view.shift[r] = world_between(random, -0.5, 0.5);
}

// Nothing is said of an occluder next to the eye, nor of one without area.
static bool add_occluder(gl_world *w, const occ_box *box, uint32_t owner)
{
    occ_box grown;
    if (w->occluder_count == MOST_OCCLUDERS ||
        !glb_grow(&w->view, box, GLB_MARGIN * w->view.tolerance, &grown) ||
        glb_is_open(&w->view, &grown))
        return false;
    int i = w->occluder_count++;
    w->occluders[i] = *box;
    w->grown[i] = grown;
    w->owners[i] = owner;
    return true;
}

static occ_box any_box(kit_random *random, double reach, double size)
{
    static const world_shape shapes[] = {WORLD_ALIGNED,  WORLD_TURNED, WORLD_SHEARED,
                                         WORLD_MIRRORED, WORLD_SHEET,  WORLD_PLATE};
    double center[3];
    for (int j = 0; j < 3; j++)
        center[j] = world_between(random, -reach, reach);
    return world_box(random, shapes[kit_below(random, 6)], center, size);
}

static void move_away(const gl_world *w, double part, occ_box *box)
{
    for (int j = 0; j < 3; j++)
        box->center[j] -= (float)(part * w->eye[j]);
}

static void any_eye(kit_random *random, gl_world *w)
{
    world_direction(random, w->eye);
    for (int j = 0; j < 3; j++)
        w->eye[j] = (double)(float)(w->eye[j] * world_between(random, 8, 16));
}

// Some objects are part of what hides others.
static void make_scattered(kit_random *random, const gl_queries *q, gl_world *w)
{
    any_eye(random, w);
    point_camera(random, q, w);
    int count = 4 + (int)kit_below(random, 12);
    for (int i = 0; i < count; i++) {
        occ_box box = any_box(random, 3, world_between(random, 0.5, 4));
        add_occluder(w, &box, GLQ_NOBODY);
    }
    for (int i = 0; i < OBJECTS; i++) {
        w->objects[i] = any_box(random, 3, world_scale(random, 0.1, 3));
        move_away(w, world_between(random, -0.2, 0.7), &w->objects[i]);
        occ_box inside = w->objects[i];
        for (int k = 0; k < 9; k++)
            inside.axis[k / 3][k % 3] *= 0.75f;
        if (i % 4 == 0) add_occluder(w, &inside, (uint32_t)i);
    }
}

static float on_grid(kit_random *random, int reach)
{
    return (float)((int)kit_below(random, 2u * (uint32_t)reach + 1u) - reach);
}

// Small whole numbers: boxes touch, share planes, coincide and are seen from the planes of their
// faces.
static occ_box grid_box(kit_random *random, int reach, int size)
{
    occ_box box = {{0}, {{0}}};
    bool aligned = kit_below(random, 3) > 0;
    for (int j = 0; j < 3; j++) {
        box.center[j] = on_grid(random, reach);
        for (int k = 0; k < 3; k++)
            if (!aligned || j == k) box.axis[k][j] = 0.5f * on_grid(random, size);
    }
    return box;
}

static void make_grid(kit_random *random, const gl_queries *q, gl_world *w)
{
    for (int j = 0; j < 3; j++)
        w->eye[j] = (double)on_grid(random, 4);
    int far_axis = (int)kit_below(random, 3);
    w->eye[far_axis] = kit_below(random, 2) ? 10 : -12;
    point_camera(random, q, w);
    for (int i = 0; i < 16; i++) {
        occ_box box = grid_box(random, 3, 4);
        add_occluder(w, &box, GLQ_NOBODY);
    }
    for (int i = 0; i < OBJECTS; i++) {
        occ_box larger; // there is nothing to be counted of what has no area
        do
            w->objects[i] = grid_box(random, 3, 3);
        while (!glb_grow(&w->view, &w->objects[i], 1, &larger));
        if (i % 2) w->objects[i].center[far_axis] += w->eye[far_axis] > 0 ? -5.0f : 5.0f;
    }
}

// Panels that abut, exactly if they are aligned, else with a little overlap; one may be missing.
// What is behind is hidden by several or not at all.
static void make_wall(kit_random *random, const gl_queries *q, gl_world *w)
{
    any_eye(random, w);
    point_camera(random, q, w);
    double center[3] = {0, 0, 0};
    bool aligned = kit_below(random, 2);
    occ_box whole = world_box(random, WORLD_TURNED, center, 6);
    if (aligned) whole = (occ_box){{0}, {{6, 0, 0}, {0, 5, 0}, {0, 0, 0.5f}}};
    if (aligned && kit_below(random, 2)) whole.axis[2][2] = 0;
    int across = 1 << kit_below(random, 3); // floats hold quarters
    int missing = (int)kit_below(random, 2 * (uint32_t)(across * across));
    for (int i = 0; i < across * across; i++) {
        occ_box panel = whole;
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 2; k++) {
                float at = (float)(2 * (k ? i / across : i % across) + 1) / (float)across - 1.0f;
                panel.center[j] += at * whole.axis[k][j];
                panel.axis[k][j] *= (aligned ? 1.0f : 1.001f) / (float)across;
            }
        if (i != missing) add_occluder(w, &panel, GLQ_NOBODY);
    }
    for (int i = 0; i < OBJECTS; i++) {
        w->objects[i] = any_box(random, 1.5, world_scale(random, 0.1, 2));
        move_away(w, world_between(random, 0.1, 0.6), &w->objects[i]);
    }
}

// Objects that coincide with occluders, lie in them with faces in common, or stick out of them.
static void make_intimate(kit_random *random, const gl_queries *q, gl_world *w)
{
    make_scattered(random, q, w);
    for (int i = 0; i < OBJECTS && w->occluder_count > 0; i++) {
        int from = (int)kit_below(random, (uint32_t)w->occluder_count);
        w->owners[from] = GLQ_NOBODY;
        occ_box *object = &w->objects[i];
        *object = w->occluders[from];
        uint32_t k = kit_below(random, 3);
        float factor = i % 4 == 1 ? 0.5f : i % 4 == 2 ? 2.0f : 1.0f; // exact
        float aside = (float)world_scale(random, 0.01, 1) * (kit_below(random, 2) ? 1.0f : -1.0f);
        for (int j = 0; j < 3; j++) {
            if (i % 4 == 3) object->center[j] += aside * object->axis[k][j];
            object->axis[k][j] *= factor;
        }
    }
}

// --- verdicts ------------------------------------------------------------------------------------

// What both say of an object.
typedef struct gl_verdict {
    bool inside;        // it is in the frustum, for the judge
    bool seen;          // by the judge
    bool clear;         // and so by more than OpenGL's roundings
    uint32_t samples;   // counted sparingly
    uint32_t at_pixel;  // counted generously, at the pixel of the judge's witness
    uint32_t at_center; // and at the pixel of the object's center
} gl_verdict;

// NULL, or in what they disagree.
static const char *contradiction(const gl_verdict *v)
{
    if (!v->seen && v->samples > 0) return "the judge hides it, OpenGL does not";
    if (v->clear && !v->seen) return "the judge sees it past larger occluders alone";
    if (v->clear && v->at_pixel == 0) return "the judge sees it at a pixel, OpenGL does not";
    return NULL;
}

// Counts generously at the pixel in the middle of which a point is.
static uint32_t count_at(gl_queries *q, const gl_world *w, const double point[3], uint32_t number)
{
    glb_camera view = w->view;
    double at[2];
    glb_project(&view, point, at);
    for (int r = 0; r < 2; r++)
        view.shift[r] += floor(at[r]) + 0.5 - at[r];
    glq_rect pixel = {(int)floor(at[0]), (int)floor(at[1]), 1, 1};
    uint32_t samples;
    glq_occlude(q, &view, &pixel, w->occluders, w->owners, (size_t)w->occluder_count, GLB_SPARING);
    glq_count(q, &view, &pixel, &w->objects[number], &number, 1, GLB_GENEROUS, &samples);
    return samples;
}

static void set_occluders(judge *j, const gl_world *w, const occ_box *boxes)
{
    int owners[MOST_OCCLUDERS];
    for (int i = 0; i < w->occluder_count; i++)
        owners[i] = w->owners[i] == GLQ_NOBODY ? -1 : (int)w->owners[i];
    judge_set_occluders(j, boxes, owners, (size_t)w->occluder_count);
}

// Asks for the object a little smaller past occluders a little larger.
static bool is_clear(judge *j, const gl_world *w, int number, double witness[3])
{
    occ_box smaller;
    const occ_box *object = &w->objects[number];
    if (!glb_grow(&w->view, object, -GLB_MARGIN * w->view.tolerance, &smaller) ||
        glb_is_open(&w->view, object))
        return false;
    set_occluders(j, w, w->grown);
    return judge_sees(j, &smaller, number) && judge_witness(j, witness);
}

// All but `samples`.
static gl_verdict ask(gl_queries *q, judge *j, const gl_world *w, int number)
{
    const occ_box *object = &w->objects[number];
    gl_verdict v = {.inside = judge_frustum(j, object) != JUDGE_OUTSIDE};
    set_occluders(j, w, w->occluders);
    v.seen = judge_sees(j, object, number);
    double witness[3], center[3];
    for (int k = 0; k < 3; k++)
        center[k] = (double)object->center[k];
    v.clear = is_clear(j, w, number, witness);
    if (v.clear) v.at_pixel = count_at(q, w, witness, (uint32_t)number);
    if (v.inside && !v.seen) v.at_center = count_at(q, w, center, (uint32_t)number);
    return v;
}

// --- tallies -------------------------------------------------------------------------------------

typedef struct gl_tally {
    unsigned seen, clear, hidden, outside; // hidden: in the frustum
    unsigned lies_hidden, lies_seen;       // how many wrong verdicts would be found
} gl_tally;

// Turns the judge's verdict about: is that found?
static void lie(const gl_verdict *v, gl_tally *tally)
{
    gl_verdict wrong = *v;
    if (v->clear) {
        wrong.seen = wrong.clear = false;
        tally->lies_hidden += contradiction(&wrong) != NULL;
    } else if (v->inside && !v->seen) {
        wrong.seen = wrong.clear = true;
        wrong.at_pixel = v->at_center;
        tally->lies_seen += contradiction(&wrong) != NULL;
    }
}

static void judge_world(gl_queries *q, const gl_world *w, int number, gl_tally *tally)
{
    judge *j = judge_of_camera(&w->camera);
    ck_assert_ptr_nonnull(j);
    uint32_t samples[OBJECTS];
    glq_rect all = glq_frustum(&w->view, 1);
    glq_occlude(q, &w->view, &all, w->grown, w->owners, (size_t)w->occluder_count, GLB_GENEROUS);
    glq_count(q, &w->view, &all, w->objects, NULL, OBJECTS, GLB_SPARING, samples);
    for (int i = 0; i < OBJECTS; i++) {
        gl_verdict v = ask(q, j, w, i);
        v.samples = samples[i];
        const char *complaint = contradiction(&v);
        KIT_CHECK(!complaint, "world %d, object %d, projection %d, %g x %g pixels: %s (%s)", number,
                  i, (int)w->projection, w->view.pixels[0], w->view.pixels[1], complaint,
                  glq_renderer(q));
        tally->seen += v.seen;
        tally->clear += v.clear;
        tally->hidden += v.inside && !v.seen;
        tally->outside += !v.inside;
        lie(&v, tally);
    }
    judge_free(j);
}

typedef void gl_maker(kit_random *random, const gl_queries *q, gl_world *w);

// The shares, at least, of verdicts that are compared, and of wrong ones that would be found.
typedef struct gl_power {
    double compared, hidden_found, seen_found;
} gl_power;

static void judge_worlds(gl_maker *make, int count, uint64_t seed, const gl_power *least)
{
    kit_random random = {seed};
    gl_queries *q = glq_open(LARGEST, LARGEST);
    gl_tally tally = {0};
    for (int i = 0; i < count; i++) {
        gl_world w = {.occluder_count = 0};
        make(&random, q, &w);
        judge_world(q, &w, i, &tally);
    }
    double inside = tally.seen + tally.hidden, compared = tally.clear + tally.hidden;
    printf("%s: %u seen, of them %u compared; %u hidden; %u outside; of wrong verdicts %u of %u "
           "hidden ones and %u of %u seen ones found\n",
           glq_renderer(q), tally.seen, tally.clear, tally.hidden, tally.outside, tally.lies_hidden,
           tally.clear, tally.lies_seen, tally.hidden);
    fflush(stdout);
    glq_close(q);
    ck_assert_uint_gt(tally.seen, (unsigned)count);
    ck_assert_uint_gt(tally.hidden, (unsigned)count);
    ck_assert_double_ge(compared, least->compared * inside);
    ck_assert_double_ge(tally.lies_hidden, least->hidden_found * tally.clear);
    ck_assert_double_ge(tally.lies_seen, least->seen_found * tally.hidden);
}

START_TEST(scattered_boxes)
{
    static const gl_power least = {0.95, 0.9, 0.95};
    judge_worlds(make_scattered, 400, 31, &least);
}
END_TEST

START_TEST(boxes_on_a_grid)
{
    static const gl_power least = {0.95, 0.9, 0.95};
    judge_worlds(make_grid, 400, 32, &least);
}
END_TEST

START_TEST(walls_of_abutting_panels)
{
    static const gl_power least = {0.95, 0.85, 0.95};
    judge_worlds(make_wall, 300, 33, &least);
}
END_TEST

// A shared face that a rounding has moved is in doubt, and so is a hidden object that one occluder
// is flush with.
START_TEST(objects_in_and_on_occluders)
{
    static const gl_power least = {0.9, 0.9, 0.7};
    judge_worlds(make_intimate, 300, 34, &least);
}
END_TEST

int main(void)
{
    int skipped = glq_skip();
    if (skipped) return skipped;
    Suite *suite = suite_create("gl_judge");
    TCase *worlds = tcase_create("worlds");
    tcase_add_test(worlds, scattered_boxes);
    tcase_add_test(worlds, boxes_on_a_grid);
    tcase_add_test(worlds, walls_of_abutting_panels);
    tcase_add_test(worlds, objects_in_and_on_occluders);
    suite_add_tcase(suite, worlds);
    return test_run_suite(suite);
}
