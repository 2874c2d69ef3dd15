// SPDX-License-Identifier: Apache-2.0
// Choosing occluders: strictly front to back, by a heap over the octree of the occluders (Coorg and
// Teller, Real-Time Occlusion Culling for Models with Large Occluders, I3D 1997, choose by solid
// angle; here what is hidden by those chosen so far is passed over as well, since it could add
// nothing).
#include "frame.h"

#include "shadow.h"
#include "vector.h"

#define IS_OCCLUDER 0x80000000u

// A node or an occluder that is still to be looked at.
typedef struct select_entry {
    float key; // squared distance to the eye, or depth for an orthographic camera; no item of a
               // node has a smaller one
    uint32_t index; // of the node, or slot of the occluder
    uint32_t what;  // IS_OCCLUDER, or the frustum planes that may cut the node
} select_entry;

static void sift_up(select_entry *heap, uint32_t i)
{
    select_entry entry = heap[i];
    for (; i > 0 && heap[(i - 1) / 2].key > entry.key; i = (i - 1) / 2)
        heap[i] = heap[(i - 1) / 2];
    heap[i] = entry;
}

static select_entry pop(occ_array *array)
{
    select_entry *heap = array->data, first = heap[0], last = heap[--array->count];
    uint32_t i = 0, count = array->count;
    for (uint32_t child = 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && heap[child + 1].key < heap[child].key) child++;
        if (heap[child].key >= last.key) break;
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = last;
    return first;
}

static occ_result push(occ_frame *frame, float key, uint32_t index, uint32_t what)
{
    select_entry *entry = occ_array_push(frame->hooks, &frame->heap);
    if (!entry) return OCC_ERROR_OUT_OF_MEMORY;
    *entry = (select_entry){key, index, what};
    sift_up(frame->heap.data, frame->heap.count - 1);
    return OCC_SUCCESS;
}

// The key of an axis-aligned box: how near its nearest point is.
static float nearness(const occ_camera *camera, const float t[3], const float h[3])
{
    float sum = 0.0f;
    for (int j = 0; j < 3; j++) {
        float gap = fabsf(t[j]) - h[j];
        if (camera->orthographic) {
            float toward = (float)camera->toward[j];
            sum -= toward * t[j] + fabsf(toward) * h[j];
        } else if (gap > 0.0f) {
            sum += gap * gap;
        }
    }
    return sum;
}

static occ_relative_box relative_node(const occ_frame *frame, const occ_node *node)
{
    const occ_eye *eye = &frame->camera.constants;
    occ_relative_box box = {{0}, {0}, 0.0f};
    for (int j = 0; j < 3; j++) {
        float min = OCC_RELATIVE(node->min[j], eye->high[j], eye->low[j]);
        float max = OCC_RELATIVE(node->max[j], eye->high[j], eye->low[j]);
        box.t[j] = OCC_MIDDLE(min, max);
        box.a[4 * j] = OCC_HALF(min, max);
    }
    box.e = occ_box_slack(&box, eye->slack_floor);
    return box;
}

static bool is_hidden(const occ_frame *frame, const occ_relative_box *box)
{
    return frame->lanes->any_hides(frame->blocks.data, frame->blocks.count, box);
}

// Whether an occluder looks large enough: its projected area over its squared distance, or over the
// area of an orthographic view, reaches the knob.
static bool is_large(const occ_frame *frame, const occ_relative_box *box)
{
    const occ_camera *camera = &frame->camera;
    double c[3], a[3][3], shown = 0.0;
    for (int j = 0; j < 3; j++) {
        c[j] = camera->orthographic ? camera->toward[j] : (double)box->t[j];
        for (int k = 0; k < 3; k++)
            a[k][j] = (double)box->a[3 * k + j];
    }
    for (int k = 0; k < 3; k++) {
        double n[3];
        occ_cross(a[k], a[(k + 1) % 3], n);
        shown += 4.0 * fabs(occ_dot(n, c));
    }
    double squared = occ_dot(c, c), length = sqrt(squared);
    double least = (double)frame->knobs.min_area;
    if (camera->orthographic) return shown >= least * camera->view_area * length;
    return shown >= least * squared * length;
}

// Whether a node may hold an occluder that is_large() accepts.
static bool may_hold_large(const occ_frame *frame, uint32_t node, float key)
{
    const occ_camera *camera = &frame->camera;
    double area = camera->orthographic ? camera->view_area : (double)key * (1.0 - 1e-5);
    double reach = (double)((const float *)frame->scene->reach.data)[node];
    return reach >= (double)frame->knobs.min_area * area;
}

static occ_result push_node(occ_frame *frame, uint32_t index, uint32_t planes)
{
    const occ_node *node = occ_octree_nodes(&frame->scene->occluder_tree) + index;
    occ_relative_box box = relative_node(frame, node);
    float h[3] = {box.a[0], box.a[4], box.a[8]};
    float key = nearness(&frame->camera, box.t, h);
    if (!may_hold_large(frame, index, key)) return OCC_SUCCESS;
    return push(frame, key, index, planes);
}

static occ_result push_occluder(occ_frame *frame, uint32_t slot, uint32_t planes)
{
    const occ_eye *eye = &frame->camera.constants;
    occ_relative_box box = occ_frame_relative(frame, &occ_scene_occluder_boxes(frame->scene)[slot]);
    if (!is_large(frame, &box)) return OCC_SUCCESS;
    if (occ_box_outside(&box, eye->plane[0], planes)) return OCC_SUCCESS;
    float h[3];
    for (int j = 0; j < 3; j++)
        h[j] = fabsf(box.a[j]) + fabsf(box.a[3 + j]) + fabsf(box.a[6 + j]);
    return push(frame, nearness(&frame->camera, box.t, h), slot, IS_OCCLUDER);
}

// Pushes what a node holds, unless it is hidden as a whole.
static occ_result open_node(occ_frame *frame, const select_entry *entry)
{
    const occ_octree *tree = &frame->scene->occluder_tree;
    const occ_node *node = occ_octree_nodes(tree) + entry->index;
    occ_relative_box box = relative_node(frame, node);
    frame->stats.nodes_tested++;
    if (is_hidden(frame, &box)) return OCC_SUCCESS;
    const uint32_t *order = frame->scene->occluder_order.data;
    const occ_box *boxes = occ_scene_occluder_boxes(frame->scene);
    for (uint32_t i = 0, own = occ_node_own(tree, node); i < own; i++)
        __builtin_prefetch(&boxes[order[node->first + i]]);
    for (uint32_t i = 0, own = occ_node_own(tree, node); i < own; i++) {
        if (push_occluder(frame, order[node->first + i], entry->what)) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    if (!node->children) return OCC_SUCCESS;
    occ_siblings siblings = {.nodes = occ_octree_nodes(tree) + node->child,
                             .count = node->children,
                             .frustum = entry->what};
    frame->lanes->cut(&siblings, &frame->camera.constants);
    for (uint32_t c = 0; c < siblings.count; c++) {
        if (siblings.outside >> c & 1u) continue;
        if (push_node(frame, node->child + c, siblings.frustum_of[c])) {
            return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return OCC_SUCCESS;
}

// Appends a shadow to the blocks that any_hides() reads.
static occ_result add_to_block(occ_frame *frame, const occ_shadow *shadow, uint32_t place)
{
    uint32_t lane = place % OCC_SHADOW_LANES;
    if (!lane) {
        occ_shadow_block *fresh = occ_array_push(frame->hooks, &frame->blocks);
        if (!fresh) return OCC_ERROR_OUT_OF_MEMORY;
        *fresh = (occ_shadow_block){{{{0.0f}}}};
        for (uint32_t p = 0; p < OCC_SHADOW_PLANES; p++)
            for (uint32_t l = 0; l < OCC_SHADOW_LANES; l++)
                fresh->plane[p][3][l] = -1.0f;
    }
    occ_shadow_block *block = (occ_shadow_block *)frame->blocks.data + frame->blocks.count - 1;
    for (uint32_t p = 0; p < OCC_SHADOW_PLANES; p++) {
        const float *plane = shadow->plane[p < shadow->planes ? p : shadow->planes - 1];
        for (uint32_t j = 0; j < 4; j++)
            block->plane[p][j][lane] = plane[j];
    }
    return OCC_SUCCESS;
}

// Makes an occluder's shadow and adds it to the set, if it has one.
static occ_result accept(occ_frame *frame, uint32_t slot, bool with_block)
{
    const occ_scene *scene = frame->scene;
    uint32_t owner = scene->occluders.value[slot];
    uint32_t row = owner == OCC_NO_SLOT ? OCC_NOBODY : scene->objects.value[owner];
    occ_shadow *shadow = occ_array_extend(frame->hooks, &frame->shadows, 1);
    occ_occluder *source = occ_array_extend(frame->hooks, &frame->sources, 1);
    occ_wide_shadow *wide = occ_array_extend(frame->hooks, &frame->wide, 1);
    if (!shadow || !source || !wide) return OCC_ERROR_OUT_OF_MEMORY;
    const occ_box *box = &occ_scene_occluder_boxes(scene)[slot];
    if (!occ_shadow_init(shadow, &frame->camera, box, row)) return OCC_SUCCESS;
    *source = (occ_occluder){slot + 1, scene->occluders.generation[slot]};
    if (with_block && add_to_block(frame, shadow, frame->shadows.count)) {
        return OCC_ERROR_OUT_OF_MEMORY;
    }
    occ_wide_shadow_set(wide, shadow);
    frame->shadows.count++;
    frame->wide.count++;
    frame->sources.count++;
    return OCC_SUCCESS;
}

static occ_result visit(occ_frame *frame, const select_entry *entry)
{
    if (entry->what != IS_OCCLUDER) return open_node(frame, entry);
    frame->stats.occluders_tested++;
    const occ_box *box = &occ_scene_occluder_boxes(frame->scene)[entry->index];
    occ_relative_box relative = occ_frame_relative(frame, box);
    if (is_hidden(frame, &relative)) return OCC_SUCCESS;
    return accept(frame, entry->index, true);
}

static occ_result select_all(occ_frame *frame)
{
    const uint32_t *order = frame->scene->occluder_order.data;
    occ_result result = OCC_SUCCESS;
    for (uint32_t i = 0; i < frame->scene->occluder_order.count && !result; i++)
        result = accept(frame, order[i], false);
    frame->stats.occluders_tested = frame->scene->occluder_order.count;
    return result;
}

occ_result occ_select(occ_frame *frame)
{
    frame->heap.element = sizeof(select_entry);
    frame->heap.count = frame->blocks.count = frame->shadows.count = frame->wide.count =
        frame->sources.count = 0;
    occ_result result = OCC_SUCCESS;
    if (frame->knobs.method == OCC_METHOD_PAIRWISE) {
        result = select_all(frame);
    } else if (frame->knobs.method != OCC_METHOD_FRUSTUM && frame->scene->occluder_order.count) {
        occ_siblings root = {.nodes = occ_octree_nodes(&frame->scene->occluder_tree),
                             .count = 1,
                             .frustum = frame->camera.planes};
        frame->lanes->cut(&root, &frame->camera.constants);
        if (!root.outside) result = push_node(frame, 0, root.frustum_of[0]);
        while (!result && frame->heap.count && frame->shadows.count < frame->knobs.max_occluders) {
            select_entry entry = pop(&frame->heap);
            result = visit(frame, &entry);
        }
    }
    frame->stats.occluders_used = frame->shadows.count;
    return result;
}
