// SPDX-License-Identifier: Apache-2.0
/// @file
/// Cameras, views, and the call per frame.
#ifndef OCCLUDE_CULL_H
#define OCCLUDE_CULL_H

#include "scene.h"

/// Which clip-space depths a view-projection matrix keeps.
typedef enum occ_depth {
    OCC_DEPTH_MINUS_ONE_TO_ONE = 0, ///< Near -1, far 1: OpenGL's default.
    OCC_DEPTH_ZERO_TO_ONE = 1,      ///< Near 0, far 1: Vulkan, Direct3D, Metal, glClipControl.
    OCC_DEPTH_ONE_TO_ZERO = 2       ///< Near 1, far 0: reversed-Z.
} occ_depth;

/// A camera. Eye (or direction) and frustum planes are derived from the matrix in double.
///
/// A matrix whose last row is (0, 0, 0, w) is orthographic: its eye is at infinity. An infinite far
/// plane, an off-centre or a jittered projection need no mention: they are in the matrix.
typedef struct occ_camera_desc {
    float
        view_projection[16]; ///< World to clip, column-major, for column vectors: clip = M * world.
    occ_depth depth;         ///< Default: OpenGL's -1 to 1.
    /// Three doubles: the world point that the matrix's coordinates count from. Far from the
    /// origin, give the camera's position here and a matrix without translation. Default NULL: the
    /// origin.
    const double *origin;
    /// Three doubles: where the eye is, in world units, if you know it better than the matrix,
    /// whose floats round it. Not used for an orthographic camera. Default NULL: derived from the
    /// matrix.
    const double *eye;
} occ_camera_desc;

/// Where the parallel test of objects runs. Equal scenes, cameras and knobs give equal masks on
/// all.
typedef enum occ_backend {
    OCC_BACKEND_OPENMP = 0, ///< OpenMP threads; the plain backend in a build without OpenMP.
    OCC_BACKEND_PLAIN = 1,  ///< One thread of plain C: the reference.
    OCC_BACKEND_OPENCL = 2  ///< The first OpenCL device, or the caller's: see opencl.h.
} occ_backend;

/// How a view is made. All zero, or no desc at all, is a good default.
typedef struct occ_view_desc {
    occ_allocator allocator; ///< Default: the C library.
    occ_logger logger;       ///< Default: silent.
    occ_backend backend;     ///< Default: OpenMP.
    uint32_t threads;        ///< Threads of the OpenMP backend. Default 0: what OpenMP offers.
} occ_view_desc;

/// One thread's scratch memory and its latest result.
typedef struct occ_view occ_view;

/// Makes a view. `desc` is copied and may be NULL. `*view` is NULL on failure. Asking for a backend
/// that is not there is an error, never a silent replacement.
OCC_API OCC_NODISCARD occ_result occ_view_create(const occ_view_desc *desc, occ_view **view);

/// Frees the view. NULL is accepted.
OCC_API void occ_view_destroy(occ_view *view);

/// How objects are decided.
typedef enum occ_method {
    /// Octrees, chosen occluders, and what they hide, one alone or several together (default).
    OCC_METHOD_FUSED = 0,
    OCC_METHOD_FRUSTUM = 1,  ///< The frustum alone: nothing is hidden.
    OCC_METHOD_PAIRWISE = 2, ///< Every object against every occluder. The baseline; quadratic.
    OCC_METHOD_SINGLE = 3    ///< As FUSED, but one occluder must hide all of an object or node.
} occ_method;

/// What a knob that is left 0 stands for. The figures are in docs/concepts.md.
typedef enum occ_preset {
    OCC_PRESET_BALANCED = 0, ///< Default.
    OCC_PRESET_FAST = 1,     ///< Fewer, larger occluders; fusion gives up soon. Misses more.
    OCC_PRESET_THOROUGH = 2  ///< Smaller occluders, and more work on each object. Misses least.
} occ_preset;

/// The greatest `tolerance`, in radians: nearly six degrees.
#define OCC_MAX_TOLERANCE 0.1f

/// The knobs. All zero, or no desc at all, is a good default. They trade missed objects for time;
/// none of them can hide a visible object as long as `tolerance` is 0, whatever else is set.
typedef struct occ_cull_desc {
    occ_method method; ///< Default: fused.
    occ_preset preset; ///< Sets those of the knobs below that are 0. Default: balanced.
    /// The smallest solid angle, in steradians, at which an occluder is worth using: about its
    /// projected area over its distance squared; for an orthographic camera, over the view's area.
    /// 0: the preset's, 3e-4 by default. For every occluder, pass 1e-30.
    float min_area;
    /// Most occluders used in a frame, nearest first. 0: the preset's, 1024 by default.
    uint32_t max_occluders;
    /// A node with at most so many objects is handed to the parallel test as it is. Small suits a
    /// CPU, large a device; it may change what is missed. 0: the preset's, 64 by default.
    uint32_t grain;
    /// FUSED: how many times an occluder may be subtracted from what is left of one object or node
    /// before it counts as visible: a bound on the time that a single one can take. 0: the
    /// preset's, 48 by default.
    uint32_t max_splits;
    /// Radians. Above 0, occluders count as wider than they are, by half of it on each side, and
    /// visible objects *may be hidden*: all that can be seen of such an object lies behind
    /// occluders and next to their outlines, within tolerance / 2 of an edge and within 0.71
    /// tolerance of a corner. So gaps between occluders that look narrower than this are closed. A
    /// pixel is about the vertical field of view over the height in pixels. The same for all
    /// methods and backends; no effect with an orthographic camera, which sees no angles. From 0 to
    /// OCC_MAX_TOLERANCE. Default 0: nothing that can be seen is hidden.
    float tolerance;
} occ_cull_desc;

/// Decides which objects of a committed scene the camera can see, and keeps the result in the view.
/// The scene is only read: any number of views may cull it at the same time. `desc` may be NULL.
/// Once the view has seen a scene of this size and cameras like this one, nothing is allocated.
/// On an error the view holds no result.
OCC_API OCC_NODISCARD occ_result occ_cull(occ_view *view, const occ_scene *scene,
                                          const occ_camera_desc *camera, const occ_cull_desc *desc);

/// The number of 32-bit words in a mask over `slots` slots.
#define OCC_MASK_WORDS(slots) (((size_t)(slots) + 31u) / 32u)

/// Copies the mask: bit `slot % 32` of word `slot / 32` is 1 where the object in that slot may be
/// visible, 0 where it is outside the frustum, hidden, or no object. `*count` is set to the number
/// of words (OCC_MASK_WORDS of the scene's slots); if `capacity` is below that nothing is written
/// and OCC_ERROR_BUFFER_TOO_SMALL returned. With `capacity` 0, `words` may be NULL.
OCC_API OCC_NODISCARD occ_result occ_view_read_mask(const occ_view *view, uint32_t *words,
                                                    size_t capacity, size_t *count);

/// Copies the slots of the objects that may be visible, ascending. Same rules as for the mask.
OCC_API OCC_NODISCARD occ_result occ_view_read_visible(const occ_view *view, uint32_t *slots,
                                                       size_t capacity, size_t *count);

/// Copies the occluders that took part, front to back: none is nearer than one before it by more
/// than a sixteenth of that one's squared distance. Same rules as for the mask.
OCC_API OCC_NODISCARD occ_result occ_view_read_occluders(const occ_view *view,
                                                         occ_occluder *occluders, size_t capacity,
                                                         size_t *count);

/// Whether the object may be visible by the latest result. False for a handle that is zero or whose
/// slot the result does not reach.
OCC_API bool occ_view_is_visible(const occ_view *view, occ_object object);

/// What became of an object.
typedef enum occ_fate {
    OCC_FATE_VISIBLE = 0, ///< The mask shows it.
    OCC_FATE_OUTSIDE = 1, ///< It is outside the frustum.
    OCC_FATE_HIDDEN = 2   ///< Occluders hide all of it that is inside the frustum.
} occ_fate;

/// Says what became of an object by the latest result, and which occluders hid it, front to back:
/// one, or several that do it together and of which the proof can spare none; no occluder if the
/// object was not hidden. Same rules for `occluders` as for the mask. `fate` and `count` may be
/// NULL.
///
/// Nothing is kept for this while culling and nothing is allocated: the reason is found anew when
/// it is asked for, among the occluders that took part, in up to milliseconds. The occluders named
/// prove by themselves that the object is hidden; others may hide it too. With a `tolerance` they
/// count as wider here as well.
///
/// `scene` is the one that was culled, unchanged since: otherwise OCC_ERROR_INVALID_ARGUMENT if it
/// is another, OCC_ERROR_NOT_COMMITTED if it was edited, OCC_ERROR_NO_RESULT if it was edited and
/// committed. A handle that names no object of it gives OCC_ERROR_STALE_HANDLE.
OCC_API OCC_NODISCARD occ_result occ_view_explain(const occ_view *view, const occ_scene *scene,
                                                  occ_object object, occ_fate *fate,
                                                  occ_occluder *occluders, size_t capacity,
                                                  size_t *count);

/// What a frame did, stage by stage. objects = walk_outside + walk_hidden + tested, and
/// tested = test_outside + test_hidden + visible.
typedef struct occ_view_stats {
    uint32_t objects;          ///< Objects in the scene.
    uint32_t walk_outside;     ///< Objects dropped with a node outside the frustum.
    uint32_t walk_hidden;      ///< Objects dropped with a node that one occluder hides.
    uint32_t tested;           ///< Objects handed to the parallel test.
    uint32_t test_outside;     ///< Of these: outside the frustum.
    uint32_t test_hidden;      ///< Of these: hidden, by one occluder or with FUSED by several.
    uint32_t visible;          ///< Of these: the rest, which the mask shows.
    uint32_t nodes_tested;     ///< Octree nodes tested, of both trees.
    uint32_t occluders_tested; ///< Occluders, large enough and not hidden, whose turn came.
    uint32_t occluders_used;   ///< Occluders in the frozen set.
    uint32_t ranges;           ///< Contiguous object ranges handed to the parallel test.
    double walk_ms;            ///< Wall time of choosing occluders and walking the octree.
    double test_ms;            ///< Wall time of the parallel test and of making the mask.
    uint64_t bytes;            ///< Host memory that the view holds.
    uint64_t device_bytes;     ///< Device memory that the view holds.
} occ_view_stats;

/// Fills `stats` from the latest result.
OCC_API OCC_NODISCARD occ_result occ_view_get_stats(const occ_view *view, occ_view_stats *stats);

#endif
