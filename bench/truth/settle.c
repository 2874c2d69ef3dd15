// SPDX-License-Identifier: Apache-2.0
#include "settle.h"

#include "judge.h"
#include "progress.h"
#include "settle_frame.h"

#include <stdlib.h>
#include <string.h>

// So many candidates are tried first. Most objects that are hidden are hidden by these, and no
// further occluder changes that.
enum { FIRST_TRIED = SETTLE_BEST, THEN_TIMES = 6 };

typedef struct settle_given {
    occ_box *boxes;
    occ_sheet *sheets;
    uint32_t box_count, sheet_count;
} settle_given;

struct settle {
    const obs_scene *scene;
    const truth_result *truth;
    uint8_t *verdicts; // a settle_verdict for each of the truth's
    // the frame in hand
    settle_frame frame;
    judge *judge;
    settle_candidate *candidates; // of the object in hand
    uint32_t candidate_count;
    settle_given given; // what the judge is given of them
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
    size_t occluders = (size_t)obs_occluder_total(scene) + 1;
    s->scene = scene;
    s->truth = truth;
    s->verdicts = calloc((size_t)truth->object_count * truth->frame_count + 1, 1);
    s->candidates = malloc(occluders * sizeof *s->candidates);
    s->given.boxes = malloc(((size_t)scene->occluder_count + 1) * sizeof *s->given.boxes);
    s->given.sheets = malloc(((size_t)scene->sheet_count + 1) * sizeof *s->given.sheets);
    if (s->verdicts && s->candidates && s->given.boxes && s->given.sheets) return s;
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
    free(s->given.boxes);
    free(s->given.sheets);
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

// Adds from the list of candidates to what is given, as many as `wanted` in all if there are so
// many. `*next` is the first candidate not looked at yet.
static void give(settle *s, uint32_t object, bool only_plain, uint32_t wanted, uint32_t *next)
{
    settle_given *given = &s->given;
    for (; given->box_count + given->sheet_count < wanted && *next < s->candidate_count; ++*next) {
        uint32_t occluder = s->candidates[*next].occluder;
        const occ_sheet *sheet = obs_occluder_sheet(s->scene, occluder);
        if (only_plain && !settle_frame_is_plain(&s->frame, occluder, &s->scene->objects[object]))
            continue;
        if (sheet)
            given->sheets[given->sheet_count++] = *sheet;
        else
            given->boxes[given->box_count++] = s->scene->occluders[occluder].box;
    }
}

// Whether the judge sees the object past its candidates, or past the plain ones. Some of them may
// be enough to say that it does not.
static bool is_seen(settle *s, uint32_t object, bool only_plain)
{
    uint32_t next = 0;
    s->given.box_count = s->given.sheet_count = 0;
    for (uint32_t wanted = FIRST_TRIED;; wanted *= THEN_TIMES) {
        give(s, object, only_plain, wanted, &next);
        judge_set_occluders(s->judge, s->given.boxes, NULL, s->given.box_count);
        judge_add_sheets(s->judge, s->given.sheets, NULL, s->given.sheet_count);
        if (!judge_sees(s->judge, &s->scene->objects[object], -1)) return false;
        if (next == s->candidate_count) return true;
    }
}

static settle_verdict ask(settle *s, uint32_t object)
{
    s->candidate_count = settle_frame_select(&s->frame, object, s->candidates);
    if (is_seen(s, object, true))
        return is_seen(s, object, false) ? SETTLE_VISIBLE : SETTLE_DOUBTFUL;
    bool is_outside = judge_frustum(s->judge, &s->scene->objects[object]) == JUDGE_OUTSIDE;
    return is_outside ? SETTLE_DOUBTFUL : SETTLE_HIDDEN;
}

// --- choosing ------------------------------------------------------------------------------------

// So many of a total are taken, evenly.
typedef struct ration {
    uint64_t total, share;
    uint64_t carried; // less than total
} ration;

static bool takes_next(ration *r)
{
    r->carried += r->share;
    if (r->carried < r->total) return false;
    r->carried -= r->total;
    return true;
}

typedef struct task {
    const vis_result *result;
    ration missed, hidden; // disagreed on: reported visible, reported hidden
    ration agreed;         // hidden for both
    settle_sums *sums;
    truth_result *settled;
} task;

// The ration that an object belongs to, or NULL: what is outside, or visible for both.
static ration *ration_of(task *t, const truth_verdict *verdict, uint32_t frame, uint32_t object)
{
    if (!(verdict->flags & TRUTH_IN_FRUSTUM)) return NULL;
    bool is_shown = vis_is_visible(t->result, frame, object);
    if (is_shown) return truth_is_visible(verdict) ? NULL : &t->missed;
    return truth_is_visible(verdict) ? &t->hidden : &t->agreed;
}

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void share_out(const settle *s, task *t, settle_limits limits)
{
    const truth_result *truth = s->truth;
    for (uint32_t row = 0; row < truth->frame_count; row++)
        for (uint32_t i = 0; i < truth->object_count; i++) {
            const truth_verdict *verdict = &truth->verdicts[(size_t)row * truth->object_count + i];
            ration *from = ration_of(t, verdict, truth->frames[row], i);
            if (from) from->total++;
        }
    t->hidden.share = least(t->hidden.total, limits.disagreed);
    t->missed.share = least(t->missed.total, limits.disagreed - t->hidden.share);
    t->agreed.share = least(t->agreed.total, limits.agreed);
    t->sums->unsettled = t->hidden.total + t->missed.total - t->hidden.share - t->missed.share;
    t->sums->agreed_unjudged = t->agreed.total - t->agreed.share;
}

// Doubt leaves false-hidden what sampling saw, and missed what it did not.
static void count_object(settle_sums *sums, bool is_agreed, bool was_visible, settle_verdict said)
{
    if (is_agreed) {
        sums->agreed_judged++;
        sums->agreed_seen += said == SETTLE_VISIBLE;
        sums->agreed_doubtful += said == SETTLE_DOUBTFUL;
        return;
    }
    bool is_visible = was_visible ? said != SETTLE_HIDDEN : said == SETTLE_VISIBLE;
    sums->settled++;
    sums->judged_visible += is_visible;
    sums->judged_hidden += !is_visible;
    sums->false_confirmed += was_visible && is_visible;
    sums->false_refuted += was_visible && !is_visible;
}

// Asks the judge, if nobody has, and enters what it says.
static const char *settle_object(settle *s, task *t, uint32_t row, uint32_t object, bool is_agreed)
{
    size_t place = (size_t)row * s->truth->object_count + object;
    if (s->verdicts[place] == SETTLE_UNASKED) {
        const char *complaint = s->judge ? NULL : enter_frame(s, s->truth->frames[row]);
        if (complaint) return complaint;
        s->verdicts[place] = (uint8_t)ask(s, object);
    }
    settle_verdict said = (settle_verdict)s->verdicts[place];
    truth_verdict *verdict = &t->settled->verdicts[place];
    bool was_visible = truth_is_visible(verdict);
    if (said == SETTLE_VISIBLE && !was_visible) verdict->rays = 1;
    if (said == SETTLE_HIDDEN) verdict->samples = verdict->rays = 0;
    count_object(t->sums, is_agreed, was_visible, said);
    progress_step(t->sums->settled + t->sums->agreed_judged);
    return NULL;
}

static const char *settle_row(settle *s, task *t, uint32_t row)
{
    const truth_result *truth = s->truth;
    const char *complaint = NULL;
    for (uint32_t i = 0; i < truth->object_count && !complaint; i++) {
        const truth_verdict *verdict = &truth->verdicts[(size_t)row * truth->object_count + i];
        ration *from = ration_of(t, verdict, truth->frames[row], i);
        if (from && takes_next(from)) complaint = settle_object(s, t, row, i, from == &t->agreed);
    }
    leave_frame(s);
    return complaint;
}

const char *settle_result(settle *s, const vis_result *result, settle_limits limits,
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
    share_out(s, &t, limits);
    progress_begin("settling", t.hidden.share + t.missed.share + t.agreed.share);
    const char *complaint = NULL;
    for (uint32_t row = 0; row < truth->frame_count && !complaint; row++)
        complaint = settle_row(s, &t, row);
    progress_end();
    if (complaint) truth_free(settled);
    return complaint;
}
