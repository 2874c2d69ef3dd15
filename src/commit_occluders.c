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

// The largest reach among occluders [first, end) of the order.
static float largest_reach(const occ_scene *scene, uint32_t first, uint32_t end)
{
    const uint32_t *order = scene->occluder_order.data;
    float most = 0.0f, found[OCC_BLOCK];
    for (uint32_t i = first; i < end; i += OCC_BLOCK) {
        uint32_t count = end - i < OCC_BLOCK ? end - i : OCC_BLOCK;
        occ_reaches_of_array(occ_scene_occluder_boxes(scene), order + i, count, found);
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
    reach_job job = {scene, occ_parts_of(scene->occluder_order.count)};
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

// Where the occluders of each row begin in the order, and where those of the last end.
static void count_attached(const occ_scene *scene, uint32_t *place)
{
    const occ_slots *occluders = &scene->occluders;
    uint32_t rows = scene->boxes.count, sum = 0;
    memset(place, 0, ((size_t)rows + 1) * sizeof *place);
    for (uint32_t s = 0; s < occluders->count; s++)
        if (occ_slots_is_taken(occluders, s) && occluders->value[s] != OCC_NO_SLOT)
            place[scene->objects.value[occluders->value[s]]]++;
    for (uint32_t row = 0; row <= rows; row++) {
        uint32_t here = place[row];
        place[row] = sum;
        sum += here;
    }
}

// Sorts the attached occluders by their owners' rows, those of one owner by slot, and lists the
// free ones after them.
static void list_occluders(occ_scene *scene, uint32_t *place)
{
    const occ_slots *occluders = &scene->occluders;
    const occ_node *nodes = occ_octree_nodes(&scene->object_tree);
    occ_attached *attached = scene->attached.data;
    count_attached(scene, place);
    uint32_t *order = scene->occluder_order.data, free_place = place[scene->boxes.count];
    scene->attached_count = free_place;
    for (uint32_t n = 0; n < scene->object_tree.nodes.count; n++) {
        attached[n].first = place[nodes[n].first];
        attached[n].count = place[nodes[n].first + nodes[n].count] - attached[n].first;
    }
    for (uint32_t s = 0; s < occluders->count; s++) {
        if (!occ_slots_is_taken(occluders, s)) continue;
        uint32_t owner = occluders->value[s];
        order[owner == OCC_NO_SLOT ? free_place++ : place[scene->objects.value[owner]]++] = s;
    }
}

static occ_result sort_attached(occ_scene *scene)
{
    uint32_t nodes = scene->object_tree.nodes.count;
    size_t bytes = ((size_t)scene->boxes.count + 1) * sizeof(uint32_t);
    uint32_t *place = occ_alloc(&scene->hooks, bytes);
    occ_result result = place ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
    if (!result) {
        result = occ_array_reserve(&scene->hooks, &scene->occluder_order, scene->occluders.taken);
    }
    if (!result) result = occ_array_reserve(&scene->hooks, &scene->attached, nodes);
    if (!result) {
        scene->attached.count = nodes;
        scene->occluder_order.count = scene->occluders.taken;
        list_occluders(scene, place);
    }
    occ_free(&scene->hooks, place, bytes);
    return result;
}

// The free occluders: their places in the order, or NULL if there are none.
static uint32_t *free_order(const occ_scene *scene)
{
    uint32_t *order = scene->occluder_order.data;
    return order ? order + scene->attached_count : NULL;
}

static occ_result sort_free(occ_scene *scene, occ_team *team, const occ_tree_items *items)
{
    uint32_t count = scene->occluder_order.count - scene->attached_count;
    uint32_t slots = scene->occluders.count, *order = free_order(scene);
    size_t bytes = occ_octree_room(slots, count, team);
    void *room = occ_alloc(&scene->hooks, bytes);
    if (bytes && !room) return OCC_ERROR_OUT_OF_MEMORY;
    occ_root root = occ_octree_root(items, order, count, team);
    occ_result result = occ_octree_build(&scene->hooks, &scene->occluder_tree, items, slots, &root,
                                         order, count, room, team);
    occ_free(&scene->hooks, room, bytes);
    if (result) return result;
    uint32_t nodes = scene->occluder_tree.nodes.count;
    result = occ_array_reserve(&scene->hooks, &scene->reach, nodes);
    if (!result) scene->reach.count = nodes;
    return result;
}

occ_result occ_commit_occluders(occ_scene *scene, occ_team *team)
{
    if (!scene->occluders_reordered && !scene->occluders_moved) return OCC_SUCCESS;
    occ_tree_items items = occ_scene_occluder_items(scene);
    if (!scene->occluders_reordered) {
        uint32_t count = scene->occluder_order.count - scene->attached_count;
        occ_root root = occ_octree_root(&items, free_order(scene), count, team);
        scene->occluders_reordered = !occ_root_equals(&root, &scene->occluder_tree.root);
    }
    if (scene->occluders_reordered) {
        occ_result result = sort_attached(scene);
        if (!result) result = sort_free(scene, team, &items);
        if (result) return result;
        occ_slots_recycle(&scene->occluders);
    }
    occ_octree_refit(&scene->occluder_tree, &items, free_order(scene), NULL, team);
    refit_reach(scene, team);
    return OCC_SUCCESS;
}
