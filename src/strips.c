// SPDX-License-Identifier: Apache-2.0
#include "strips.h"

#include <string.h>

// --- memory for walks that run side by side ------------------------------------------------------

static void begin_allocation(occ_strips *strips)
{
    while (atomic_flag_test_and_set_explicit(&strips->allocating, memory_order_acquire))
        ;
}

static void end_allocation(occ_strips *strips)
{
    atomic_flag_clear_explicit(&strips->allocating, memory_order_release);
}

static void *alloc_for_strip(size_t size, size_t alignment, void *user_data)
{
    (void)alignment; // the owner's hooks ask for the same
    occ_strips *strips = user_data;
    begin_allocation(strips);
    void *memory = occ_alloc(strips->hooks, size);
    end_allocation(strips);
    return memory;
}

static void free_of_strip(void *pointer, size_t size, void *user_data)
{
    occ_strips *strips = user_data;
    begin_allocation(strips);
    occ_free(strips->hooks, pointer, size);
    end_allocation(strips);
}

occ_result occ_strips_open(occ_strips *strips, occ_hooks *hooks, const occ_lanes *lanes,
                           uint32_t count)
{
    strips->hooks = hooks;
    strips->team = NULL;
    strips->count = count;
    atomic_flag_clear(&strips->allocating);
    for (uint32_t i = 0; i < count; i++) {
        occ_strip *strip = &strips->strip[i];
        strip->hooks = (occ_hooks){.allocator = {alloc_for_strip, free_of_strip, strips}};
        occ_frame_init(&strip->frame, &strip->hooks, lanes);
    }
    uint32_t threads = occ_threads_offered(0);
    if (count < 2 || threads < 2) return OCC_SUCCESS;
    return occ_team_create(hooks, threads < count ? threads : count, &strips->team);
}

void occ_strips_close(occ_strips *strips)
{
    if (!strips->hooks) return;
    for (uint32_t i = 0; i < strips->count; i++)
        occ_frame_free(&strips->strip[i].frame);
    occ_team_destroy(strips->hooks, strips->team);
    strips->hooks = NULL;
}

// --- strips of a picture -------------------------------------------------------------------------

// The plane on which u is `at`, inside where u is more (turn 1) or less (turn -1).
static void set_border(float plane[4], const occ_screen *screen, float at, float turn)
{
    float most = 0.0f, n[4];
    for (int j = 0; j < 3; j++) {
        n[j] = turn * (screen->row[0][j] - at * screen->row[2][j]);
        most = fmaxf(most, fabsf(n[j]));
    }
    n[3] = turn * -at * screen->w;
    for (int j = 0; j < 4; j++)
        plane[j] = most > 0.0f ? n[j] / most : 0.0f;
}

static void cut_strip(occ_strips *strips, uint32_t i, const occ_frame *whole)
{
    occ_frame *frame = &strips->strip[i].frame;
    occ_eye *eye = &frame->camera.constants;
    float width = 2.0f / (float)strips->count, left = -1.0f + width * (float)i;
    frame->scene = whole->scene;
    frame->camera = whole->camera;
    frame->knobs = whole->knobs;
    frame->stats = (occ_view_stats){.objects = 0};
    if (i > 0) set_border(eye->plane[0], &frame->camera.screen, left, 1.0f);
    if (i + 1 < strips->count) {
        set_border(eye->plane[1], &frame->camera.screen, left + width, -1.0f);
    }
}

static void walk_strip(void *context, uint32_t i)
{
    occ_strips *strips = context;
    strips->strip[i].result = occ_walk(&strips->strip[i].frame);
}

// --- all of them together ------------------------------------------------------------------------

static float key_of(const occ_frame *frame, uint32_t i)
{
    const occ_rect_block *blocks = frame->rects.data;
    return blocks[i / OCC_SHADOW_LANES].key[i % OCC_SHADOW_LANES];
}

// Whether the first occluder left in strip a comes before that of strip b: it is nearer, or as near
// and first by its number.
static bool is_before(const occ_strip *a, const occ_strip *b)
{
    float x = key_of(&a->frame, a->taken), y = key_of(&b->frame, b->taken);
    const occ_occluder *p = a->frame.sources.data, *q = b->frame.sources.data;
    return x < y || (!(y < x) && p[a->taken].index < q[b->taken].index);
}

// The strip whose first occluder is next, or NULL.
static occ_strip *find_next(occ_strips *strips)
{
    occ_strip *next = NULL;
    for (uint32_t i = 0; i < strips->count; i++) {
        occ_strip *strip = &strips->strip[i];
        if (strip->taken == strip->frame.shadows.count) continue;
        if (!next || is_before(strip, next)) next = strip;
    }
    return next;
}

// Whether an occluder is in for the first time.
static bool is_new(occ_strips *strips, uint32_t index)
{
    uint32_t place = index * 0x9e3779b1u >> 20;
    while (strips->merged[place % OCC_MERGED_PLACES]) {
        if (strips->merged[place++ % OCC_MERGED_PLACES] == index) return false;
    }
    strips->merged[place % OCC_MERGED_PLACES] = index;
    return true;
}

// Takes each occluder once, nearest first as far as the strips have them so, while there is room.
static occ_result merge(occ_strips *strips, occ_frame *frame)
{
    uint32_t most = 0, room = frame->knobs.max_occluders;
    if (room > OCC_MOST_MERGED) room = OCC_MOST_MERGED;
    memset(strips->merged, 0, sizeof strips->merged);
    for (uint32_t i = 0; i < strips->count; i++)
        most += strips->strip[i].frame.shadows.count;
    occ_shadow *shadows = occ_array_extend(frame->hooks, &frame->shadows, (size_t)most + 1);
    occ_occluder *sources = occ_array_extend(frame->hooks, &frame->sources, (size_t)most + 1);
    if (!shadows || !sources) return OCC_ERROR_OUT_OF_MEMORY;
    occ_strip *strip;
    while ((strip = find_next(strips)) && frame->shadows.count < room) {
        uint32_t i = strip->taken++;
        const occ_occluder *source = (const occ_occluder *)strip->frame.sources.data + i;
        if (!is_new(strips, source->index)) continue;
        sources[frame->sources.count++] = *source;
        shadows[frame->shadows.count++] = ((const occ_shadow *)strip->frame.shadows.data)[i];
    }
    return OCC_SUCCESS;
}

occ_result occ_strips_choose(occ_strips *strips, occ_frame *frame)
{
    if (strips->count == 1 || frame->camera.orthographic) return occ_walk(frame);
    occ_occluders_clear(frame);
    for (uint32_t i = 0; i < strips->count; i++) {
        cut_strip(strips, i, frame);
        strips->strip[i].taken = 0;
    }
    if (strips->team) occ_team_wake(strips->team);
    occ_do_parts(strips->team, strips->count, walk_strip, strips);
    if (strips->team) occ_team_rest(strips->team);
    for (uint32_t i = 0; i < strips->count; i++)
        if (strips->strip[i].result) return strips->strip[i].result;
    return merge(strips, frame);
}
