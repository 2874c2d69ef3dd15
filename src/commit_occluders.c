// SPDX-License-Identifier: Apache-2.0
// Bringing the occluders up to date. Those that an object owns are attached to its node of the
// objects' tree: whoever finds the object visible finds them. The others have a tree of their own.
#include "scene_data.h"

#include "bounds.h"

#include <math.h>
#include <string.h>

typedef struct reach_job {
    const occ_scene *scene;
    uint32_t parts;
} reach_job;

// The largest reach among the occluders in rows [first, end).
static float largest_reach(const occ_scene *scene, uint32_t first, uint32_t end)
{
    const occ_box *boxes = occ_scene_occluder_boxes(scene);
    float most = 0.0f, found[OCC_BLOCK];
    for (uint32_t i = first; i < end; i += OCC_BLOCK) {
        uint32_t count = end - i < OCC_BLOCK ? end - i : OCC_BLOCK;
        occ_reaches_of_array(boxes + i, count, found);
        for (uint32_t k = 0; k < count; k++)
            most = found[k] > most ? found[k] : most;
    }
    return most;
}

// The largest reach among each node's own occluders.
static void reach_of_free(void *context, uint32_t part)
{
    const reach_job *job = context;
    const occ_octree *tree = &job->scene->occluder_tree;
    float *reach = job->scene->reach.data;
    uint32_t last = occ_part_first(tree->nodes.count, job->parts, part + 1);
    for (uint32_t n = occ_part_first(tree->nodes.count, job->parts, part); n < last; n++) {
        const occ_node *node = &occ_octree_nodes(tree)[n];
        uint32_t first = job->scene->attached_count + node->first;
        reach[n] = largest_reach(job->scene, first, first + occ_node_own(tree, node));
    }
}

static void reach_of_attached(void *context, uint32_t part)
{
    const reach_job *job = context;
    const occ_octree *tree = &job->scene->object_tree;
    occ_attached *attached = job->scene->attached.data;
    uint32_t last = occ_part_first(tree->nodes.count, job->parts, part + 1);
    for (uint32_t n = occ_part_first(tree->nodes.count, job->parts, part); n < last; n++) {
        const occ_node *node = &occ_octree_nodes(tree)[n];
        uint32_t first = attached[n].first;
        uint32_t end = node->children ? attached[node->child].first : first + attached[n].count;
        attached[n].reach = largest_reach(job->scene, first, end);
    }
}

// The largest reach below each node of both trees. (Children lie after their parent.)
static void refit_reach(occ_scene *scene, occ_team *team)
{
    const occ_octree *tree = &scene->occluder_tree;
    const occ_node *nodes = occ_octree_nodes(tree);
    float *reach = scene->reach.data;
    reach_job job = {scene, occ_parts_of(scene->occluder_rows.count)};
    occ_do_parts(team, job.parts, reach_of_free, &job);
    for (uint32_t n = tree->nodes.count; n-- > 0;)
        for (uint32_t c = 0; c < nodes[n].children; c++)
            reach[n] = fmaxf(reach[n], reach[nodes[n].child + c]);
    tree = &scene->object_tree;
    nodes = occ_octree_nodes(tree);
    occ_attached *attached = scene->attached.data;
    occ_do_parts(team, job.parts, reach_of_attached, &job);
    for (uint32_t n = tree->nodes.count; n-- > 0;)
        for (uint32_t c = 0; c < nodes[n].children; c++)
            attached[n].reach = fmaxf(attached[n].reach, attached[nodes[n].child + c].reach);
}

// --- sorting -------------------------------------------------------------------------------------

// Where the occluders of each of the objects' rows begin, and where those of the last end.
static void count_attached(const occ_scene *scene, uint32_t *place)
{
    const occ_occluder_rows *occluders = &scene->occluder_rows;
    uint32_t rows = scene->boxes.count, sum = 0;
    memset(place, 0, ((size_t)rows + 1) * sizeof *place);
    for (uint32_t i = 0; i < occluders->count; i++) {
        if (occluders->slot_of[i] == OCC_NO_SLOT || occluders->owner_of[i] == OCC_NO_SLOT) continue;
        place[occ_scene_owner_row(scene, i)]++;
    }
    for (uint32_t row = 0; row <= rows; row++) {
        uint32_t here = place[row];
        place[row] = sum;
        sum += here;
    }
}

// Lists the attached occluders by their owners' rows, those of one owner by slot, and behind them
// the free ones by slot.
static void list_occluders(const occ_scene *scene, uint32_t *place, uint32_t *order)
{
    const occ_slots *slots = &scene->occluders;
    uint32_t next_free = place[scene->boxes.count];
    for (uint32_t s = 0; s < slots->count; s++) {
        if (!occ_slots_is_taken(slots, s)) continue;
        uint32_t row = slots->value[s], owner = occ_scene_owner_row(scene, row);
        order[owner == OCC_NO_SLOT ? next_free++ : place[owner]++] = row;
    }
}

// Fills `order` and what is attached to each node. How many are attached goes to `count`.
static occ_result sort_attached(occ_scene *scene, uint32_t *order, uint32_t *count)
{
    uint32_t nodes = scene->object_tree.nodes.count, rows = scene->boxes.count;
    size_t bytes = ((size_t)rows + 1) * sizeof(uint32_t);
    uint32_t *place = occ_alloc(&scene->hooks, bytes);
    occ_result result = place ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
    if (!result) result = occ_array_reserve(&scene->hooks, &scene->attached, nodes);
    if (!result) {
        count_attached(scene, place);
        *count = place[rows];
        scene->attached.count = nodes;
        occ_attached *attached = scene->attached.data;
        for (uint32_t n = 0; n < nodes; n++) {
            const occ_node *node = &occ_octree_nodes(&scene->object_tree)[n];
            attached[n].first = place[node->first];
            attached[n].count = place[node->first + node->count] - attached[n].first;
        }
        list_occluders(scene, place, order);
    }
    occ_free(&scene->hooks, place, bytes);
    return result;
}

// Builds the tree of `count` free occluders, which `order` lists.
static occ_result sort_free(occ_scene *scene, occ_team *team, uint32_t *order, uint32_t count)
{
    occ_tree_items items = occ_scene_occluder_items(scene, 0);
    uint32_t rows = scene->occluder_rows.count;
    size_t bytes = occ_octree_room(rows, count, team);
    void *room = occ_alloc(&scene->hooks, bytes);
    if (bytes && !room) return OCC_ERROR_OUT_OF_MEMORY;
    occ_root root = occ_octree_root(&items, order, count, team);
    occ_result result = occ_octree_build(&scene->hooks, &scene->occluder_tree, &items, rows, &root,
                                         order, count, room, team);
    occ_free(&scene->hooks, room, bytes);
    if (result) return result;
    uint32_t nodes = scene->occluder_tree.nodes.count;
    result = occ_array_reserve(&scene->hooks, &scene->reach, nodes);
    if (!result) scene->reach.count = nodes;
    return result;
}

// Puts the occluders in their order. What is half done when memory runs out is done anew by the
// next commit: the rows change last.
static occ_result sort_occluders(occ_scene *scene, occ_team *team)
{
    uint32_t count = scene->occluders.taken, attached = 0;
    size_t bytes = (size_t)count * sizeof(uint32_t);
    uint32_t *order = occ_alloc(&scene->hooks, bytes);
    if (count && !order) return OCC_ERROR_OUT_OF_MEMORY;
    occ_result result = sort_attached(scene, order, &attached);
    if (!result) {
        result = sort_free(scene, team, order ? order + attached : NULL, count - attached);
    }
    if (!result) {
        result = occ_occluder_rows_gather(&scene->hooks, &scene->occluder_rows, &scene->occluders,
                                          order, count, team);
    }
    if (!result) {
        scene->attached_count = attached;
        occ_slots_recycle(&scene->occluders);
    }
    occ_free(&scene->hooks, order, bytes);
    return result;
}

// Whether moves have left the free occluders their root cube.
static bool keeps_root(const occ_scene *scene, occ_team *team)
{
    occ_tree_items items = occ_scene_occluder_items(scene, scene->attached_count);
    occ_root root = occ_octree_root(&items, NULL, occ_scene_free_count(scene), team);
    return occ_root_equals(&root, &scene->occluder_tree.root);
}

occ_result occ_commit_occluders(occ_scene *scene, occ_team *team)
{
    if (!scene->occluders_reordered && !scene->occluders_moved) return OCC_SUCCESS;
    if (!scene->occluders_reordered) scene->occluders_reordered = !keeps_root(scene, team);
    if (scene->occluders_reordered) {
        occ_result result = sort_occluders(scene, team);
        if (result) return result;
    }
    occ_tree_items items = occ_scene_occluder_items(scene, scene->attached_count);
    occ_octree_refit(&scene->occluder_tree, &items, NULL, NULL, team);
    refit_reach(scene, team);
    return OCC_SUCCESS;
}
