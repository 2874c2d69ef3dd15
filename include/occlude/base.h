// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every other header of occlude needs: linkage, results, allocation and logging hooks.
#ifndef OCCLUDE_BASE_H
#define OCCLUDE_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "version.h"

// Linkage of every public function. Define it yourself to override what follows; a program that
// links the static library on Windows defines OCC_STATIC.
#ifndef OCC_API
#ifdef __cplusplus
#define OCC_EXTERN extern "C"
#else
#define OCC_EXTERN extern
#endif
#if defined(_WIN32) && !defined(OCC_STATIC)
#ifdef OCC_BUILD
#define OCC_API OCC_EXTERN __declspec(dllexport)
#else
#define OCC_API OCC_EXTERN __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define OCC_API OCC_EXTERN __attribute__((visibility("default")))
#else
#define OCC_API OCC_EXTERN
#endif
#endif

#ifdef __GNUC__
#define OCC_NODISCARD __attribute__((warn_unused_result))
#else
#define OCC_NODISCARD
#endif

/// What a call came to. 0 is success, errors are negative, and a number is never used again for
/// another meaning. After an error the objects passed in are as they were before the call.
typedef enum occ_result {
    OCC_SUCCESS = 0,
    OCC_ERROR_INVALID_ARGUMENT = -1, ///< A NULL pointer, or a value outside what the member allows.
    OCC_ERROR_NOT_FINITE = -2,       ///< A NaN or an infinity among the numbers passed in.
    OCC_ERROR_OUT_OF_RANGE = -3,     ///< A finite coordinate beyond OCC_MAX_COORDINATE.
    OCC_ERROR_STALE_HANDLE = -4,     ///< The object or occluder was removed, or never existed here.
    OCC_ERROR_OUT_OF_MEMORY = -5,    ///< The allocator or the device has no more memory.
    OCC_ERROR_BUFFER_TOO_SMALL = -6, ///< The array is too short; the size needed was written.
    OCC_ERROR_NOT_COMMITTED = -7,    ///< The scene has edits that occ_scene_commit() has not seen.
    OCC_ERROR_DEGENERATE_CAMERA = -8, ///< The matrix has no eye: it is singular.
    OCC_ERROR_UNSUPPORTED = -9,       ///< This build lacks the backend that was asked for.
    OCC_ERROR_NO_DEVICE = -10,        ///< No OpenCL platform or device is present.
    OCC_ERROR_KERNEL_BUILD = -11, ///< The device's compiler refused a kernel; its log was logged.
    OCC_ERROR_DEVICE = -12,       ///< A call to the device failed, or the device was lost.
    OCC_ERROR_LIMIT = -13,        ///< More objects, occluders or slots than 32-bit indices hold.
    OCC_ERROR_CORRUPT = -14,      ///< A validator found a broken invariant (a bug of the library).
    OCC_ERROR_NO_RESULT = -15,    ///< The view holds no result: nothing was culled with it yet.
    OCC_ERROR_NOT_INSIDE = -16,   ///< A box that was checked is not where it was claimed to be.
    OCC_ERROR_CANCELLED = -17     ///< The caller's progress function stopped the work.
} occ_result;

/// The enumerator's own name, such as "OCC_ERROR_STALE_HANDLE"; "OCC_UNKNOWN" for other numbers.
OCC_API const char *occ_result_name(occ_result result);

/// One English sentence on what went wrong, without a full stop. Never NULL.
OCC_API const char *occ_result_message(occ_result result);

/// The version of the library that is linked, as OCC_VERSION was when it was built.
OCC_API int occ_version(void);

/// Where memory comes from. All zero: the C library. Both functions or neither must be given.
/// They are called from the thread that makes the call into the library, never from its workers.
typedef struct occ_allocator {
    /// Returns `size` bytes (never 0) aligned to `alignment` (a power of two, at most 64), or NULL.
    void *(*alloc)(size_t size, size_t alignment, void *user_data);
    /// Takes back what `alloc` gave, with the same size. Never called with NULL.
    void (*free)(void *pointer, size_t size, void *user_data);
    void *user_data; ///< Handed to both.
} occ_allocator;

/// How grave a log line is.
typedef enum occ_log_level {
    OCC_LOG_ERROR = 1,   ///< A call failed; the line gives the reason.
    OCC_LOG_WARNING = 2, ///< It works, but not as asked.
    OCC_LOG_INFO = 3     ///< What was chosen: device, instruction set, threads.
} occ_log_level;

/// Where log lines go. All zero: nowhere. A line has no newline at its end and is valid only during
/// the call.
typedef struct occ_logger {
    void (*log)(occ_log_level level, const char *line, void *user_data);
    void *user_data; ///< Handed to `log`.
} occ_logger;

#endif
