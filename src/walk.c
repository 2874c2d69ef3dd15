// SPDX-License-Identifier: Apache-2.0
// The walk: front to back over the octrees (hierarchical visibility: Greene, Kass and Miller,
// SIGGRAPH 1993; occluders by solid angle: Coorg and Teller, I3D 1997). What the occluders found so
// far hide falls, with all that is in it; what they do not is opened, and its occluders join them,
// nearest first. The shadows that touch a node are all that is asked about what is in it.
#include "frame.h"

// Objects of a node that stay open.
typedef struct open_range {
    uint32_t first, count;
    uint32_t node;
    uint32_t planes;
} open_range;

static float nearness_of_node(const occ_frame *frame, const occ_relative_box *box)
{
    float h[3] = {box->a[0], box->a[4], box->a[8]};
    return occ_frame_nearness(frame, box->t, h);
}

static bool is_fused(const occ_frame *frame)
{
    return frame->knobs.method == OCC_METHOD_FUSED;
}

// Where a box is on the screen.
static occ_projection project(const occ_frame *frame, const occ_relative_box *box)
{
    occ_projection seen;
    frame->lanes->project(&frame->camera.screen, box, &seen);
    return seen;
}

// Whether the occluders so far hide a node; those that its objects [first, first + rows) own do
// not.
static bool is_hidden(occ_frame *frame, const occ_relative_box *box, uint32_t planes,
                      uint32_t first, uint32_t rows)
{
    occ_projection seen;
    occ_question question = {.box = box,
                             .seen = &seen,
                             .frustum = planes,
                             .first = first,
                             .rows = rows,
                             .key = INFINITY,
                             .fuse = is_fused(frame),
                             .upright = true,
                             .hint = &frame->hint};
    occ_shadow_set set = occ_occluders_so_far(frame);
    return set.count &&
           frame->lanes->hide(&question, &set, &frame->camera.constants, &frame->camera.screen);
}

// Whether an occluder that came after the first `asked` hides an occluder, or a node of them.
// (Alone: what several hide together is rare there, and costs less than to find that out.)
static bool is_hidden_alone(const occ_frame *frame, const occ_relative_box *box, bool upright,
                            uint32_t asked)
{
    occ_projection seen;
    occ_question question = {
        .box = box, .seen = &seen, .asked = asked, .key = INFINITY, .upright = upright};
    occ_shadow_set set = occ_occluders_so_far(frame);
    return set.count > asked &&
           frame->lanes->hide(&question, &set, &frame->camera.constants, &frame->camera.screen);
}

// --- what stays open -----------------------------------------------------------------------------

static occ_result leave_open(occ_frame *frame, const occ_walk_entry *entry, uint32_t first,
                             uint32_t count)
{
    open_range *range = occ_array_push(frame->hooks, &frame->open);
    if (!range) return OCC_ERROR_OUT_OF_MEMORY;
    *range = (open_range){first, count, entry->index, entry->what & OCC_WALK_PLANES};
    const occ_node *node = occ_octree_nodes(&frame->scene->object_tree) + entry->index;
    occ_relative_box box = occ_frame_relative_node(frame, node);
    float h[3] = {box.a[0], box.a[4], box.a[8]};
    float farness = occ_frame_farness(frame, box.t, h);
    return occ_queue_push(frame->hooks, &frame->closing,
                          (occ_walk_entry){.key = farness, .index = frame->open.count - 1});
}

// Cuts a run of rows into ranges that share the candidates from `begin` on.
static occ_result add_ranges(occ_frame *frame, const open_range *open, uint32_t begin)
{
    uint32_t listed = frame->candidates.count - begin;
    frame->stats.tested += open->count;
    for (uint32_t i = 0; i < open->count; i += OCC_RANGE_OBJECTS) {
        occ_range *range = occ_frame_extend(frame, &frame->ranges, 1);
        if (!range || !occ_frame_extend(frame, &frame->verdicts, 1)) return OCC_ERROR_OUT_OF_MEMORY;
        frame->ranges.count++;
        frame->verdicts.count++;
        uint32_t left = open->count - i < OCC_RANGE_OBJECTS ? open->count - i : OCC_RANGE_OBJECTS;
        *range = (occ_range){open->first + i, left, begin, listed, open->planes, is_fused(frame)};
    }
    occ_team_offer(frame->team, frame->ranges.count);
    return OCC_SUCCESS;
}

// Lists the candidates of a range: the occluders that are near enough and touch it.
static occ_result close_range(occ_frame *frame, float key, const open_range *open)
{
    const occ_node *node = occ_octree_nodes(&frame->scene->object_tree) + open->node;
    occ_relative_box box = occ_frame_relative_node(frame, node);
    occ_projection seen = project(frame, &box);
    occ_shadow_set set = occ_occluders_so_far(frame);
    uint32_t *list = occ_frame_extend(frame, &frame->candidates, (size_t)set.count + 1);
    if (!list) return OCC_ERROR_OUT_OF_MEMORY;
    occ_question question = {.box = &box,
                             .seen = &seen,
                             .first = open->first,
                             .rows = open->count,
                             .key = key,
                             .upright = true};
    uint32_t begin = frame->candidates.count, count;
    if (frame->lanes->gather(&question, &set, list, &count)) {
        frame->stats.walk_hidden += open->count;
        return OCC_SUCCESS;
    }
    occ_occluders_sort(&set, list, count);
    frame->candidates.count += count;
    return add_ranges(frame, open, begin);
}

static occ_result close_first(occ_frame *frame)
{
    occ_walk_entry next = occ_queue_pop(&frame->closing);
    return close_range(frame, next.key, (const open_range *)frame->open.data + next.index);
}

// Closes the ranges that are wholly nearer than what is still to be looked at: no occluder that is
// found from here on can hide any of them.
static occ_result close_nearer(occ_frame *frame)
{
    occ_result result = OCC_SUCCESS;
    while (!result && frame->closing.count &&
           occ_queue_bucket_of_first(&frame->closing) < occ_queue_bucket_of_first(&frame->queue))
        result = close_first(frame);
    return result;
}

// --- occluders -----------------------------------------------------------------------------------

// Pushes the occluders in rows [first, first + count) that are large enough and not hidden yet.
static occ_result push_occluders(occ_frame *frame, uint32_t planes, uint32_t first, uint32_t count)
{
    const occ_box *boxes = occ_scene_occluder_boxes(frame->scene);
    const occ_selection *choice = &frame->selection;
    occ_shadow_set set = occ_occluders_so_far(frame);
    uint32_t asked = set.count < OCC_WALK_ASKED ? set.count : OCC_WALK_ASKED;
    for (uint32_t i = 0; i < count; i += OCC_SHADOW_LANES) {
        float key[OCC_SHADOW_LANES];
        uint32_t left = count - i < OCC_SHADOW_LANES ? count - i : OCC_SHADOW_LANES;
        uint32_t chosen = frame->lanes->select(boxes + first + i, left, choice, planes, &set, key);
        for (; chosen; chosen &= chosen - 1u) {
            uint32_t l = (uint32_t)__builtin_ctz(chosen);
            const occ_sheet *sheet = occ_scene_sheet(frame->scene, first + i + l);
            if (sheet && !occ_occluder_sheet_is_large(frame, sheet)) continue;
            occ_walk_entry entry = {
                .key = key[l], .index = first + i + l, .what = OCC_WALK_OCCLUDER | asked};
            if (occ_queue_push(frame->hooks, &frame->queue, entry)) return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return OCC_SUCCESS;
}

static occ_result visit_occluder(occ_frame *frame, const occ_walk_entry *entry)
{
    if (frame->shadows.count >= frame->knobs.max_occluders) return OCC_SUCCESS;
    frame->stats.occluders_tested++;
    const occ_box *boxes = occ_scene_occluder_boxes(frame->scene);
    occ_relative_box box = occ_frame_relative(frame, &boxes[entry->index]);
    if (is_hidden_alone(frame, &box, false, entry->what & OCC_WALK_ASKED)) return OCC_SUCCESS;
    occ_projection seen = project(frame, &box);
    return occ_occluders_add(frame, entry->index, entry->key, &seen);
}

// --- nodes ---------------------------------------------------------------------------------------

static occ_result push_child(occ_frame *frame, const occ_siblings *siblings, uint32_t c)
{
    const occ_node *nodes = occ_octree_nodes(&frame->scene->object_tree);
    const occ_node *child = &siblings->nodes[c];
    occ_relative_box box = occ_frame_relative_node(frame, child);
    occ_walk_entry entry = {.key = nearness_of_node(frame, &box),
                            .index = (uint32_t)(child - nodes),
                            .what = OCC_WALK_NODE | siblings->frustum_of[c]};
    return occ_queue_push(frame->hooks, &frame->queue, entry);
}

static occ_result open_children(occ_frame *frame, const occ_walk_entry *entry)
{
    const occ_octree *tree = &frame->scene->object_tree;
    const occ_node *node = occ_octree_nodes(tree) + entry->index;
    occ_siblings siblings = {.nodes = occ_octree_nodes(tree) + node->child,
                             .count = node->children,
                             .frustum = entry->what & OCC_WALK_PLANES};
    frame->lanes->cut(&siblings, &frame->camera.constants);
    frame->stats.nodes_tested += siblings.count;
    for (uint32_t c = 0; c < siblings.count; c++) {
        if (siblings.outside >> c & 1u) {
            frame->stats.walk_outside += siblings.nodes[c].count;
        } else if (push_child(frame, &siblings, c)) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return OCC_SUCCESS;
}

// The rows of a node that are tested as they are: its own, or all if it is small enough.
static occ_result open_node(occ_frame *frame, const occ_walk_entry *entry)
{
    const occ_octree *tree = &frame->scene->object_tree;
    const occ_node *nodes = occ_octree_nodes(tree), *node = &nodes[entry->index];
    bool whole = !node->children || node->count <= frame->knobs.grain;
    uint32_t rows = whole ? node->count : occ_node_own(tree, node);
    if (rows && leave_open(frame, entry, node->first, rows)) return OCC_ERROR_OUT_OF_MEMORY;
    if (rows && frame->scene->attached.count && frame->knobs.method != OCC_METHOD_FRUSTUM) {
        const occ_attached *attached = frame->scene->attached.data;
        uint32_t first = attached[entry->index].first, count = attached[entry->index].count;
        if (!whole) count = attached[node->child].first - first;
        if (count && occ_occluder_may_be_large(frame, attached[entry->index].reach, entry->key) &&
            push_occluders(frame, entry->what & OCC_WALK_PLANES, first, count)) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return whole ? OCC_SUCCESS : open_children(frame, entry);
}

static occ_result visit_node(occ_frame *frame, const occ_walk_entry *entry)
{
    const occ_node *node = occ_octree_nodes(&frame->scene->object_tree) + entry->index;
    occ_relative_box box = occ_frame_relative_node(frame, node);
    uint32_t planes = entry->what & OCC_WALK_PLANES;
    if (is_hidden(frame, &box, planes, node->first, node->count)) {
        frame->stats.walk_hidden += node->count;
        return OCC_SUCCESS;
    }
    return open_node(frame, entry);
}

static occ_result push_free(occ_frame *frame, uint32_t index, uint32_t planes)
{
    const occ_node *node = occ_octree_nodes(&frame->scene->occluder_tree) + index;
    occ_relative_box box = occ_frame_relative_node(frame, node);
    occ_walk_entry entry = {
        .key = nearness_of_node(frame, &box), .index = index, .what = OCC_WALK_FREE | planes};
    float reach = ((const float *)frame->scene->reach.data)[index];
    if (!occ_occluder_may_be_large(frame, reach, entry.key)) return OCC_SUCCESS;
    return occ_queue_push(frame->hooks, &frame->queue, entry);
}

// A node of the occluders that nobody owns.
static occ_result visit_free(occ_frame *frame, const occ_walk_entry *entry)
{
    const occ_octree *tree = &frame->scene->occluder_tree;
    const occ_node *node = occ_octree_nodes(tree) + entry->index;
    occ_relative_box box = occ_frame_relative_node(frame, node);
    uint32_t planes = entry->what & OCC_WALK_PLANES;
    frame->stats.nodes_tested++;
    if (is_hidden_alone(frame, &box, true, 0)) return OCC_SUCCESS;
    uint32_t first = frame->scene->attached_count + node->first;
    if (push_occluders(frame, planes, first, occ_node_own(tree, node))) {
        return OCC_ERROR_OUT_OF_MEMORY;
    }
    if (!node->children) return OCC_SUCCESS;
    occ_siblings siblings = {
        .nodes = occ_octree_nodes(tree) + node->child, .count = node->children, .frustum = planes};
    frame->lanes->cut(&siblings, &frame->camera.constants);
    for (uint32_t c = 0; c < siblings.count; c++) {
        if (siblings.outside >> c & 1u) continue;
        if (push_free(frame, node->child + c, siblings.frustum_of[c])) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return OCC_SUCCESS;
}

// --- the walk ------------------------------------------------------------------------------------

// Readies the queues for keys as they are in both trees.
static void start_queues(occ_frame *frame)
{
    const occ_octree *trees[2] = {&frame->scene->object_tree, &frame->scene->occluder_tree};
    float nearest = INFINITY, farthest = -INFINITY;
    for (int i = 0; i < 2; i++) {
        if (!trees[i]->nodes.count) continue;
        occ_relative_box box = occ_frame_relative_node(frame, occ_octree_nodes(trees[i]));
        float h[3] = {box.a[0], box.a[4], box.a[8]};
        nearest = fminf(nearest, occ_frame_nearness(frame, box.t, h));
        farthest = fmaxf(farthest, occ_frame_farness(frame, box.t, h));
    }
    occ_queue_start(&frame->queue, nearest, farthest);
    occ_queue_start(&frame->closing, nearest, farthest);
}

static occ_result push_roots(occ_frame *frame)
{
    const occ_camera *camera = &frame->camera;
    if (frame->knobs.method != OCC_METHOD_FRUSTUM && frame->scene->occluder_tree.nodes.count) {
        occ_siblings root = {.nodes = occ_octree_nodes(&frame->scene->occluder_tree),
                             .count = 1,
                             .frustum = camera->planes};
        frame->lanes->cut(&root, &camera->constants);
        if (!root.outside && push_free(frame, 0, root.frustum_of[0])) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    if (!frame->scene->boxes.count) return OCC_SUCCESS;
    occ_siblings root = {.nodes = occ_octree_nodes(&frame->scene->object_tree),
                         .count = 1,
                         .frustum = camera->planes};
    frame->lanes->cut(&root, &camera->constants);
    frame->stats.nodes_tested++;
    if (root.outside) {
        frame->stats.walk_outside += root.nodes->count;
        return OCC_SUCCESS;
    }
    occ_walk_entry entry = {.what = OCC_WALK_NODE | root.frustum_of[0]};
    return occ_queue_push(frame->hooks, &frame->queue, entry);
}

static occ_result visit(occ_frame *frame, const occ_walk_entry *entry)
{
    if (entry->what & OCC_WALK_OCCLUDER) return visit_occluder(frame, entry);
    return entry->what & OCC_WALK_FREE ? visit_free(frame, entry) : visit_node(frame, entry);
}

// Every occluder, and every object open.
static occ_result take_all(occ_frame *frame)
{
    uint32_t count = frame->scene->occluder_rows.count;
    const occ_projection anywhere = {.min = {-INFINITY, -INFINITY}, .max = {INFINITY, INFINITY}};
    for (uint32_t i = 0; i < count; i++)
        if (occ_occluders_add(frame, i, 0.0f, &anywhere)) return OCC_ERROR_OUT_OF_MEMORY;
    frame->stats.occluders_tested = count;
    uint32_t *list = occ_frame_extend(frame, &frame->candidates, (size_t)frame->shadows.count + 1);
    if (!list) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < frame->shadows.count; i++)
        list[i] = i;
    frame->candidates.count = frame->shadows.count;
    open_range all = {.count = frame->scene->boxes.count, .planes = frame->camera.planes};
    return add_ranges(frame, &all, 0);
}

occ_result occ_walk(occ_frame *frame)
{
    frame->open.element = sizeof(open_range);
    frame->open.count = 0;
    frame->ranges.count = frame->verdicts.count = frame->candidates.count = 0;
    occ_occluders_clear(frame);
    occ_result result = OCC_SUCCESS;
    if (frame->knobs.method == OCC_METHOD_PAIRWISE) {
        result = take_all(frame);
    } else {
        start_queues(frame);
        occ_occluders_prepare(frame);
        result = push_roots(frame);
        while (!result && frame->queue.count) {
            result = close_nearer(frame);
            occ_walk_entry entry = occ_queue_pop(&frame->queue);
            if (!result) result = visit(frame, &entry);
        }
        while (!result && frame->closing.count)
            result = close_first(frame);
    }
    frame->stats.occluders_used = frame->shadows.count;
    frame->stats.ranges = frame->ranges.count;
    return result;
}
