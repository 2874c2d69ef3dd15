// SPDX-License-Identifier: Apache-2.0
// The surface is built anew; how it is parted into planes need not be trusted, for the proof in a
// plane holds for any set of triangles in it. Which planes are asked for a sheet is a matter of
// bounds: a tree over those of all planes tells.
#include "log.h"
#include "soup/sheet_desc.h"
#include "soup/sheet_proof.h"
#include "soup/triangles.h"

#include <math.h>
#include <string.h>

typedef struct bounds {
    float min[3], max[3];
} bounds;

// Node i has nodes 2i and 2i + 1 below it; node leaves + p is plane p's own.
typedef struct plane_tree {
    bounds *node;
    uint32_t leaves; // a power of two
} plane_tree;

typedef struct verify_call {
    occ_hooks *hooks;
    const occ_sheets_desc *desc;
    occ_surface surface;
    occ_corner_index index;
    plane_tree tree;
} verify_call;

// --- planes by bounds ----------------------------------------------------------------------------

static void hold(bounds *b, const float p[3])
{
    for (int k = 0; k < 3; k++) {
        b->min[k] = fminf(b->min[k], p[k]);
        b->max[k] = fmaxf(b->max[k], p[k]);
    }
}

static bool meet(const bounds *a, const bounds *b)
{
    for (int k = 0; k < 3; k++)
        if (a->max[k] < b->min[k] || b->max[k] < a->min[k]) return false;
    return true;
}

static const bounds nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static occ_result build_tree(verify_call *call)
{
    const occ_surface *s = &call->surface;
    plane_tree *tree = &call->tree;
    for (tree->leaves = 1; tree->leaves < s->planes.count; tree->leaves *= 2) {
    }
    tree->node = occ_alloc(call->hooks, 2 * (size_t)tree->leaves * sizeof *tree->node);
    if (!tree->node) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < 2 * tree->leaves; i++)
        tree->node[i] = nothing;
    for (uint32_t t = 0; t < s->mesh.triangles; t++)
        for (int c = 0; c < 3 && s->plane_of[t] != OCC_NO_PLANE; c++)
            hold(&tree->node[tree->leaves + s->plane_of[t]], occ_mesh_corner(&s->mesh, t, c));
    for (uint32_t i = tree->leaves - 1; i > 0; i--)
        for (uint32_t child = 2 * i; child < 2 * i + 2; child++) {
            hold(&tree->node[i], tree->node[child].min);
            hold(&tree->node[i], tree->node[child].max);
        }
    return OCC_SUCCESS;
}

// The node after this one, depth first, without what is below it; 0 after the last.
static uint32_t skip(uint32_t node)
{
    while (node & 1)
        node /= 2;
    return node ? node + 1 : 0;
}

// --- one sheet -----------------------------------------------------------------------------------

static occ_sheet_reason judge(const verify_call *call, const occ_sheet *sheet, uint32_t *beside)
{
    const occ_surface *s = &call->surface;
    occ_sheet_basis basis;
    *beside = UINT32_MAX;
    occ_sheet_reason reason = occ_sheet_shape(sheet, call->desc->sides);
    if (reason) return reason;
    if (occ_prove_by_corners(s, call->desc, &call->index, sheet, &basis)) return OCC_SHEET_SOUND;
    bounds own = nothing;
    for (uint32_t i = 0; i < sheet->corner_count; i++)
        hold(&own, sheet->corner[i]);
    reason = OCC_SHEET_OPEN;
    for (uint32_t node = 1; node;) {
        if (!meet(&own, &call->tree.node[node])) {
            node = skip(node);
        } else if (node < call->tree.leaves) {
            node *= 2;
        } else {
            const occ_sheet_plane *plane =
                (const occ_sheet_plane *)s->planes.data + (node - call->tree.leaves);
            occ_sheet_reason here = occ_prove_in_plane(s, call->desc, plane, sheet, &basis, beside);
            if (here == OCC_SHEET_SOUND) return OCC_SHEET_SOUND;
            if (here != OCC_SHEET_OPEN) reason = here;
            node = skip(node);
        }
    }
    return reason;
}

// --- the call ------------------------------------------------------------------------------------

static occ_result judge_all(verify_call *call, const occ_found_sheet *sheets, size_t count,
                            occ_sheet_fault *fault)
{
    static const char *const why[] = {"is sound", "has no proper outline", "has no area",
                                      "is not convex", "is not proven to lie in the surface"};
    for (size_t i = 0; i < count; i++) {
        uint32_t beside;
        if (i % 1024 == 0) {
            double done = 0.5 + 0.5 * (double)i / (double)count;
            occ_result result = occ_soup_progress(&call->desc->work, call->hooks, done);
            if (result) return result;
        }
        occ_sheet_reason reason = judge(call, &sheets[i].sheet, &beside);
        if (reason == OCC_SHEET_SOUND) continue;
        if (reason != OCC_SHEET_OPEN) beside = UINT32_MAX;
        if (fault) *fault = (occ_sheet_fault){reason, (uint32_t)i, beside};
        return occ_fail(call->hooks, OCC_ERROR_NOT_INSIDE, "sheet %zu %s", i, why[reason]);
    }
    return OCC_SUCCESS;
}

static occ_result check_sheets(const occ_found_sheet *sheets, size_t count, const occ_hooks *hooks)
{
    if (count && !sheets) return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "sheets is NULL");
    if (count >= UINT32_MAX) return occ_fail(hooks, OCC_ERROR_LIMIT, "%zu sheets", count);
    for (size_t i = 0; i < count; i++) {
        const occ_sheet *s = &sheets[i].sheet;
        for (uint32_t c = 0; c < s->corner_count && c < OCC_SHEET_CORNERS; c++)
            for (int k = 0; k < 3; k++) {
                if (fabsf(s->corner[c][k]) <= OCC_MAX_COORDINATE) continue;
                occ_result result =
                    isfinite(s->corner[c][k]) ? OCC_ERROR_OUT_OF_RANGE : OCC_ERROR_NOT_FINITE;
                return occ_fail(hooks, result, "sheet %zu: corner %u is no point", i, (unsigned)c);
            }
    }
    return OCC_SUCCESS;
}

static occ_result verify(occ_hooks *hooks, const occ_soup *soup, const occ_found_sheet *sheets,
                         size_t count, const occ_sheets_desc *desc, occ_sheet_fault *fault)
{
    verify_call call = {.hooks = hooks, .desc = desc};
    occ_result result = occ_surface_build(hooks, soup, desc, &call.surface);
    if (result) return result;
    result = occ_corner_index_build(hooks, &call.surface.mesh, &call.index);
    if (!result) result = build_tree(&call);
    result = result ? occ_fail(hooks, result, "no memory to verify %zu sheets", count)
                    : judge_all(&call, sheets, count, fault);
    occ_free(hooks, call.tree.node, 2 * (size_t)call.tree.leaves * sizeof *call.tree.node);
    occ_corner_index_free(hooks, &call.surface.mesh, &call.index);
    occ_surface_free(hooks, &call.surface);
    return result;
}

occ_result occ_verify_sheets(const occ_soup *soup, const occ_found_sheet *sheets, size_t count,
                             const occ_sheets_desc *desc, occ_sheet_fault *fault)
{
    occ_hooks hooks;
    occ_sheets_desc taken = {0};
    if (desc) taken = *desc;
    if (fault) *fault = (occ_sheet_fault){OCC_SHEET_SOUND, UINT32_MAX, UINT32_MAX};
    occ_result result = occ_soup_hooks(&taken.work, &hooks);
    if (result) return result;
    result = occ_sheets_take_desc(&hooks, &taken);
    if (!result) result = occ_soup_validate(soup, &hooks);
    if (!result) result = check_sheets(sheets, count, &hooks);
    if (result || !count) return result;
    return verify(&hooks, soup, sheets, count, &taken, fault);
}
