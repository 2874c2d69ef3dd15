// SPDX-License-Identifier: Apache-2.0
// Greedy choice, lazily: what a candidate adds can only become less, so the best of a heap whose
// gain has not dropped since it was last looked at is the best of all (Minoux, 1978).
#include "soup/search.h"

#include "log.h"
#include "soup/grow.h"

#define LEAST_GAIN 1e-5 // of the silhouette: less than a picture shows

typedef struct chooser {
    occ_search *search;
    occ_candidate *at;
    uint32_t *heap, count;
    occ_array near; // for growing
    occ_mark mark;
} chooser;

// The larger gain; of equals, the one that was found first.
static bool is_before(const chooser *c, uint32_t a, uint32_t b)
{
    if (c->at[a].gain != c->at[b].gain) return c->at[a].gain > c->at[b].gain;
    return a < b;
}

static void sink(chooser *c, uint32_t i)
{
    uint32_t held = c->heap[i], child;
    for (; (child = 2 * i + 1) < c->count; i = child) {
        if (child + 1 < c->count && is_before(c, c->heap[child + 1], c->heap[child])) child++;
        if (!is_before(c, c->heap[child], held)) break;
        c->heap[i] = c->heap[child];
    }
    c->heap[i] = held;
}

static const occ_site *site_of(const chooser *c, uint32_t candidate)
{
    const occ_laid_grid *laid = c->search->laid.data;
    return (const occ_site *)c->search->sites.data + laid[c->at[candidate].laid].site;
}

static occ_silhouette *pictures_of(const chooser *c, uint32_t candidate)
{
    const occ_laid_grid *laid = c->search->laid.data;
    return occ_site_pictures(c->search->sites.data, laid[c->at[candidate].laid].site);
}

// Takes the best candidate from the heap; false if none is worth it.
static bool take_best(chooser *c, double least, uint32_t *best)
{
    while (c->count) {
        *best = c->heap[0];
        occ_candidate *top = &c->at[*best];
        double gain = occ_silhouette_gain(pictures_of(c, *best), &top->box);
        bool still = gain == top->gain;
        top->gain = gain;
        if (still && gain < least) return false;
        if (!still) {
            sink(c, 0);
            continue;
        }
        c->heap[0] = c->heap[--c->count];
        sink(c, 0);
        return true;
    }
    return false;
}

// Grows a candidate and proves what came of it: `*sound` if it is an inner box.
static occ_result make_box(chooser *c, uint32_t candidate, occ_inner_box *out, bool *sound)
{
    occ_search *s = c->search;
    const occ_site *site = site_of(c, candidate);
    const occ_triangles *t = &site->part;
    occ_voxels v = {0};
    *out = (occ_inner_box){.grid = ((occ_laid_grid *)s->laid.data)[c->at[candidate].laid].grid};
    *sound = false;
    if (!occ_voxels_set(&v, &out->grid)) return OCC_SUCCESS;
    bool grown;
    occ_result result = occ_grow_box(s->hooks, &v, &site->near, &c->at[candidate].cells, &c->near,
                                     &out->box, &grown);
    if (result || !grown || occ_find_intruder(t, &out->box) != UINT32_MAX) return result;
    result = occ_mark_point(s->hooks, &s->closed, t->list, t->count, out->box.center, &c->mark);
    if (result) return result;
    out->closed = occ_is_closed_off(&s->space, &c->mark, NULL);
    *sound = out->closed || occ_is_dry_enough(&s->space, &c->mark, out->grid.hole);
    return OCC_SUCCESS;
}

static occ_result choose(chooser *c, occ_inner_box *boxes, size_t capacity, size_t *count)
{
    occ_search *s = c->search;
    double all = (double)s->stats.silhouette, covered = 0.0;
    double enough = s->desc->coverage > 0.0f ? (double)s->desc->coverage : 1.0;
    uint32_t best;
    while (*count < capacity && covered < enough * all && take_best(c, LEAST_GAIN * all, &best)) {
        occ_inner_box *box = &boxes[*count];
        bool sound;
        occ_result result = occ_soup_progress(&s->desc->work, s->hooks,
                                              0.7 + 0.3 * (double)*count / (double)capacity);
        if (result) return result;
        result = make_box(c, best, box, &sound);
        if (result) return occ_fail(s->hooks, result, "no memory to grow a box");
        if (!sound) continue;
        occ_silhouette *silhouette = pictures_of(c, best);
        double gain = occ_silhouette_gain(silhouette, &box->box);
        occ_silhouette_cover(silhouette, &box->box);
        box->gain = (float)(gain / all);
        covered += gain;
        ++*count;
    }
    s->stats.coverage = all > 0.0 ? (float)(covered / all) : 0.0f;
    return OCC_SUCCESS;
}

occ_result occ_search_choose(occ_search *search, occ_inner_box *boxes, size_t capacity,
                             size_t *count)
{
    uint32_t candidates = search->candidates.count;
    if (!candidates || !capacity) return OCC_SUCCESS;
    chooser c = {.search = search,
                 .at = search->candidates.data,
                 .count = candidates,
                 .near = OCC_ARRAY(occ_near_triangle),
                 .mark = OCC_MARK};
    c.heap = occ_alloc(search->hooks, candidates * sizeof *c.heap);
    if (!c.heap)
        return occ_fail(search->hooks, OCC_ERROR_OUT_OF_MEMORY,
                        "no memory for the choice of boxes");
    for (uint32_t i = 0; i < candidates; i++)
        c.heap[i] = i;
    for (uint32_t i = candidates / 2; i-- > 0;)
        sink(&c, i);
    occ_result result = choose(&c, boxes, capacity, count);
    occ_array_free(search->hooks, &c.near);
    occ_mark_free(search->hooks, &c.mark);
    occ_free(search->hooks, c.heap, candidates * sizeof *c.heap);
    return result;
}
