// SPDX-License-Identifier: Apache-2.0
// Why an object is not visible. A frame keeps nothing for this: what hid the object is found by
// proving it once more, from the frozen occluders, and noting which of them the proof takes.
#include "view_data.h"

#include "box.h"
#include "fusion.h"
#include "log.h"

#include <string.h>

// A box that is hidden, or so it is claimed: the object's, or that of a node with which it fell.
typedef struct box_claim {
    occ_relative_box box;
    uint32_t frustum;     // planes that may cut it
    uint32_t first, rows; // what these rows own does not hide it together with others
    bool node;            // by its outline alone, as the walk did
} box_claim;

#define MOST_CULPRITS 1024u // a proof that takes more is given up

// Shadows, by their places among the frame's.
typedef struct culprits {
    uint32_t place[MOST_CULPRITS];
    uint32_t count;
} culprits;

// A proof on its way: what is left of the box, and what was taken from it.
typedef struct box_proof {
    const occ_frame *frame;
    const box_claim *claim;
    const uint32_t *list; // which shadows, in which order; NULL: all, nearest first
    uint32_t count;
    bool by_faces;
    occ_fusion fusion;
    culprits used;
} box_proof;

static const occ_shadow *shadow_at(const occ_frame *frame, uint32_t place)
{
    return (const occ_shadow *)frame->shadows.data + place;
}

// --- proofs --------------------------------------------------------------------------------------

// The nearest that hides the box alone.
static bool find_single(const occ_frame *frame, const box_claim *claim, uint32_t row,
                        culprits *found)
{
    for (uint32_t i = 0; i < frame->shadows.count; i++) {
        const occ_shadow *shadow = shadow_at(frame, i);
        if (shadow->owner == row) continue;
        if (!occ_box_in_shadow(&claim->box, shadow->plane[0], shadow->planes)) continue;
        found->place[0] = i;
        found->count = 1;
        return true;
    }
    return false;
}

// Puts a place among the others, in order. False if there is no room.
static bool note(culprits *used, uint32_t place)
{
    uint32_t k = used->count;
    while (k && used->place[k - 1] >= place)
        k--;
    if (k < used->count && used->place[k] == place) return true;
    if (used->count == MOST_CULPRITS) return false;
    memmove(&used->place[k + 1], &used->place[k], (used->count - k) * sizeof *used->place);
    used->place[k] = place;
    used->count++;
    return true;
}

// Takes from the piece on top of the stack the first shadow that serves. False if there is none, or
// it cannot be done.
static bool take_first(box_proof *proof)
{
    const box_claim *claim = proof->claim;
    occ_fusion *fusion = &proof->fusion;
    const occ_piece *top = &fusion->stack[fusion->depth - 1];
    float object = claim->box.e;
    occ_vertex middle;
    occ_piece_middle(top, &middle);
    for (uint32_t i = 0; i < proof->count; i++) {
        uint32_t place = proof->list ? proof->list[i] : i;
        const occ_shadow *shadow = shadow_at(proof->frame, place);
        if (shadow->owner - claim->first < claim->rows) continue;
        if (!occ_shadow_holds(shadow, &middle, top->cuts, object)) continue;
        if (!occ_fusion_accepts(fusion, &claim->box, shadow, proof->by_faces)) continue;
        return note(&proof->used, place) && occ_fusion_subtract(fusion, shadow, object);
    }
    return false;
}

// As occ_fusion_covers(), with however many candidates: the order in which shadows are taken is
// that of the verdict, so that what it could prove is proved here.
static bool covers(box_proof *proof, bool by_faces)
{
    const occ_eye *eye = &proof->frame->camera.constants;
    const occ_relative_box *box = &proof->claim->box;
    occ_fusion *fusion = &proof->fusion;
    occ_outline outline;
    proof->by_faces = by_faces;
    proof->used.count = 0;
    if (!occ_outline_set(&outline, box, eye, by_faces)) return false;
    fusion->depth = occ_outline_pieces(&outline, box, fusion->stack);
    if (!fusion->depth) return false;
    occ_fusion_clip(fusion, eye, proof->claim->frustum, box->e);
    for (uint32_t split = 0; fusion->depth; split++)
        if (split == eye->splits || !take_first(proof)) return false;
    return true;
}

// Whether shadows hide the box together, and which of them it takes: none if the box is outside of
// the frustum, beyond a corner of it.
static bool prove(const occ_frame *frame, const box_claim *claim, const uint32_t *list,
                  uint32_t count, culprits *found)
{
    box_proof proof = {.frame = frame, .claim = claim, .list = list, .count = count};
    if (!covers(&proof, false) && (claim->node || !covers(&proof, true))) return false;
    *found = proof.used;
    return true;
}

// Drops what the others can do without, the farthest first.
static void shrink(const occ_frame *frame, const box_claim *claim, culprits *found)
{
    for (uint32_t i = found->count; i-- > 0 && found->count > 1;) {
        culprits fewer = *found, used;
        fewer.count--;
        memmove(&fewer.place[i], &fewer.place[i + 1], (fewer.count - i) * sizeof *fewer.place);
        if (!prove(frame, claim, fewer.place, fewer.count, &used)) continue;
        *found = used;
        if (i > found->count) i = found->count;
    }
}

// --- the object and the nodes around it ----------------------------------------------------------

// The nodes that hold a row, from the root on, and the planes that may cut each.
typedef struct node_path {
    uint32_t node[OCC_TREE_DEPTH + 1], frustum[OCC_TREE_DEPTH + 1];
    uint32_t count;
    bool outside; // the last one is outside of the frustum
} node_path;

// The child that holds a row, or 0: the node holds it itself.
static uint32_t child_with(const occ_octree *tree, const occ_node *node, uint32_t row)
{
    const occ_node *nodes = occ_octree_nodes(tree);
    for (uint32_t c = node->child; c < node->child + node->children; c++)
        if (row - nodes[c].first < nodes[c].count) return c;
    return 0;
}

static void find_path(const occ_frame *frame, const occ_octree *tree, uint32_t row, node_path *path)
{
    uint32_t index = 0, planes = frame->camera.planes;
    path->count = 0;
    path->outside = false;
    do {
        const occ_node *node = occ_octree_nodes(tree) + index;
        occ_siblings alone = {.nodes = node, .count = 1, .frustum = planes};
        frame->lanes->cut(&alone, &frame->camera.constants);
        planes = alone.frustum_of[0];
        path->outside = alone.outside != 0;
        path->node[path->count] = index;
        path->frustum[path->count++] = planes;
        index = child_with(tree, node, row);
    } while (index && !path->outside);
}

// The range in which a row was handed to the test, or NULL: it fell in the walk.
static const occ_range *range_with(const occ_frame *frame, uint32_t row)
{
    const occ_range *ranges = frame->ranges.data;
    for (uint32_t i = 0; i < frame->ranges.count; i++)
        if (row - ranges[i].first < ranges[i].count) return &ranges[i];
    return NULL;
}

// What hides a box, if it is hidden: one occluder, or several together, of the range's candidates
// if there is a range.
static bool explain_box(const occ_frame *frame, const box_claim *claim, uint32_t row,
                        const occ_range *range, culprits *found)
{
    const uint32_t *list = NULL;
    uint32_t count = frame->shadows.count;
    if (find_single(frame, claim, row, found)) return true;
    if (frame->knobs.method != OCC_METHOD_FUSED) return false;
    if (range) {
        list = (const uint32_t *)frame->candidates.data + range->candidates;
        count = range->candidate_count;
    }
    if (!prove(frame, claim, list, count, found)) return false;
    shrink(frame, claim, found);
    return true;
}

// The nodes of the path, nearest to the object first. One of them fell.
static bool explain_nodes(const occ_frame *frame, const occ_octree *tree, const node_path *path,
                          uint32_t row, culprits *found)
{
    for (uint32_t i = path->count; i-- > 0;) {
        const occ_node *node = occ_octree_nodes(tree) + path->node[i];
        box_claim claim = {.box = occ_frame_relative_node(frame, node),
                           .frustum = path->frustum[i],
                           .first = node->first,
                           .rows = node->count,
                           .node = true};
        if (explain_box(frame, &claim, row, NULL, found)) return true;
    }
    return false;
}

// The fate of an object that the mask does not show.
static occ_result explain_row(const occ_view *view, const occ_scene *scene, uint32_t row,
                              occ_fate *fate, culprits *found)
{
    const occ_frame *frame = &view->frame;
    const occ_box box = occ_boxes_get(&scene->boxes, row);
    node_path path;
    find_path(frame, &scene->object_tree, row, &path);
    box_claim claim = {.box = occ_frame_relative(frame, &box),
                       .frustum = path.frustum[path.count - 1],
                       .first = row,
                       .rows = 1};
    const float *plane = frame->camera.constants.plane[0];
    *fate = OCC_FATE_OUTSIDE;
    if (path.outside || occ_box_outside(&claim.box, plane, claim.frustum)) return OCC_SUCCESS;
    if (!explain_box(frame, &claim, row, range_with(frame, row), found) &&
        !explain_nodes(frame, &scene->object_tree, &path, row, found)) {
        return occ_fail(&view->hooks, OCC_ERROR_CORRUPT, "row %u is hidden by nothing", row);
    }
    if (found->count) *fate = OCC_FATE_HIDDEN;
    return OCC_SUCCESS;
}

// --- the call ------------------------------------------------------------------------------------

// Whether the scene is the one that was culled, as it was.
static occ_result check_scene(const occ_view *view, const occ_scene *scene, occ_object object)
{
    if (!scene) return occ_fail(&view->hooks, OCC_ERROR_INVALID_ARGUMENT, "the scene is NULL");
    if (scene->id != view->scene_id) {
        return occ_fail(&view->hooks, OCC_ERROR_INVALID_ARGUMENT, "another scene was culled");
    }
    if (!occ_scene_is_committed(scene)) {
        return occ_fail(&view->hooks, OCC_ERROR_NOT_COMMITTED, "the scene has changed since");
    }
    if (scene->revision != view->revision) {
        return occ_fail(&view->hooks, OCC_ERROR_NO_RESULT,
                        "the scene has changed since it was culled");
    }
    if (occ_scene_contains(scene, object)) return OCC_SUCCESS;
    return occ_fail(&view->hooks, OCC_ERROR_STALE_HANDLE, "object {%u, %u}", object.index,
                    object.generation);
}

occ_result occ_view_explain(const occ_view *view, const occ_scene *scene, occ_object object,
                            occ_fate *fate, occ_occluder *occluders, size_t capacity, size_t *count)
{
    culprits found = {.count = 0};
    occ_fate known = OCC_FATE_VISIBLE;
    if (fate) *fate = known;
    occ_result result = occ_view_check(view, count);
    if (!result) result = check_scene(view, scene, object);
    if (!result && !occ_view_is_visible(view, object)) {
        uint32_t row = scene->objects.value[occ_object_slot(object)];
        result = explain_row(view, scene, row, &known, &found);
    }
    if (result) return result;
    if (fate) *fate = known;
    result = occ_view_fits(view, occluders, capacity, found.count, count);
    const occ_occluder *sources = view->frame.sources.data;
    for (uint32_t i = 0; i < found.count && !result; i++)
        occluders[i] = sources[found.place[i]];
    return result;
}
