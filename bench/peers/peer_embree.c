// SPDX-License-Identifier: Apache-2.0
#include "peer_embree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

unsigned peer_float_flush(void)
{
#ifdef __SSE__
    unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u); // flush to zero, denormals are zero
    return before;
#else
    return 0;
#endif
}

void peer_float_restore(unsigned control)
{
#ifdef __SSE__
    _mm_setcsr(control);
#else
    (void)control;
#endif
}

// --- triangles -----------------------------------------------------------------------------------

// Corner numbers: bit a is the side along axis a.
static const uint32_t box_triangles[12][3] = {{0, 2, 6}, {0, 6, 4}, {1, 7, 3}, {1, 5, 7},
                                              {0, 4, 5}, {0, 5, 1}, {2, 3, 7}, {2, 7, 6},
                                              {0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}};
static const uint32_t sheet_triangles[2][3] = {{0, 1, 3}, {0, 3, 2}};

static bool is_zero(const float *v)
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

// The axes that are not zero come first. Returns their number.
static int sort_axes(const occ_box *box, int order[3])
{
    int count = 0, last = 3;
    for (int a = 0; a < 3; a++) {
        if (is_zero(box->axis[a]))
            order[--last] = a;
        else
            order[count++] = a;
    }
    return count;
}

static uint32_t vertices_of(int axes)
{
    return axes == 3 ? 8 : axes == 2 ? 4 : 0; // a segment or a point has no area
}

static uint32_t triangles_of(int axes)
{
    return axes == 3 ? 12 : axes == 2 ? 2 : 0;
}

static void write_vertices(float (*out)[3], const occ_box *box, const int order[3], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            double sum = (double)box->center[k];
            for (int a = 0; a < 3; a++)
                sum += (i >> a & 1 ? 1.0 : -1.0) * (double)box->axis[order[a]][k];
            out[i][k] = (float)sum;
        }
}

// The high-quality builder cuts triangles, divides by differences of their coordinates and, in
// Debian's build, stops the program where one is zero: a denormal one is, as Embree computes.
static bool is_safe_to_cut(float (*vertices)[3], size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            if (vertices[i][k] != 0 && fabsf(vertices[i][k]) < 1e-30f) return false;
    return true;
}

// What goes into one of Embree's geometries: boxes and sheets that hide from both sides, or sheets
// that hide from their front alone.
typedef struct batch {
    occ_sides sides;
    size_t vertex_count, triangle_count;
    float (*vertices)[3];
    uint32_t (*triangles)[3];
    uint32_t *owners;
} batch;

static batch count_batch(const obs_scene *scene, occ_sides sides)
{
    batch b = {.sides = sides};
    for (uint32_t i = 0; sides == OCC_SIDES_BOTH && i < scene->occluder_count; i++) {
        int order[3], axes = sort_axes(&scene->occluders[i].box, order);
        b.vertex_count += vertices_of(axes);
        b.triangle_count += triangles_of(axes);
    }
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const occ_sheet *sheet = &scene->sheets[i].sheet;
        if (sheet->sides != sides) continue;
        b.vertex_count += sheet->corner_count;
        b.triangle_count += sheet->corner_count - 2;
    }
    return b;
}

static void write_boxes(const batch *b, const obs_scene *scene, uint32_t *vertex,
                        uint32_t *triangle)
{
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        const obs_occluder *occluder = &scene->occluders[i];
        int order[3], axes = sort_axes(&occluder->box, order);
        const uint32_t(*corners)[3] = axes == 3 ? box_triangles : sheet_triangles;
        write_vertices(b->vertices + *vertex, &occluder->box, order, vertices_of(axes));
        for (uint32_t t = 0; t < triangles_of(axes); t++, ++*triangle) {
            b->owners[*triangle] = occluder->owner;
            for (int k = 0; k < 3; k++)
                b->triangles[*triangle][k] = *vertex + corners[t][k];
        }
        *vertex += vertices_of(axes);
    }
}

static void write_batch(const batch *b, const obs_scene *scene)
{
    uint32_t vertex = 0, triangle = 0;
    if (b->sides == OCC_SIDES_BOTH) write_boxes(b, scene, &vertex, &triangle);
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const occ_sheet *sheet = &scene->sheets[i].sheet;
        if (sheet->sides != b->sides) continue;
        memcpy(b->vertices[vertex], sheet->corner, sheet->corner_count * sizeof *sheet->corner);
        for (uint32_t t = 0; t + 2 < sheet->corner_count; t++, triangle++) {
            const uint32_t corners[3] = {vertex, vertex + t + 1, vertex + t + 2};
            b->owners[triangle] = scene->sheets[i].owner;
            memcpy(b->triangles[triangle], corners, sizeof corners);
        }
        vertex += sheet->corner_count;
    }
}

// --- the tree ------------------------------------------------------------------------------------

static bool succeeded(const peer_tree *tree, const char *what)
{
    enum RTCError error = rtcGetDeviceError(tree->device);
    if (error == RTC_ERROR_NONE) return true;
    fprintf(stderr, "occlude-bench: %s: Embree's error %d\n", what, (int)error);
    return false;
}

static bool count_bytes(void *held, ssize_t bytes, bool post)
{
    (void)post;
    atomic_fetch_add((atomic_llong *)held, bytes);
    return true;
}

// Turns down hits from behind. Rays and hits come as arrays of N of each member, in the order of
// the members of RTCRay and RTCHit.
static void keep_front(const struct RTCFilterFunctionNArguments *args)
{
    enum { MEMBER_DIRECTION = 4 };
    const float *ray = (const float *)args->ray + (size_t)MEMBER_DIRECTION * args->N;
    const float *normal = (const float *)args->hit;
    for (unsigned i = 0; i < args->N; i++) {
        float facing = 0;
        for (size_t k = 0; k < 3; k++)
            facing += ray[k * args->N + i] * normal[k * args->N + i];
        if (!(facing < 0)) args->valid[i] = 0;
    }
}

static bool add_batch(peer_tree *tree, const obs_scene *scene, batch *b)
{
    if (b->triangle_count == 0) return true;
    RTCGeometry geometry = rtcNewGeometry(tree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    b->vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                          3 * sizeof(float), b->vertex_count);
    b->triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                           3 * sizeof(uint32_t), b->triangle_count);
    rtcSetGeometryUserData(geometry, b->owners);
    if (b->sides == OCC_SIDES_FRONT) {
        rtcSetGeometryIntersectFilterFunction(geometry, keep_front);
        rtcSetGeometryOccludedFilterFunction(geometry, keep_front);
    }
    if (b->vertices && b->triangles) {
        write_batch(b, scene);
        if (!is_safe_to_cut(b->vertices, b->vertex_count))
            rtcSetSceneBuildQuality(tree->scene, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree->scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    return succeeded(tree, "giving the occluders to Embree");
}

static bool add_geometry(peer_tree *tree, const obs_scene *scene)
{
    batch both = count_batch(scene, OCC_SIDES_BOTH), front = count_batch(scene, OCC_SIDES_FRONT);
    size_t triangle_count = both.triangle_count + front.triangle_count;
    if (both.vertex_count + front.vertex_count > UINT32_MAX || triangle_count > UINT32_MAX) {
        fputs("occlude-bench: too many occluders for one of Embree's geometries\n", stderr);
        return false;
    }
    tree->triangle_count = (uint32_t)triangle_count;
    tree->owners = calloc(triangle_count + 1, sizeof *tree->owners);
    if (!tree->owners) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    both.owners = tree->owners;
    front.owners = tree->owners + both.triangle_count;
    return add_batch(tree, scene, &both) && add_batch(tree, scene, &front);
}

bool peer_tree_open(peer_tree *tree, const obs_scene *scene, bool with_filters)
{
    *tree = (peer_tree){.device = rtcNewDevice(NULL)};
    if (!tree->device) return succeeded(tree, "starting Embree");
    rtcSetDeviceMemoryMonitorFunction(tree->device, count_bytes, &tree->held);
    tree->scene = rtcNewScene(tree->device);
    rtcSetSceneBuildQuality(tree->scene, RTC_BUILD_QUALITY_HIGH);
    if (with_filters) rtcSetSceneFlags(tree->scene, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    bool good = succeeded(tree, "making Embree's scene") && add_geometry(tree, scene);
    if (good) {
        rtcCommitScene(tree->scene);
        good = succeeded(tree, "building Embree's tree");
    }
    if (!good) peer_tree_close(tree);
    return good;
}

void peer_tree_close(peer_tree *tree)
{
    if (tree->scene) rtcReleaseScene(tree->scene);
    if (tree->device) rtcReleaseDevice(tree->device);
    free(tree->owners);
    tree->scene = NULL;
    tree->device = NULL;
    tree->owners = NULL;
}

void peer_tree_tell(const peer_tree *tree, peer_info *info)
{
    info->bytes += (uint64_t)atomic_load(&tree->held);
    info->bytes += (uint64_t)tree->triangle_count * sizeof *tree->owners;
    int version = (int)rtcGetDeviceProperty(tree->device, RTC_DEVICE_PROPERTY_VERSION);
    snprintf(info->driver, sizeof info->driver, "Embree %d.%d.%d", version / 10000,
             version / 100 % 100, version % 100);
}
