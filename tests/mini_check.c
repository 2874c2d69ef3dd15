// SPDX-License-Identifier: Apache-2.0
#include "mini_check.h"

#include "judge.h"
#include "oracle.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const backends[MINI_VIEWS] = {"plain", "OpenMP", "OpenCL"};

mini_views mini_open_views(bool device)
{
    mini_views views = {.view = {world_view(OCC_BACKEND_PLAIN, 0)}};
    views.view[1] = world_view(OCC_BACKEND_OPENMP, 2);
    if (device) views.view[2] = world_view(OCC_BACKEND_OPENCL, 0);
    return views;
}

void mini_close_views(mini_views *views)
{
    for (int v = 0; v < MINI_VIEWS; v++)
        occ_view_destroy(views->view[v]);
    *views = (mini_views){.view = {NULL}};
}

// The methods; `single` and `fused` a second time with nodes and limits as they are by default, or
// as the fast preset has them.
typedef struct trial {
    const char *name;
    occ_cull_desc knobs;
} trial;

enum { TRIALS = 6 };

static void set_trials(trial trials[TRIALS])
{
    trials[0] = (trial){"frustum", world_knobs(OCC_METHOD_FRUSTUM)};
    trials[1] = (trial){"pairwise", world_knobs(OCC_METHOD_PAIRWISE)};
    trials[2] = (trial){"single", world_knobs(OCC_METHOD_SINGLE)};
    trials[2].knobs.grain = 1;
    trials[3] = (trial){"single", {.method = OCC_METHOD_SINGLE}};
    trials[4] = (trial){"fused", world_knobs(OCC_METHOD_FUSED)};
    trials[5] = (trial){"fused", {.method = OCC_METHOD_FUSED, .preset = OCC_PRESET_FAST}};
}

// One world under examination. The judges come when an object is left out.
typedef struct court {
    const mini *m;
    occ_camera_desc camera;
    oracle *one;
    judge *many;
    // What has been found of each object.
    bool heard[MINI_OBJECTS], is_outside[MINI_OBJECTS], is_behind[MINI_OBJECTS];
    bool is_seen[MINI_OBJECTS];
    mini_fault *fault;
} court;

#ifdef __GNUC__
__attribute__((format(printf, 2, 3)))
#endif
static bool
accuse(court *c, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->fault->text, sizeof c->fault->text, format, arguments);
    va_end(arguments);
    return true;
}

static void call_judges(court *c)
{
    occ_box boxes[MINI_OCCLUDERS];
    int owners[MINI_OCCLUDERS];
    for (uint32_t k = 0; k < c->m->occluder_count; k++) {
        boxes[k] = c->m->occluders[k].box;
        owners[k] = c->m->occluders[k].owner;
    }
    c->one = oracle_of_camera(&c->camera);
    c->many = judge_of_camera(&c->camera);
    if (c->many) judge_set_occluders(c->many, boxes, owners, c->m->occluder_count);
}

// What the judges say of object i.
static void hear(court *c, uint32_t i)
{
    const occ_box *object = &c->m->objects[i];
    c->heard[i] = true;
    c->is_outside[i] = oracle_outside(c->one, object);
    for (uint32_t k = 0; k < c->m->occluder_count && !c->is_behind[i]; k++)
        c->is_behind[i] = c->m->occluders[k].owner != (int)i &&
                          oracle_box(c->one, object, &c->m->occluders[k].box) == ORACLE_HIDDEN;
    c->is_seen[i] = judge_sees(c->many, object, (int)i);
    if (c->is_outside[i] && judge_frustum(c->many, object) != JUDGE_OUTSIDE) c->is_seen[i] = true;
}

static bool is_wrong(court *c, const trial *t, const char *backend, uint32_t i)
{
    if (!c->one && !c->many) call_judges(c);
    if (!c->one || !c->many) return accuse(c, "a matrix that has no eye is accepted");
    if (!c->heard[i]) hear(c, i);
    const char *out = t->knobs.method == OCC_METHOD_FRUSTUM ? "outside" : "left out";
    if (c->is_seen[i])
        return accuse(c, "object %u is %s, but seen: %s, %s", i, out, t->name, backend);
    if (t->knobs.method == OCC_METHOD_FUSED) return false; // several together
    bool may_be = c->is_outside[i];
    if (t->knobs.method != OCC_METHOD_FRUSTUM) may_be = may_be || c->is_behind[i];
    if (may_be) return false;
    return accuse(c, "object %u is %s, but by no plane and no occluder: %s, %s", i, out, t->name,
                  backend);
}

// Culls, and looks at all that was left out. `bits` receives the mask.
static bool try_view(court *c, const occ_scene *scene, const trial *t, mini_views *views, int v,
                     uint64_t *bits)
{
    occ_result result = occ_cull(views->view[v], scene, &c->camera, &t->knobs);
    if (result == OCC_ERROR_DEGENERATE_CAMERA || result == OCC_ERROR_OUT_OF_RANGE) {
        views->count.refused++;
        *bits = UINT64_MAX;
        return false;
    }
    if (result) return accuse(c, "%s: %s, %s", occ_result_name(result), t->name, backends[v]);
    *bits = 0;
    for (uint32_t i = 0; i < c->m->object_count; i++) {
        bool sees = world_sees(views->view[v], i);
        *bits |= (uint64_t)sees << i;
        views->count.objects++;
        if (sees) continue;
        views->count.judged++;
        if (is_wrong(c, t, backends[v], i)) return true;
        views->count.outside += c->is_outside[i];
        views->count.hidden += !c->is_outside[i];
    }
    return false;
}

static bool try_all(court *c, const occ_scene *scene, mini_views *views)
{
    trial trials[TRIALS];
    set_trials(trials);
    for (int t = 0; t < TRIALS; t++) {
        uint64_t first = 0, bits = 0;
        for (int v = 0; v < MINI_VIEWS; v++) {
            if (!views->view[v]) continue;
            if (try_view(c, scene, &trials[t], views, v, &bits)) return true;
            if (v == 0) first = bits;
            if (bits != first)
                return accuse(c, "%s: the mask is %#llx, on %s %#llx", trials[t].name,
                              (unsigned long long)first, backends[v], (unsigned long long)bits);
        }
    }
    return false;
}

bool mini_breaks(const mini *m, mini_views *views, mini_fault *fault)
{
    mini_fault unread;
    court c = {.m = m, .camera = mini_view_of(m), .fault = fault ? fault : &unread};
    c.fault->text[0] = 0;
    views->count.worlds++;
    occ_scene *scene = world_scene(m->objects, m->object_count, m->occluders, m->occluder_count, 2);
    bool broken = try_all(&c, scene, views);
    occ_scene_destroy(scene);
    oracle_free(c.one);
    judge_free(c.many);
    return broken;
}
