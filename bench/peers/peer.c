// SPDX-License-Identifier: Apache-2.0
#include "peer.h"

#include "thesis.h"
#include "timing.h"

#include <string.h>

#ifdef OCC_BENCH_EMBREE
#include "peer_embree.h"
#endif

// --- the thesis ----------------------------------------------------------------------------------

// It keeps nothing between frames but the scene.
static void *open_thesis(const obs_scene *scene, const peer_options *options, peer_info *info)
{
    (void)options;
    (void)info;
    return (void *)scene;
}

static void cull_by_thesis(void *state, const obs_frame *frame, uint32_t *mask,
                           occ_view_stats *stats)
{
    const obs_scene *scene = state;
    double start = timing_now();
    thesis_cull(scene, frame, mask);
    stats->tested = scene->object_count;
    stats->test_ms = timing_now() - start;
}

static void close_thesis(void *state)
{
    (void)state;
}

// --- the table -----------------------------------------------------------------------------------

const peer_method peer_methods[] = {
    {.name = "thesis",
     .is_quadratic = true,
     .open = open_thesis,
     .cull = cull_by_thesis,
     .close = close_thesis},
#ifdef OCC_BENCH_EMBREE
    {.name = "embree-depth",
     .takes_threads = true,
     .open = peer_depth_open,
     .cull = peer_depth_cull,
     .close = peer_depth_close},
    {.name = "embree-rays",
     .takes_threads = true,
     .open = peer_rays_open,
     .cull = peer_rays_cull,
     .close = peer_rays_close},
#else
    {.name = "embree-depth", .missing = "Embree 3"},
    {.name = "embree-rays", .missing = "Embree 3"},
#endif
    {.name = NULL},
};

const peer_method *peer_find(const char *name)
{
    for (const peer_method *peer = peer_methods; peer->name; peer++)
        if (strcmp(peer->name, name) == 0) return peer;
    return NULL;
}
