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

// Shadows, by their places among the frame's, nearest first.
typedef struct culprits {
    uint32_t place[OCC_FUSION_CANDIDATES];
    uint32_t count;
} culprits;

_Static_assert(OCC_FUSION_CANDIDATES <= 64, "a word says which candidates were used");

static const occ_shadow *shadows_of(const occ_frame *frame)
{
    return frame->shadows.data;
}

// --- proofs --------------------------------------------------------------------------------------

// The nearest that hides the box alone.
static bool find_single(const occ_frame *frame, const box_claim *claim, uint32_t row,
                        culprits *found)
{
    const occ_shadow *shadow = shadows_of(frame);
    for (uint32_t i = 0; i < frame->shadows.count; i++, shadow++) {
        if (shadow->owner == row) continue;
        if (!occ_box_in_shadow(&claim->box, shadow->plane[0], shadow->planes)) continue;
        found->place[0] = i;
        found->count = 1;
        return true;
    }
    return false;
}

static void begin_fusion(occ_fusion *fusion)
{
    fusion->depth = fusion->candidates = fusion->faces = 0;
    fusion->held = 0;
}

// Lists those of `list` that touch the box. None hides it alone.
static void add_candidates(occ_fusion *fusion, const occ_frame *frame, const box_claim *claim,
                           const uint32_t *list, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const occ_shadow *shadow = shadows_of(frame) + list[i];
        uint32_t before = fusion->candidates;
        if (shadow->owner - claim->first < claim->rows) continue;
        (void)occ_fusion_consider(fusion, &claim->box, shadow, list[i]);
        if (!claim->node || fusion->candidates == before) continue;
        if (fusion->planes[before] >> occ_shadow_silhouettes(shadow)) fusion->candidates = before;
    }
}

// Lists all that touch the box, in the order and with the choice of the walk.
static void add_all_near(occ_fusion *fusion, const occ_frame *frame, const box_claim *claim)
{
    occ_shadow_set all = occ_occluders_so_far(frame);
    occ_projection seen;
    frame->lanes->project(&frame->camera.screen, &claim->box, &seen);
    occ_question question = {.box = &claim->box,
                             .seen = &seen,
                             .first = claim->first,
                             .rows = claim->rows,
                             .key = INFINITY,
                             .upright = claim->node};
    for (uint32_t i = 0; i < all.count; i += OCC_SHADOW_LANES) {
        uint32_t list[OCC_SHADOW_LANES], count = 0, left = all.count - i;
        occ_shadow_set block = {all.shadows + i, all.wide + i, all.rects + i / OCC_SHADOW_LANES,
                                left < OCC_SHADOW_LANES ? left : OCC_SHADOW_LANES};
        if (frame->lanes->gather(&question, &block, list, &count)) continue;
        for (uint32_t k = 0; k < count; k++)
            list[k] += i;
        add_candidates(fusion, frame, claim, list, count);
    }
}

// As occ_fusion_covers(); notes in `used` which candidates were subtracted.
static bool covers(occ_fusion *fusion, const occ_frame *frame, const box_claim *claim,
                   bool by_faces, uint64_t *used)
{
    const occ_eye *eye = &frame->camera.constants;
    const occ_shadow *shadows = shadows_of(frame);
    occ_outline outline;
    *used = 0;
    if (!occ_outline_set(&outline, &claim->box, eye, by_faces)) return false;
    fusion->depth = occ_outline_pieces(&outline, &claim->box, fusion->stack);
    if (!fusion->depth) return false;
    occ_fusion_clip(fusion, eye, claim->frustum);
    for (uint32_t split = 0; fusion->depth; split++) {
        uint32_t i = occ_fusion_find(fusion, shadows, by_faces);
        if (i == fusion->candidates || split == eye->splits ||
            !occ_fusion_subtract(fusion, &shadows[fusion->candidate[i]], fusion->planes[i])) {
            return false;
        }
        *used |= UINT64_C(1) << i;
    }
    return true;
}

// Whether the candidates hide the box together, and which of them it takes: none if the box is
// outside of the frustum, beyond a corner of it.
static bool prove(occ_fusion *fusion, const occ_frame *frame, const box_claim *claim,
                  culprits *found)
{
    uint64_t used;
    if (!fusion->candidates) return false;
    if (!covers(fusion, frame, claim, false, &used) &&
        (claim->node || !fusion->faces || !covers(fusion, frame, claim, true, &used))) {
        return false;
    }
    found->count = 0;
    for (; used; used &= used - 1)
        found->place[found->count++] = fusion->candidate[__builtin_ctzll(used)];
    return true;
}

// Drops what the others can do without, the farthest first.
static void shrink(const occ_frame *frame, const box_claim *claim, culprits *found)
{
    for (uint32_t i = found->count; i-- > 0 && found->count > 1;) {
        occ_fusion fusion;
        culprits fewer;
        begin_fusion(&fusion);
        add_candidates(&fusion, frame, claim, found->place, i);
        add_candidates(&fusion, frame, claim, found->place + i + 1, found->count - i - 1);
        if (!prove(&fusion, frame, claim, &fewer)) continue;
        *found = fewer;
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

// What hides a box, if it is hidden: one occluder, or several together.
static bool explain_box(const occ_frame *frame, const box_claim *claim, uint32_t row,
                        const occ_range *range, culprits *found)
{
    occ_fusion fusion;
    if (find_single(frame, claim, row, found)) return true;
    if (frame->knobs.method != OCC_METHOD_FUSED) return false;
    begin_fusion(&fusion);
    if (range) {
        const uint32_t *list = (const uint32_t *)frame->candidates.data + range->candidates;
        add_candidates(&fusion, frame, claim, list, range->candidate_count);
    } else {
        add_all_near(&fusion, frame, claim);
    }
    if (!prove(&fusion, frame, claim, found)) return false;
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
    const occ_range *range = range_with(frame, row);
    const occ_box box = occ_boxes_get(&scene->boxes, row);
    node_path path;
    find_path(frame, &scene->object_tree, row, &path);
    uint32_t planes = range ? range->frustum : path.frustum[path.count - 1];
    box_claim claim = {
        .box = occ_frame_relative(frame, &box), .frustum = planes, .first = row, .rows = 1};
    const float *plane = frame->camera.constants.plane[0];
    *fate = OCC_FATE_OUTSIDE;
    if (occ_box_outside(&claim.box, plane, planes) || (!range && path.outside)) return OCC_SUCCESS;
    if (!explain_box(frame, &claim, row, range, found) &&
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
