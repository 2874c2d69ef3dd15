// SPDX-License-Identifier: Apache-2.0
// Bytes as a sequence of edits. A plain list says what the scene must hold; after each commit the
// octrees must be valid, and the answer that of a scene built anew with the same slots.
#include "bytes.h"

#include <occlude/occlude.h>

#include <math.h>

enum { MOST = 96, OPERATIONS = 200, WORDS = (MOST + 31) / 32 };

typedef struct listed_object {
    occ_object handle;
    occ_box box;
    bool alive;
} listed_object;

typedef struct listed_occluder {
    occ_occluder handle;
    bool is_sheet;
    occ_box box; // if it is none
    occ_sheet sheet;
    uint32_t owner; // index into the list, or MOST
    bool alive;
} listed_occluder;

typedef struct list {
    fuzz_bytes from;
    bool sheets; // of occluders, the next one is a sheet
    occ_scene *scene;
    occ_view *view;
    uint32_t object_count, occluder_count;
    listed_object objects[MOST];
    listed_occluder occluders[MOST];
} list;

// Small whole numbers, which meet and tie; or, now and then, any float at all.
static occ_box read_box(fuzz_bytes *from)
{
    float numbers[12];
    uint8_t kind = fuzz_byte(from);
    for (int k = 0; k < 12; k++) {
        if (kind == 0xff) {
            numbers[k] = fuzz_float(from);
        } else if (k < 3 || (k - 3) % 4 == 0 || kind & 0x80) {
            numbers[k] = ldexpf((float)(int8_t)fuzz_byte(from), (kind & 7) - (k < 3 ? 3 : 6));
        } else {
            numbers[k] = 0.0f;
        }
    }
    occ_box box;
    memcpy(&box, numbers, sizeof box);
    return box;
}

// Small whole numbers in a few planes, or any floats at all; too few or too many corners as well.
static occ_sheet read_sheet(fuzz_bytes *from)
{
    occ_sheet sheet;
    uint8_t kind = fuzz_byte(from);
    const unsigned sides = kind >> 4 & 1u;
    memset(&sheet, 0, sizeof sheet);
    sheet.corner_count = kind & 15u;
    memcpy(&sheet.sides, &sides, sizeof sheet.sides);
    for (uint32_t i = 0; i < sheet.corner_count && i < OCC_SHEET_CORNERS; i++)
        for (int j = 0; j < 3; j++) {
            float *at = &sheet.corner[i][j];
            *at = kind >> 5 == 7 ? fuzz_float(from) : (float)(int8_t)fuzz_byte(from) / 4.0f;
            if (j == kind >> 5 && i) *at = sheet.corner[0][j];
        }
    return sheet;
}

// What the library should say of it.
static occ_result judge_sheet(const occ_sheet *sheet)
{
    occ_result result = OCC_SUCCESS;
    if (sheet->corner_count < 3 || sheet->corner_count > 8) return OCC_ERROR_INVALID_ARGUMENT;
    for (uint32_t i = 0; i < sheet->corner_count; i++)
        for (int j = 0; j < 3; j++) {
            double size = fabs((double)sheet->corner[i][j]);
            if (!(size < HUGE_VAL)) return OCC_ERROR_NOT_FINITE;
            if (size > (double)OCC_MAX_COORDINATE) result = OCC_ERROR_OUT_OF_RANGE;
        }
    return result;
}

// What the library should say of a box, from the header's words.
static occ_result judge(const occ_box *box)
{
    occ_result result = OCC_SUCCESS;
    for (int j = 0; j < 3; j++) {
        double reach = fabs((double)box->center[j]) + fabs((double)box->axis[0][j]) +
                       fabs((double)box->axis[1][j]) + fabs((double)box->axis[2][j]);
        if (!(reach < HUGE_VAL)) return OCC_ERROR_NOT_FINITE;
        if (reach > (double)OCC_MAX_COORDINATE) result = OCC_ERROR_OUT_OF_RANGE;
    }
    return result;
}

// --- edits ---------------------------------------------------------------------------------------

static void add_object(list *l)
{
    occ_box box = read_box(&l->from);
    occ_object handle = {0, 0};
    if (l->object_count == MOST) return;
    occ_result result = occ_scene_add(l->scene, &box, &handle);
    FUZZ_CHECK(!result == !judge(&box) && !result == (handle.index != 0));
    if (!result) l->objects[l->object_count++] = (listed_object){handle, box, true};
}

static void move_object(list *l)
{
    uint32_t i = fuzz_byte(&l->from);
    occ_box box = read_box(&l->from);
    if (i >= l->object_count) return;
    listed_object *object = &l->objects[i];
    occ_result result = occ_scene_move(l->scene, object->handle, &box);
    if (judge(&box)) {
        FUZZ_CHECK(result);
    } else {
        FUZZ_CHECK(result == (object->alive ? OCC_SUCCESS : OCC_ERROR_STALE_HANDLE));
    }
    if (!result) object->box = box;
}

static void remove_object(list *l)
{
    uint32_t i = fuzz_byte(&l->from);
    if (i >= l->object_count) return;
    occ_result result = occ_scene_remove(l->scene, l->objects[i].handle);
    FUZZ_CHECK(result == (l->objects[i].alive ? OCC_SUCCESS : OCC_ERROR_STALE_HANDLE));
    l->objects[i].alive = false;
    for (uint32_t k = 0; k < l->occluder_count; k++)
        if (l->occluders[k].owner == i) l->occluders[k].alive = false;
}

// A box or a sheet; and what the library should say of it.
static occ_result read_shape(list *l, listed_occluder *occluder)
{
    if (occluder->is_sheet) {
        occluder->sheet = read_sheet(&l->from);
        return judge_sheet(&occluder->sheet);
    }
    occluder->box = read_box(&l->from);
    return judge(&occluder->box);
}

static void add_occluder(list *l)
{
    uint32_t owner = fuzz_byte(&l->from);
    listed_occluder made = {.is_sheet = l->sheets, .alive = true};
    occ_result expected = read_shape(l, &made);
    if (l->occluder_count == MOST) return;
    made.owner = owner < l->object_count ? owner : MOST;
    occ_object of = made.owner < MOST ? l->objects[owner].handle : (occ_object){0, 0};
    if (!expected && made.owner < MOST && !l->objects[owner].alive) {
        expected = OCC_ERROR_STALE_HANDLE;
    }
    occ_result result = made.is_sheet
                            ? occ_scene_add_sheet(l->scene, &made.sheet, of, &made.handle)
                            : occ_scene_add_occluder(l->scene, &made.box, of, &made.handle);
    FUZZ_CHECK(!result == !expected);
    if (!result) l->occluders[l->occluder_count++] = made;
}

static void move_occluder(list *l)
{
    uint32_t i = fuzz_byte(&l->from);
    listed_occluder moved = {.is_sheet = l->sheets};
    occ_result expected = read_shape(l, &moved);
    if (i >= l->occluder_count) return;
    listed_occluder *occluder = &l->occluders[i];
    if (!expected && !occluder->alive) expected = OCC_ERROR_STALE_HANDLE;
    occ_result result = moved.is_sheet
                            ? occ_scene_move_sheet(l->scene, occluder->handle, &moved.sheet)
                            : occ_scene_move_occluder(l->scene, occluder->handle, &moved.box);
    FUZZ_CHECK(!result == !expected);
    if (result) return;
    occluder->is_sheet = moved.is_sheet;
    occluder->box = moved.box;
    occluder->sheet = moved.sheet;
}

static void remove_occluder(list *l)
{
    uint32_t i = fuzz_byte(&l->from);
    if (i >= l->occluder_count) return;
    occ_result result = occ_scene_remove_occluder(l->scene, l->occluders[i].handle);
    FUZZ_CHECK(result == (l->occluders[i].alive ? OCC_SUCCESS : OCC_ERROR_STALE_HANDLE));
    l->occluders[i].alive = false;
}

// --- comparisons ---------------------------------------------------------------------------------

static void check_list(const list *l)
{
    occ_box box;
    uint32_t objects = 0, occluders = 0;
    for (uint32_t i = 0; i < l->object_count; i++) {
        const listed_object *object = &l->objects[i];
        FUZZ_CHECK(occ_scene_contains(l->scene, object->handle) == object->alive);
        if (!object->alive) continue;
        FUZZ_CHECK(!occ_scene_box(l->scene, object->handle, &box));
        FUZZ_CHECK(fuzz_same_bits(&box, &object->box, sizeof box));
        objects++;
    }
    for (uint32_t i = 0; i < l->occluder_count; i++) {
        const listed_occluder *occluder = &l->occluders[i];
        occ_object owner, of = {0, 0};
        occ_sheet sheet;
        occ_result result =
            occluder->is_sheet
                ? occ_scene_occluder_sheet(l->scene, occluder->handle, &sheet, &owner)
                : occ_scene_occluder_box(l->scene, occluder->handle, &box, &owner);
        FUZZ_CHECK(result == (occluder->alive ? OCC_SUCCESS : OCC_ERROR_STALE_HANDLE));
        if (!occluder->alive) continue;
        if (occluder->owner < MOST) of = l->objects[occluder->owner].handle;
        FUZZ_CHECK(occluder->is_sheet ? fuzz_same_bits(&sheet, &occluder->sheet, sizeof sheet)
                                      : fuzz_same_bits(&box, &occluder->box, sizeof box));
        FUZZ_CHECK(owner.index == of.index && owner.generation == of.generation);
        occluders++;
    }
    occ_scene_stats stats;
    FUZZ_CHECK(!occ_scene_get_stats(l->scene, &stats));
    FUZZ_CHECK(stats.objects == objects && stats.occluders == occluders);
}

// A scene with the same objects in the same slots, and the occluders in the order of theirs.
static occ_scene *build_anew(const list *l)
{
    static const occ_box filler = {{0, 0, 0}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    occ_scene_desc desc = {.leaf_objects = 2};
    occ_scene *scene;
    uint32_t at[MOST], by_slot[MOST];
    occ_object handles[MOST];
    FUZZ_CHECK(!occ_scene_create(&desc, &scene));
    for (uint32_t s = 0; s < MOST; s++)
        at[s] = by_slot[s] = MOST;
    for (uint32_t i = 0; i < l->object_count; i++)
        if (l->objects[i].alive) at[occ_object_slot(l->objects[i].handle)] = i;
    for (uint32_t s = 0; s < occ_scene_slot_count(l->scene); s++)
        FUZZ_CHECK(
            !occ_scene_add(scene, at[s] < MOST ? &l->objects[at[s]].box : &filler, &handles[s]));
    for (uint32_t i = 0; i < l->occluder_count; i++)
        if (l->occluders[i].alive) by_slot[l->occluders[i].handle.index - 1] = i;
    for (uint32_t s = 0; s < MOST; s++) {
        if (by_slot[s] == MOST) continue;
        const listed_occluder *occluder = &l->occluders[by_slot[s]];
        occ_object owner = {0, 0};
        if (occluder->owner < MOST) {
            owner = handles[occ_object_slot(l->objects[occluder->owner].handle)];
        }
        FUZZ_CHECK(!(occluder->is_sheet
                         ? occ_scene_add_sheet(scene, &occluder->sheet, owner, NULL)
                         : occ_scene_add_occluder(scene, &occluder->box, owner, NULL)));
    }
    for (uint32_t s = 0; s < occ_scene_slot_count(l->scene); s++)
        if (at[s] == MOST) FUZZ_CHECK(!occ_scene_remove(scene, handles[s]));
    FUZZ_CHECK(!occ_scene_commit(scene));
    FUZZ_CHECK(!occ_scene_validate(scene));
    return scene;
}

static void look(occ_view *view, const occ_scene *scene, float distance, uint32_t *mask)
{
    // From `distance` down the z axis at the origin; near 0.1, no far plane.
    occ_camera_desc camera = {
        .view_projection = {1.5f, 0, 0, 0, 0, 1.5f, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0}};
    camera.view_projection[14] = distance - 0.2f;
    camera.view_projection[15] = distance;
    occ_cull_desc knobs = {.min_area = 1e-30f, .grain = 1};
    FUZZ_CHECK(!occ_cull(view, scene, &camera, &knobs));
    memset(mask, 0, WORDS * sizeof *mask);
    FUZZ_CHECK(!occ_view_read_mask(view, mask, WORDS, NULL));
}

static void commit(list *l)
{
    FUZZ_CHECK(!occ_scene_commit(l->scene));
    FUZZ_CHECK(!occ_scene_validate(l->scene));
    check_list(l);
    occ_scene *anew = build_anew(l);
    for (int i = 1; i < 100; i *= 9) {
        uint32_t edited[WORDS], fresh[WORDS];
        look(l->view, l->scene, (float)i, edited);
        look(l->view, anew, (float)i, fresh);
        FUZZ_CHECK(fuzz_same_bits(edited, fresh, sizeof edited));
    }
    occ_scene_destroy(anew);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static void (*const operations[16])(list *) = {
        add_object,    add_object,    move_object,     remove_object,
        add_occluder,  move_occluder, remove_occluder, commit, // now and then: it costs the most
        add_object,    add_object,    move_object,     move_object,
        remove_object, add_occluder,  add_occluder,    move_occluder};
    list *l = calloc(1, sizeof *l);
    occ_scene_desc desc = {.leaf_objects = 2};
    occ_view_desc plain = {.backend = OCC_BACKEND_PLAIN};
    FUZZ_CHECK(l);
    l->from = (fuzz_bytes){data, size};
    FUZZ_CHECK(!occ_scene_create(&desc, &l->scene) && !occ_view_create(&plain, &l->view));
    for (int n = 0; n < OPERATIONS && l->from.left; n++) {
        uint8_t operation = fuzz_byte(&l->from);
        l->sheets = operation >= 0x80;
        operations[operation % 16](l);
    }
    commit(l);
    occ_view_destroy(l->view);
    occ_scene_destroy(l->scene);
    free(l);
    return 0;
}
