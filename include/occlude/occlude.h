// SPDX-License-Identifier: Apache-2.0
/// @file
/// occlude: which of your objects can the camera see? Boxes in, a visibility mask out.
///
/// **Units.** World units are yours (metres, say); nothing in the library knows a scale. Positions
/// are floats up to OCC_MAX_COORDINATE; an eye is three doubles. Denormal numbers are numbers.
///
/// **Handedness.** Any. Boxes may be mirrored, and the camera is only a matrix.
///
/// **Matrices** are `float[16]`, column-major, for column vectors: element (row r, column c) is
/// m[4 * c + r], and clip = view_projection * world. That is what OpenGL, cglm and most engines
/// hold in memory; transpose a row-major one.
///
/// **Depth.** Clip x and y run over [-w, w]. Clip z runs over [-w, w], [0, w], or [w, 0]
/// (reversed), as occ_camera_desc says. The far plane may be infinite.
///
/// **What is promised.** An object is reported hidden only if no point of its box can be seen from
/// the eye past the solid of one single occluder box that is not its own, or, with the method
/// FUSED, past those of all of them together. Rounding never breaks that: every doubt (a number too
/// near zero, an eye inside an occluder or in the plane of its face, an occluder that the near
/// plane cuts open) is answered "visible". This is what *conservative* means here. An object that
/// lies in the very surface of an occluder stays visible. Objects may be reported visible though
/// hidden; the knobs of occ_cull_desc move how many. One of them, `tolerance`, weakens the promise
/// by an angle; it is 0 unless you set it.
///
/// **Equal answers.** The same scene, camera and knobs give the same mask bit for bit, whatever the
/// backend, the thread count or the instruction set of the CPU.
///
/// **Threads.** A scene may be read by any number of threads while none edits it: occ_cull() takes
/// it const. Edits and occ_scene_commit() need it alone. A view belongs to one thread at a time.
/// Scenes and views have threads of their own to help with large commits and culls. They start when
/// they are first of use, read nothing once the call has returned, sleep soon after, and end with
/// the scene or view; a call never waits for one that is not running. A child process makes its own
/// after a fork(). There is no state outside scenes and views.
///
/// **Errors** are occ_result values; a log line gives the reason if a logger was set. Bad input
/// never aborts and leaves the scene untouched.
///
/// A frame:
/// @code
///     occ_cull(view, scene, &camera, NULL);
///     occ_view_read_visible(view, slots, capacity, &count);
/// @endcode
#ifndef OCCLUDE_H
#define OCCLUDE_H

#include "base.h"
#include "clusters.h"
#include "cull.h"
#include "inner.h"
#include "instances.h"
#include "scene.h"
#include "sheets.h"
#include "soup.h"
#include "version.h"

#endif
