// SPDX-License-Identifier: Apache-2.0
#include "settle.h"

#include "judge.h"
#include "progress.h"
#include "settle_frame.h"

#include <stdlib.h>
#include <string.h>

// So many candidates are tried first. Most objects that are hidden are hidden by these, and that
// more occluders take part changes nothing then.
enum { FIRST_TRIED = 24, THEN_TIMES = 6 };

struct settle {
    const obs_scene *scene;
    const truth_result *truth;
    uint8_t *verdicts; // a settle_verdict for each of the truth's
    // the frame in hand
    settle_frame frame;
    judge *judge;
    settle_candidate *candidates;
    occ_box *boxes;
};

const char *settle_check(const obs_scene *scene, const truth_result *truth)
{
    if (scene->object_count != truth->object_count) return "another number of objects";
    if (truth->frame_count == 0) return "a truth without frames";
    if (truth->frames[truth->frame_count - 1] >= scene->frame_count) return "too few frames";
    return NULL;
}

settle *settle_create(const obs_scene *scene, const truth_result *truth)
{
    settle *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    size_t occluders = (size_t)scene->occluder_count + 1;
    s->scene = scene;
    s->truth = truth;
    s->verdicts = calloc((size_t)truth->object_count * truth->frame_count + 1, 1);
    s->candidates = malloc(occluders * sizeof *s->candidates);
    s->boxes = malloc(occluders * sizeof *s->boxes);
    if (s->verdicts && s->candidates && s->boxes) return s;
    settle_destroy(s);
    return NULL;
}

static void leave_frame(settle *s)
{
    settle_frame_free(&s->frame);
    judge_free(s->judge);
    s->judge = NULL;
}

void settle_destroy(settle *s)
{
    if (!s) return;
    leave_frame(s);
    free(s->verdicts);
    free(s->candidates);
    free(s->boxes);
    free(s);
}

settle_verdict settle_look_up(const settle *s, uint32_t frame, uint32_t object)
{
    const truth_result *truth = s->truth;
    for (uint32_t row = 0; row < truth->frame_count; row++)
        if (truth->frames[row] == frame)
            return (settle_verdict)s->verdicts[(size_t)row * truth->object_count + object];
    return SETTLE_UNASKED;
}

// --- judging -------------------------------------------------------------------------------------

// The camera is what `cull` gives the library.
static const char *enter_frame(settle *s, uint32_t index)
{
    const obs_frame *from = &s->scene->frames[index];
    const double eye[3] = {(double)from->eye[0], (double)from->eye[1], (double)from->eye[2]};
    occ_camera_desc camera = {.eye = eye};
    obs_view_projection(from, camera.view_projection);
    const char *complaint = settle_frame_make(&s->frame, s->scene, index);
    if (complaint) return complaint;
    s->judge = judge_of_camera(&camera);
    return s->judge ? NULL : "its camera has no eye or no direction of view";
}

// Drops the occluders that only some readings let hide something.
static uint32_t keep_plain(settle *s, uint32_t object, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t occluder = s->candidates[i].occluder;
        if (settle_frame_is_plain(&s->frame, &s->scene->occluders[occluder].box,
                                  &s->scene->objects[object]))
            s->candidates[kept++] = s->candidates[i];
    }
    return kept;
}

// Whether the judge sees the object past the occluders that can matter. Fewer than all of them are
// enough to say that it does not.
static bool is_seen(settle *s, uint32_t object, bool only_plain)
{
    uint32_t count = settle_frame_select(&s->frame, object, s->candidates);
    if (only_plain) count = keep_plain(s, object, count);
    for (uint32_t i = 0; i < count; i++)
        s->boxes[i] = s->scene->occluders[s->candidates[i].occluder].box;
    for (uint32_t tried = FIRST_TRIED;; tried *= THEN_TIMES) {
        bool are_all = tried >= count;
        judge_set_occluders(s->judge, s->boxes, NULL, are_all ? count : tried);
        if (!judge_sees(s->judge, &s->scene->objects[object], -1)) return false;
        if (are_all) return true;
    }
}

// --- choosing ------------------------------------------------------------------------------------

// So many of a total are taken, evenly.
typedef struct ration {
    uint64_t total, share, met;
} ration;

static bool takes_next(ration *r)
{
    uint64_t before = r->met * r->share / r->total;
    r->met++;
    return r->met * r->share / r->total > before;
}

typedef struct task {
    const vis_result *result;
    ration missed, hidden; // reported visible, reported hidden
    settle_sums *sums;
    truth_result *settled;
} task;

// The ration that a disagreement belongs to, or NULL.
static ration *ration_of(task *t, const truth_verdict *verdict, uint32_t frame, uint32_t object)
{
    if (!(verdict->flags & TRUTH_IN_FRUSTUM)) return NULL;
    bool is_shown = vis_is_visible(t->result, frame, object);
    if (truth_is_visible(verdict) == is_shown) return NULL;
    return is_shown ? &t->missed : &t->hidden;
}

static void share_out(const settle *s, task *t, uint64_t limit)
{
    const truth_result *truth = s->truth;
    for (uint32_t row = 0; row < truth->frame_count; row++)
        for (uint32_t i = 0; i < truth->object_count; i++) {
            const truth_verdict *verdict = &truth->verdicts[(size_t)row * truth->object_count + i];
            ration *from = ration_of(t, verdict, truth->frames[row], i);
            if (from) from->total++;
        }
    t->hidden.share = t->hidden.total < limit ? t->hidden.total : limit;
    uint64_t left = limit - t->hidden.share;
    t->missed.share = t->missed.total < left ? t->missed.total : left;
    t->sums->unsettled = t->hidden.total + t->missed.total - t->hidden.share - t->missed.share;
}

// Asks the judge, if nobody has, and enters what it says.
static const char *settle_object(settle *s, task *t, uint32_t row, uint32_t object)
{
    size_t place = (size_t)row * s->truth->object_count + object;
    bool was_visible = truth_is_visible(&s->truth->verdicts[place]);
    if (s->verdicts[place] == SETTLE_UNASKED) {
        const char *complaint = s->judge ? NULL : enter_frame(s, s->truth->frames[row]);
        if (complaint) return complaint;
        s->verdicts[place] = is_seen(s, object, was_visible) ? SETTLE_VISIBLE : SETTLE_HIDDEN;
    }
    bool is_visible = s->verdicts[place] == SETTLE_VISIBLE;
    t->sums->settled++;
    t->sums->judged_visible += is_visible;
    t->sums->judged_hidden += !is_visible;
    t->sums->false_confirmed += was_visible && is_visible;
    t->sums->false_refuted += was_visible && !is_visible;
    truth_verdict *verdict = &t->settled->verdicts[place];
    if (is_visible && !was_visible) verdict->rays = 1;
    if (!is_visible) verdict->samples = verdict->rays = 0;
    progress_step(t->sums->settled);
    return NULL;
}

static const char *settle_row(settle *s, task *t, uint32_t row)
{
    const truth_result *truth = s->truth;
    const char *complaint = NULL;
    for (uint32_t i = 0; i < truth->object_count && !complaint; i++) {
        const truth_verdict *verdict = &truth->verdicts[(size_t)row * truth->object_count + i];
        ration *from = ration_of(t, verdict, truth->frames[row], i);
        if (from && takes_next(from)) complaint = settle_object(s, t, row, i);
    }
    leave_frame(s);
    return complaint;
}

const char *settle_result(settle *s, const vis_result *result, uint64_t limit,
                          truth_result *settled, settle_sums *sums)
{
    const truth_result *truth = s->truth;
    *sums = (settle_sums){0};
    if (!truth_create(settled, truth->object_count, truth->frame_count)) return "not enough memory";
    settled->width = truth->width;
    settled->height = truth->height;
    memcpy(settled->frames, truth->frames, truth->frame_count * sizeof *truth->frames);
    memcpy(settled->verdicts, truth->verdicts,
           (size_t)truth->object_count * truth->frame_count * sizeof *truth->verdicts);
    task t = {.result = result, .sums = sums, .settled = settled};
    share_out(s, &t, limit);
    progress_begin("settling", t.hidden.share + t.missed.share);
    const char *complaint = NULL;
    for (uint32_t row = 0; row < truth->frame_count && !complaint; row++)
        complaint = settle_row(s, &t, row);
    progress_end();
    if (complaint) truth_free(settled);
    return complaint;
}
