// SPDX-License-Identifier: Apache-2.0
// The walk over the objects' octree against the frozen occluders. Siblings are tested together; a
// node's candidates, those whose shadows touch it, are all that its children look at (hierarchical
// visibility: Greene, Kass and Miller, SIGGRAPH 1993). Whatever order it runs in, the answer is the
// same, since the set no longer grows.
#include "frame.h"

typedef struct walk_entry {
    uint32_t node;
    uint32_t frustum; // planes that may cut it
    uint32_t list;    // where its candidates begin in `pool`
    uint32_t count;
} walk_entry;

// Lists a run of rows as open, cut into ranges that share one candidate list.
static occ_result leave_open(occ_frame *frame, uint32_t first, uint32_t count, uint32_t planes,
                             const uint32_t *list, uint32_t listed)
{
    uint32_t begin = frame->candidates.count;
    uint32_t *copy = occ_array_extend(frame->hooks, &frame->candidates, listed);
    if (!copy) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < listed; i++)
        copy[i] = list[i];
    frame->candidates.count += listed;
    frame->stats.tested += count;
    for (uint32_t i = 0; i < count; i += OCC_RANGE_OBJECTS) {
        occ_range *range = occ_array_push(frame->hooks, &frame->ranges);
        if (!range) return OCC_ERROR_OUT_OF_MEMORY;
        uint32_t left = count - i < OCC_RANGE_OBJECTS ? count - i : OCC_RANGE_OBJECTS;
        *range = (occ_range){first + i, left,   begin,
                             listed,    planes, frame->knobs.method == OCC_METHOD_FUSED};
    }
    return OCC_SUCCESS;
}

// Keeps the candidates that touch child c. Returns how many.
static uint32_t pick(const uint32_t *list, uint32_t count, const uint8_t *touched, uint32_t c,
                     uint32_t *picked)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) {
        picked[n] = list[i];
        n += touched[i] >> c & 1u;
    }
    return n;
}

// An open child goes on the stack, or to the ranges if it is a leaf or small enough.
static occ_result pass_on(occ_frame *frame, const occ_siblings *siblings, uint32_t c,
                          const uint32_t *list, uint32_t count)
{
    const occ_node *nodes = occ_octree_nodes(&frame->scene->object_tree);
    const occ_node *child = &siblings->nodes[c];
    const uint8_t *touched = frame->touched.data;
    uint32_t *picked = occ_array_extend(frame->hooks, &frame->pool, (size_t)count + 1);
    if (!picked) return OCC_ERROR_OUT_OF_MEMORY;
    uint32_t kept = pick(list, count, touched, c, picked);
    if (!child->children || child->count <= frame->knobs.grain) {
        return leave_open(frame, child->first, child->count, siblings->frustum_of[c], picked, kept);
    }
    walk_entry *entry = occ_array_push(frame->hooks, &frame->stack);
    if (!entry) return OCC_ERROR_OUT_OF_MEMORY;
    *entry =
        (walk_entry){(uint32_t)(child - nodes), siblings->frustum_of[c], frame->pool.count, kept};
    frame->pool.count += kept;
    return OCC_SUCCESS;
}

static occ_result test_siblings(occ_frame *frame, occ_siblings *siblings, const uint32_t *list,
                                uint32_t count)
{
    const occ_eye *eye = &frame->camera.constants;
    occ_candidates candidates = {frame->shadows.data, frame->wide.data, list, count};
    frame->touched.count = 0;
    uint8_t *touched = occ_array_extend(frame->hooks, &frame->touched, (size_t)count + 1);
    if (!touched) return OCC_ERROR_OUT_OF_MEMORY;
    frame->lanes->cut(siblings, eye);
    frame->lanes->shade(siblings, eye, &candidates, touched);
    frame->stats.nodes_tested += siblings->count;
    for (uint32_t c = 0; c < siblings->count; c++) {
        if (siblings->outside >> c & 1u) {
            frame->stats.walk_outside += siblings->nodes[c].count;
        } else if (siblings->hidden >> c & 1u) {
            frame->stats.walk_hidden += siblings->nodes[c].count;
        } else if (pass_on(frame, siblings, c, list, count)) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return OCC_SUCCESS;
}

// Takes a node from the stack: its own objects are open, its children are tested.
static occ_result descend(occ_frame *frame)
{
    walk_entry entry = ((walk_entry *)frame->stack.data)[--frame->stack.count];
    const occ_octree *tree = &frame->scene->object_tree;
    const occ_node *node = occ_octree_nodes(tree) + entry.node;
    frame->inherited.count = 0;
    uint32_t *list = occ_array_extend(frame->hooks, &frame->inherited, (size_t)entry.count + 1);
    if (!list) return OCC_ERROR_OUT_OF_MEMORY;
    const uint32_t *pooled = (const uint32_t *)frame->pool.data + entry.list;
    for (uint32_t i = 0; i < entry.count; i++)
        list[i] = pooled[i];
    frame->pool.count = entry.list; // the entry on top of the stack has the last list of the pool
    uint32_t own = occ_node_own(tree, node);
    occ_result result = OCC_SUCCESS;
    if (own) result = leave_open(frame, node->first, own, entry.frustum, list, entry.count);
    if (result) return result;
    occ_siblings siblings = {.nodes = occ_octree_nodes(tree) + node->child,
                             .count = node->children,
                             .frustum = entry.frustum};
    return test_siblings(frame, &siblings, list, entry.count);
}

// The list of all shadows: 0, 1, 2, ...
static uint32_t *all_shadows(occ_frame *frame)
{
    frame->inherited.count = 0;
    uint32_t count = frame->shadows.count;
    uint32_t *list = occ_array_extend(frame->hooks, &frame->inherited, (size_t)count + 1);
    for (uint32_t i = 0; list && i < count; i++)
        list[i] = i;
    return list;
}

occ_result occ_walk(occ_frame *frame)
{
    frame->stack.element = sizeof(walk_entry);
    frame->stack.count = frame->pool.count = frame->ranges.count = frame->candidates.count = 0;
    const uint32_t *list = all_shadows(frame);
    if (!list) return OCC_ERROR_OUT_OF_MEMORY;
    occ_result result = OCC_SUCCESS;
    if (frame->knobs.method == OCC_METHOD_PAIRWISE) {
        result = leave_open(frame, 0, frame->scene->boxes.count, frame->camera.planes, list,
                            frame->shadows.count);
    } else if (frame->scene->boxes.count) {
        occ_siblings root = {.nodes = occ_octree_nodes(&frame->scene->object_tree),
                             .count = 1,
                             .frustum = frame->camera.planes};
        result = test_siblings(frame, &root, list, frame->shadows.count);
        while (!result && frame->stack.count)
            result = descend(frame);
    }
    frame->stats.ranges = frame->ranges.count;
    return result;
}
