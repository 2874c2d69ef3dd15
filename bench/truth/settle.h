// SPDX-License-Identifier: Apache-2.0
/// @file
/// Puts to the exact judge what a result and the sampled truth do not agree on: objects in the
/// frustum that no sample and no ray could see but that are reported visible, and objects that one
/// could see but that are reported hidden; and, if asked to, what both take for hidden.
/// docs/truth.md says where sampling and judge read "hidden" differently. All that only some
/// readings hide is doubtful, and doubt counts against the result: what sampling could not see then
/// stays missed, what it saw false-hidden. There in builds with GMP alone: OCC_BENCH_JUDGE is
/// defined for what links occ_bench_settle.
#ifndef OCC_BENCH_SETTLE_H
#define OCC_BENCH_SETTLE_H

#include "obs.h"
#include "truth_file.h"
#include "vis.h"

/// A judge of a scene and its truth, which both must outlive it. It remembers: what it was once
/// asked costs nothing in later results of the same truth.
typedef struct settle settle;

/// What the judge said of an object in a frame.
typedef enum settle_verdict {
    SETTLE_UNASKED,
    SETTLE_VISIBLE,  ///< By every reading of what an occluder hides (docs/truth.md).
    SETTLE_HIDDEN,   ///< By every reading.
    SETTLE_DOUBTFUL, ///< By some readings.
} settle_verdict;

/// What became of a result's disagreements with the truth.
typedef struct settle_sums {
    uint64_t settled;         ///< Put to the judge: judged_visible + judged_hidden.
    uint64_t judged_visible;  ///< Of these: seen, even if by less than a sample.
    uint64_t judged_hidden;   ///< Of these: not.
    uint64_t unsettled;       ///< Beyond the limit; they count as sampling has it.
    uint64_t false_confirmed; ///< Of judged_visible: reported hidden.
    uint64_t false_refuted;   ///< Of judged_hidden: reported hidden, though sampling saw them.
    uint64_t agreed_judged;   ///< Hidden for both, and put to the judge.
    uint64_t agreed_seen;     ///< Of these: seen by every reading. They are false-hidden.
    uint64_t agreed_doubtful; ///< Of these: seen by some readings.
    uint64_t agreed_unjudged; ///< Hidden for both, beyond the limit.
} settle_sums;

/// How many objects, over all frames, are put to the judge.
typedef struct settle_limits {
    uint64_t disagreed; ///< Those reported hidden come first.
    uint64_t agreed;    ///< Hidden for both.
} settle_limits;

/// How many disagreements are settled unless one says otherwise.
enum { SETTLE_DEFAULT = 10000 };

/// NULL if truth and scene speak of the same objects and frames. Else what is wrong.
const char *settle_check(const obs_scene *scene, const truth_result *truth);

/// NULL when memory runs out. The two must have passed settle_check().
settle *settle_create(const obs_scene *scene, const truth_result *truth);

/// NULL is accepted.
void settle_destroy(settle *s);

/// Settles a result that goes with the truth (compare_check()). Which objects are taken where there
/// are more than a limit allows depends on nothing but truth, result and limits, and they are
/// spread evenly over frames and objects. `settled` becomes a copy of the truth in which what the
/// judge says stands, to be counted by compare_count() and freed by truth_free(): an object that is
/// seen after all has one ray, one that is not has neither samples nor rays. Returns NULL, or what
/// went wrong; `settled` is empty then.
const char *settle_result(settle *s, const vis_result *result, settle_limits limits,
                          truth_result *settled, settle_sums *sums);

/// What the judge said of an object in a frame of the scene that the truth has.
settle_verdict settle_look_up(const settle *s, uint32_t frame, uint32_t object);

#endif
