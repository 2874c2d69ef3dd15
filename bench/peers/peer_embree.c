// SPDX-License-Identifier: Apache-2.0
#include "peer_embree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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

static void write_triangles(peer_tree *tree, const obs_scene *scene, float (*vertices)[3],
                            uint32_t (*triangles)[3])
{
    uint32_t vertex = 0, triangle = 0;
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        const obs_occluder *occluder = &scene->occluders[i];
        int order[3], axes = sort_axes(&occluder->box, order);
        const uint32_t(*corners)[3] = axes == 3 ? box_triangles : sheet_triangles;
        write_vertices(vertices + vertex, &occluder->box, order, vertices_of(axes));
        for (uint32_t t = 0; t < triangles_of(axes); t++, triangle++) {
            tree->owners[triangle] = occluder->owner;
            for (int k = 0; k < 3; k++)
                triangles[triangle][k] = vertex + corners[t][k];
        }
        vertex += vertices_of(axes);
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

static bool add_geometry(peer_tree *tree, const obs_scene *scene)
{
    size_t vertex_count = 0, triangle_count = 0;
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        int order[3], axes = sort_axes(&scene->occluders[i].box, order);
        vertex_count += vertices_of(axes);
        triangle_count += triangles_of(axes);
    }
    if (vertex_count > UINT32_MAX || triangle_count > UINT32_MAX) {
        fputs("occlude-bench: too many occluders for one of Embree's geometries\n", stderr);
        return false;
    }
    tree->triangle_count = (uint32_t)triangle_count;
    tree->owners = calloc(triangle_count + 1, sizeof *tree->owners);
    if (!tree->owners) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    if (triangle_count == 0) return true;
    RTCGeometry geometry = rtcNewGeometry(tree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             3 * sizeof(float), vertex_count);
    void *triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(uint32_t), triangle_count);
    rtcSetGeometryUserData(geometry, tree->owners);
    if (vertices && triangles) {
        write_triangles(tree, scene, vertices, triangles);
        if (!is_safe_to_cut(vertices, vertex_count))
            rtcSetSceneBuildQuality(tree->scene, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree->scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    return succeeded(tree, "giving the occluders to Embree");
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
