// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "compare_count.h"
#include "options.h"
#ifdef OCC_BENCH_JUDGE
#include "settle.h"
#endif

#include <stdio.h>

static const char compare_usage[] =
    "usage: occlude-bench compare T.tru R.vis [--scene F.obs [--settle N] [--hidden N]]\n"
    "\n"
    "Judges the verdicts of `cull --out R.vis` by what `truth` found. The last line printed:\n"
    "\n"
    "  in_frustum, visible  in truth, means over the frames that T.tru has\n"
    "  false_hidden         objects that can be seen but are reported hidden, summed over frames\n"
    "  largest_px           most samples at which one of those can be seen; 0 if rays alone did\n"
    "  missed, missed_pct   objects in the frustum that no sample and no ray could see, but are\n"
    "                       reported visible: summed, and in per cent of all such objects\n"
    "\n"
    "  --scene F.obs  the scene of both: puts to the exact judge what they do not agree on. A "
    "line\n"
    "                 before the last says what came of it, and the last one counts as it says\n"
    "  --settle N     up to so many objects, those reported hidden first (default 10000)\n"
    "  --hidden N     and up to so many that both take for hidden: one more line (default none)\n"
    "\n"
    "Up to ten false-hidden objects are named on standard error. Exit status 3 if there is one.\n"
    "\n"
    "Example: occlude-bench compare city.tru city.vis --scene city.obs\n";

enum { NAMED_AT_MOST = 10, STATUS_FALSE_HIDDEN = 3 };

typedef struct compare_arguments {
    const char *truth, *result, *scene;
    uint32_t disagreed, agreed; // how many to settle; 0: not given
} compare_arguments;

// Whom to name, and what the judge said of them, if there is one.
typedef struct compare_namer {
    uint32_t named;
    const struct settle *settled;
} compare_namer;

static const char *judges_word(const compare_namer *namer, uint32_t frame, uint32_t object)
{
#ifdef OCC_BENCH_JUDGE
    if (namer->settled) switch (settle_look_up(namer->settled, frame, object)) {
        case SETTLE_VISIBLE:
            return ", and so does the judge";
        case SETTLE_HIDDEN:
            return ", but the judge does not";
        case SETTLE_DOUBTFUL:
            return ", and the judge is in doubt";
        case SETTLE_UNASKED:
            return ", and the judge was not asked";
        }
#else
    (void)namer, (void)frame, (void)object;
#endif
    return "";
}

static void name_object(void *user_data, uint32_t frame, uint32_t object,
                        const truth_verdict *verdict)
{
    compare_namer *namer = user_data;
    if (namer->named++ >= NAMED_AT_MOST) return;
    fprintf(stderr, "occlude-bench: frame %u: object %u is reported hidden: %u samples%s", frame,
            object, verdict->samples, verdict->samples > 0 ? "" : " and");
    if (verdict->samples == 0) fprintf(stderr, " %u rays", verdict->rays);
    fprintf(stderr, " see it%s\n", judges_word(namer, frame, object));
}

static int print_sums(const truth_result *truth, const compare_sums *sums)
{
    double frames = truth->frame_count;
    printf("frames=%u in_frustum=%.1f visible=%.1f false_hidden=%llu largest_px=%u missed=%llu "
           "missed_pct=%.3f\n",
           truth->frame_count, (double)sums->in_frustum / frames, (double)sums->visible / frames,
           (unsigned long long)sums->false_hidden, sums->largest_px,
           (unsigned long long)sums->missed, compare_missed_percent(sums));
    return sums->false_hidden > 0 ? STATUS_FALSE_HIDDEN : 0;
}

static int judge_by_samples(const truth_result *truth, const vis_result *result)
{
    compare_namer namer = {0};
    compare_sums sums = compare_count(truth, result, name_object, &namer);
    return print_sums(truth, &sums);
}

static int refuse_pair(const char *one, const char *other, const char *complaint)
{
    fprintf(stderr, "occlude-bench: %s and %s do not go together: %s\n", one, other, complaint);
    return 1;
}

// --- with the judge ------------------------------------------------------------------------------

#ifdef OCC_BENCH_JUDGE
static void print_settled(const settle_sums *sums)
{
    if (sums->agreed_judged > 0)
        printf("hidden_judged=%llu hidden_seen=%llu hidden_doubtful=%llu "
               "hidden_unjudged=%llu\n",
               (unsigned long long)sums->agreed_judged, (unsigned long long)sums->agreed_seen,
               (unsigned long long)sums->agreed_doubtful,
               (unsigned long long)sums->agreed_unjudged);
    printf("settled=%llu judged_visible=%llu judged_hidden=%llu unsettled=%llu "
           "false_confirmed=%llu false_refuted=%llu\n",
           (unsigned long long)sums->settled, (unsigned long long)sums->judged_visible,
           (unsigned long long)sums->judged_hidden, (unsigned long long)sums->unsettled,
           (unsigned long long)sums->false_confirmed, (unsigned long long)sums->false_refuted);
}

static int judge_by_judge(const compare_arguments *arguments, const obs_scene *scene,
                          const truth_result *truth, const vis_result *result)
{
    settle_sums sums;
    truth_result settled;
    const char *complaint = settle_check(scene, truth);
    if (complaint) return refuse_pair(arguments->truth, arguments->scene, complaint);
    settle *s = settle_create(scene, truth);
    const settle_limits limits = {arguments->disagreed ? arguments->disagreed : SETTLE_DEFAULT,
                                  arguments->agreed};
    complaint = s ? settle_result(s, result, limits, &settled, &sums) : "not enough memory";
    int status = 1;
    if (complaint) {
        fprintf(stderr, "occlude-bench: %s: %s\n", arguments->scene, complaint);
    } else {
        compare_namer namer = {.settled = s};
        compare_count(truth, result, name_object, &namer);
        compare_sums counts = compare_count(&settled, result, NULL, NULL);
        print_settled(&sums);
        status = print_sums(&settled, &counts);
        truth_free(&settled);
    }
    settle_destroy(s);
    return status;
}

static int judge_with_scene(const compare_arguments *arguments, const truth_result *truth,
                            const vis_result *result)
{
    obs_scene scene;
    if (!obs_read(arguments->scene, &scene)) return 1;
    int status = judge_by_judge(arguments, &scene, truth, result);
    obs_free(&scene);
    return status;
}
#else
static int judge_with_scene(const compare_arguments *arguments, const truth_result *truth,
                            const vis_result *result)
{
    (void)arguments, (void)truth, (void)result;
    fputs("occlude-bench compare: built without GMP, which --scene needs\n", stderr);
    return 1;
}
#endif

// --- the command ---------------------------------------------------------------------------------

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_compare(int argc, char **argv, compare_arguments *arguments)
{
    *arguments = (compare_arguments){0};
    const options_entry entries[] = {{"--scene", OPTIONS_TEXT, &arguments->scene},
                                     {"--settle", OPTIONS_COUNT, &arguments->disagreed},
                                     {"--hidden", OPTIONS_COUNT, &arguments->agreed},
                                     {NULL, OPTIONS_FLAG, NULL}};
    char *words[2];
    int count = options_parse(argc, argv, entries, words, 2);
    if (count == OPTIONS_HELP) return OPTIONS_HELP;
    if (count == OPTIONS_BAD) return 2;
    if (count != 2) return options_complain(argv[0], "expected a truth file and a result file");
    if ((arguments->disagreed || arguments->agreed) && !arguments->scene)
        return options_complain(argv[0], "expected --scene F.obs beside --settle and --hidden");
    arguments->truth = words[0];
    arguments->result = words[1];
    return 0;
}

int bench_compare(int argc, char **argv)
{
    compare_arguments arguments;
    int status = parse_compare(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(compare_usage, stdout) < 0;
    if (status != 0) return status;
    truth_result truth;
    vis_result result;
    if (!truth_read(arguments.truth, &truth)) return 1;
    status = 1;
    if (vis_read(arguments.result, &result)) {
        const char *complaint = compare_check(&truth, &result);
        if (complaint)
            status = refuse_pair(arguments.truth, arguments.result, complaint);
        else if (arguments.scene)
            status = judge_with_scene(&arguments, &truth, &result);
        else
            status = judge_by_samples(&truth, &result);
    }
    truth_free(&truth);
    vis_free(&result);
    return status;
}
