// SPDX-License-Identifier: Apache-2.0
#include "kit_model.h"

#include "kit_sheets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NOBODY UINT32_MAX

kit_model *kit_model_create(uint64_t seed, const occ_scene_desc *desc)
{
    kit_model *model = calloc(1, sizeof *model);
    KIT_CHECK(model, "out of memory");
    model->random.state = seed;
    model->owned = 3;
    KIT_CHECK(!occ_scene_create(desc, &model->scene), "no scene");
    return model;
}

void kit_model_destroy(kit_model *model)
{
    occ_scene_destroy(model->scene);
    free(model);
}

// --- edits ---------------------------------------------------------------------------------------

// One that is alive, or NOBODY.
static uint32_t any_object(kit_model *model)
{
    for (int tries = 0; tries < 20 && model->object_count; tries++) {
        uint32_t i = kit_below(&model->random, model->object_count);
        if (model->objects[i].alive) return i;
    }
    return NOBODY;
}

static uint32_t any_occluder(kit_model *model)
{
    for (int tries = 0; tries < 20 && model->occluder_count; tries++) {
        uint32_t i = kit_below(&model->random, model->occluder_count);
        if (model->occluders[i].alive) return i;
    }
    return NOBODY;
}

// Mostly small boxes, now and then a point, a plane across the world, or one far away.
static occ_box any_box(kit_random *random)
{
    uint32_t kind = kit_below(random, 40);
    if (kind == 0) return (occ_box){{0, -1, 0}, {{150, 0, 0}, {0, 0, 0}, {0, 0, 150}}};
    if (kind == 1) return kit_cube(kit_between(random, -50, 50), 1, 1, 0);
    if (kind == 2) return kit_box(random, 100, 40);
    if (kind == 3 && !kit_below(random, 4)) return kit_box(random, 1e5f, 10);
    if (kind < 8) return kit_cube((float)kit_below(random, 4), 0, 0, 1); // alike: ties in the order
    return kit_box(random, 100, 2);
}

// Small moves keep most objects in their cells.
static occ_box moved(kit_random *random, const occ_box *box)
{
    if (!kit_below(random, 3)) return any_box(random);
    occ_box near = *box;
    for (int j = 0; j < 3; j++) {
        near.center[j] += kit_between(random, -0.001f, 0.001f);
        near.axis[j][j] *= kit_between(random, 0.999f, 1.001f);
    }
    return near;
}

// Of every shape, and some that hide nothing: bent, crossed, a line.
static occ_sheet any_sheet(kit_random *random)
{
    occ_box box = any_box(random);
    occ_sheet sheet = kit_sheet_of_box(&box);
    uint32_t kind = kit_below(random, 4), corners = 3 + kit_below(random, 6);
    if (kind == 0) sheet.sides = OCC_SIDES_FRONT;
    if (kind == 1) sheet = kit_round_sheet(random, corners, box.center, 5);
    if (kind != 2) return sheet;
    sheet.corner_count = corners;
    for (uint32_t i = 0; i < corners; i++)
        for (int j = 0; j < 3; j++)
            sheet.corner[i][j] = box.center[j] + (j ? 0.0f : kit_between(random, -3, 3));
    return sheet;
}

static occ_sheet moved_sheet(kit_random *random, const kit_occluder *from)
{
    occ_sheet sheet = from->sheet;
    if (!from->is_sheet || !kit_below(random, 3)) return any_sheet(random);
    for (uint32_t i = 0; i < sheet.corner_count; i++)
        for (int j = 0; j < 3; j++)
            sheet.corner[i][j] += kit_between(random, -0.001f, 0.001f);
    return sheet;
}

static void add_objects(kit_model *model)
{
    occ_box boxes[32];
    occ_object handles[32];
    uint32_t count = kit_below(&model->random, 2) ? 1 : 1 + kit_below(&model->random, 32);
    if (model->object_count + count > KIT_MOST) return;
    for (uint32_t i = 0; i < count; i++)
        boxes[i] = any_box(&model->random);
    occ_result result = count == 1 ? occ_scene_add(model->scene, boxes, handles)
                                   : occ_scene_add_many(model->scene, boxes, count, handles);
    KIT_CHECK(!result, "objects are refused");
    for (uint32_t i = 0; i < count; i++)
        model->objects[model->object_count++] = (kit_object){handles[i], boxes[i], true};
}

static void move_objects(kit_model *model)
{
    occ_box boxes[16];
    occ_object handles[16];
    uint32_t count = 0;
    for (uint32_t most = 1 + kit_below(&model->random, 16); count < most; count++) {
        uint32_t i = any_object(model);
        if (i == NOBODY) break;
        kit_object *object = &model->objects[i];
        handles[count] = object->handle;
        boxes[count] = object->box = moved(&model->random, &object->box);
    }
    occ_result result = count == 1 ? occ_scene_move(model->scene, *handles, boxes)
                                   : occ_scene_move_many(model->scene, handles, boxes, count);
    KIT_CHECK(!result, "a move is refused");
}

static void remove_object(kit_model *model)
{
    uint32_t i = any_object(model);
    if (i == NOBODY) return;
    KIT_CHECK(!occ_scene_remove(model->scene, model->objects[i].handle), "an object stays");
    model->objects[i].alive = false;
    for (uint32_t k = 0; k < model->occluder_count; k++)
        if (model->occluders[k].owner == i) model->occluders[k].alive = false;
}

// Now and then one that owns an occluder already.
static uint32_t any_owner(kit_model *model)
{
    uint32_t k = kit_below(&model->random, 3) ? NOBODY : any_occluder(model);
    uint32_t owner = k == NOBODY ? NOBODY : model->occluders[k].owner;
    return owner == NOBODY ? any_object(model) : owner;
}

static void add_occluder(kit_model *model)
{
    uint32_t owner = kit_below(&model->random, 4) < model->owned ? any_owner(model) : NOBODY;
    if (model->occluder_count == KIT_MOST) return;
    occ_object handle = {0, 0};
    occ_box box = any_box(&model->random);
    if (owner != NOBODY) {
        handle = model->objects[owner].handle;
        box = model->objects[owner].box;
        for (int k = 0; k < 9; k++)
            box.axis[k / 3][k % 3] *= 0.5f;
    }
    kit_occluder *made = &model->occluders[model->occluder_count++];
    *made = (kit_occluder){.box = box, .owner = owner, .alive = true};
    made->is_sheet = !kit_below(&model->random, 3);
    if (made->is_sheet) {
        made->sheet = any_sheet(&model->random);
        KIT_CHECK(!occ_scene_add_sheet(model->scene, &made->sheet, handle, &made->handle),
                  "refused");
    } else {
        KIT_CHECK(!occ_scene_add_occluder(model->scene, &box, handle, &made->handle), "refused");
    }
}

static void move_occluder(kit_model *model)
{
    uint32_t i = any_occluder(model);
    if (i == NOBODY) return;
    kit_occluder *occluder = &model->occluders[i];
    bool to_sheet = kit_below(&model->random, 8) ? occluder->is_sheet : !occluder->is_sheet;
    if (to_sheet) {
        occluder->sheet = moved_sheet(&model->random, occluder);
        KIT_CHECK(!occ_scene_move_sheet(model->scene, occluder->handle, &occluder->sheet),
                  "refused");
        occluder->is_sheet = true;
        return;
    }
    occluder->is_sheet = false;
    occluder->box = moved(&model->random, &occluder->box);
    KIT_CHECK(!occ_scene_move_occluder(model->scene, occluder->handle, &occluder->box), "refused");
}

static void remove_occluder(kit_model *model)
{
    uint32_t i = any_occluder(model);
    if (i == NOBODY) return;
    KIT_CHECK(!occ_scene_remove_occluder(model->scene, model->occluders[i].handle), "it stays");
    model->occluders[i].alive = false;
}

void kit_model_edit(kit_model *model)
{
    uint32_t what = kit_below(&model->random, 100);
    if (what < 25) {
        add_objects(model);
    } else if (what < 45) {
        move_objects(model);
    } else if (what < 65) {
        for (uint32_t n = 1 + kit_below(&model->random, 14); n > 0; n--)
            remove_object(model);
    } else if (what < 82) {
        for (uint32_t n = 1 + kit_below(&model->random, 8); n > 0; n--)
            add_occluder(model);
    } else if (what < 92) {
        move_occluder(model);
    } else {
        remove_occluder(model);
    }
}

// --- comparisons ---------------------------------------------------------------------------------

static void check_object(const kit_model *model, uint32_t i)
{
    const kit_object *object = &model->objects[i];
    occ_box box;
    occ_result result = occ_scene_box(model->scene, object->handle, &box);
    KIT_CHECK(occ_scene_contains(model->scene, object->handle) == object->alive,
              "object %u is where it should not be", i);
    KIT_CHECK(result == (object->alive ? OCC_SUCCESS : OCC_ERROR_STALE_HANDLE), "object %u: %s", i,
              occ_result_name(result));
    if (!object->alive) return;
    KIT_CHECK(kit_same_bits(&box, &object->box, sizeof box), "object %u has another's box", i);
    KIT_CHECK(occ_object_slot(object->handle) < occ_scene_slot_count(model->scene),
              "object %u is beyond the mask", i);
}

static void check_occluder(const kit_model *model, uint32_t i)
{
    const kit_occluder *occluder = &model->occluders[i];
    occ_box box;
    occ_sheet sheet;
    occ_object owner, expected = {0, 0};
    occ_result result =
        occluder->is_sheet
            ? occ_scene_occluder_sheet(model->scene, occluder->handle, &sheet, &owner)
            : occ_scene_occluder_box(model->scene, occluder->handle, &box, &owner);
    KIT_CHECK(result == (occluder->alive ? OCC_SUCCESS : OCC_ERROR_STALE_HANDLE), "occluder %u: %s",
              i, occ_result_name(result));
    if (!occluder->alive) return;
    bool same = occluder->is_sheet ? kit_same_sheets(&sheet, &occluder->sheet)
                                   : kit_same_bits(&box, &occluder->box, sizeof box);
    KIT_CHECK(same, "occluder %u is another's", i);
    if (occluder->owner != NOBODY) expected = model->objects[occluder->owner].handle;
    KIT_CHECK(owner.index == expected.index && owner.generation == expected.generation,
              "occluder %u has another owner", i);
}

void kit_model_check(const kit_model *model)
{
    uint32_t objects = 0, occluders = 0;
    for (uint32_t i = 0; i < model->object_count; i++) {
        check_object(model, i);
        objects += model->objects[i].alive;
    }
    for (uint32_t i = 0; i < model->occluder_count; i++) {
        check_occluder(model, i);
        occluders += model->occluders[i].alive;
    }
    occ_scene_stats stats;
    KIT_CHECK(!occ_scene_get_stats(model->scene, &stats), "no stats");
    KIT_CHECK(stats.objects == objects, "%u objects are counted as %u", objects, stats.objects);
    if (!occ_scene_is_committed(model->scene)) return; // orphans are counted until then
    KIT_CHECK(stats.occluders == occluders, "%u occluders are counted as %u", occluders,
              stats.occluders);
}

// --- building anew -------------------------------------------------------------------------------

// What is to stand in each slot, as an index into the list, or NOBODY; then the slots that matter,
// in the order in which they are to be filled.
typedef struct plan {
    uint32_t at[KIT_MOST];
    uint32_t order[KIT_MOST];
    uint32_t count;
} plan;

static void make_order(kit_model *model, kit_history history, uint32_t slots, plan *p)
{
    p->count = 0;
    for (uint32_t s = 0; s < slots; s++)
        if (p->at[s] != NOBODY || history == KIT_SAME_SLOTS) p->order[p->count++] = s;
    for (uint32_t i = p->count; history == KIT_SHUFFLED && i > 1; i--) {
        uint32_t j = kit_below(&model->random, i), swap = p->order[i - 1];
        p->order[i - 1] = p->order[j];
        p->order[j] = swap;
    }
}

static void plan_objects(kit_model *model, kit_history history, plan *p)
{
    memset(p->at, 0xff, sizeof p->at);
    for (uint32_t i = 0; i < model->object_count; i++)
        if (model->objects[i].alive) p->at[occ_object_slot(model->objects[i].handle)] = i;
    make_order(model, history, model->scene->objects.count, p);
}

static void plan_occluders(kit_model *model, kit_history history, plan *p)
{
    memset(p->at, 0xff, sizeof p->at);
    for (uint32_t i = 0; i < model->occluder_count; i++)
        if (model->occluders[i].alive) p->at[model->occluders[i].handle.index - 1] = i;
    make_order(model, history, model->scene->occluders.count, p);
}

static void build_objects(const kit_model *model, const plan *p, occ_scene *scene,
                          occ_object *handles, bool with_commits)
{
    static const occ_box filler = {{1e3f, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    occ_object unwanted[KIT_MOST];
    uint32_t fillers = 0;
    for (uint32_t k = 0; k < p->count; k++) {
        uint32_t i = p->at[p->order[k]];
        bool real = i != NOBODY;
        KIT_CHECK(!occ_scene_add(scene, real ? &model->objects[i].box : &filler,
                                 real ? &handles[i] : &unwanted[fillers++]),
                  "an object is refused");
        if (with_commits && k % 97 == 13) KIT_CHECK(!occ_scene_commit(scene), "no commit");
    }
    while (fillers)
        KIT_CHECK(!occ_scene_remove(scene, unwanted[--fillers]), "a filler stays");
}

static void build_occluders(const kit_model *model, const plan *p, occ_scene *scene,
                            const occ_object *handles)
{
    static const occ_box filler = {{0, 1e3f, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    static const occ_object nobody = {0, 0};
    occ_occluder made, unwanted[KIT_MOST];
    uint32_t fillers = 0;
    for (uint32_t k = 0; k < p->count; k++) {
        uint32_t i = p->at[p->order[k]];
        const kit_occluder *real = i == NOBODY ? NULL : &model->occluders[i];
        occ_object owner = real && real->owner != NOBODY ? handles[real->owner] : nobody;
        occ_result result = real && real->is_sheet
                                ? occ_scene_add_sheet(scene, &real->sheet, owner, &made)
                                : occ_scene_add_occluder(scene, real ? &real->box : &filler, owner,
                                                         real ? &made : &unwanted[fillers++]);
        KIT_CHECK(!result, "an occluder is refused");
    }
    while (fillers)
        KIT_CHECK(!occ_scene_remove_occluder(scene, unwanted[--fillers]), "a filler stays");
}

occ_scene *kit_model_rebuild(kit_model *model, kit_history history, uint32_t *slot_map)
{
    occ_scene_desc desc = {.leaf_objects = model->scene->object_tree.leaf_items};
    occ_scene *scene;
    KIT_CHECK(!occ_scene_create(&desc, &scene), "no scene");
    plan *p = malloc(sizeof *p);
    occ_object *handles = calloc(KIT_MOST, sizeof *handles);
    KIT_CHECK(p && handles, "out of memory");
    plan_objects(model, history, p);
    build_objects(model, p, scene, handles, history == KIT_SHUFFLED);
    memset(slot_map, 0xff, KIT_MOST * sizeof *slot_map);
    for (uint32_t i = 0; i < model->object_count; i++) {
        if (!model->objects[i].alive) continue;
        slot_map[occ_object_slot(model->objects[i].handle)] = occ_object_slot(handles[i]);
    }
    plan_occluders(model, history, p);
    build_occluders(model, p, scene, handles);
    KIT_CHECK(!occ_scene_commit(scene), "no commit");
    free(p);
    free(handles);
    return scene;
}
