// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "compare_count.h"
#include "options.h"

#include <stdio.h>

static const char compare_usage[] =
    "usage: occlude-bench compare T.tru R.vis\n"
    "\n"
    "Judges the verdicts of `cull --out R.vis` by what `truth` found. The last line printed:\n"
    "\n"
    "  in_frustum, visible  in truth, means over the frames that T.tru has\n"
    "  false_hidden         objects that can be seen but are reported hidden, summed over frames\n"
    "  largest_px           most samples at which one of those can be seen; 0 if rays alone did\n"
    "  missed, missed_pct   objects in the frustum that no sample and no ray could see, but are\n"
    "                       reported visible: summed, and in per cent of all such objects\n"
    "\n"
    "Up to ten false-hidden objects are named on standard error. Exit status 3 if there is one.\n"
    "\n"
    "Example: occlude-bench compare city.tru city.vis\n";

enum { NAMED_AT_MOST = 10, STATUS_FALSE_HIDDEN = 3 };

static void name_object(void *user_data, uint32_t frame, uint32_t object,
                        const truth_verdict *verdict)
{
    uint32_t *named = user_data;
    if ((*named)++ >= NAMED_AT_MOST) return;
    fprintf(stderr, "occlude-bench: frame %u: object %u is reported hidden: %u samples%s", frame,
            object, verdict->samples, verdict->samples > 0 ? "" : " and");
    if (verdict->samples == 0) fprintf(stderr, " %u rays", verdict->rays);
    fputs(" see it\n", stderr);
}

static int judge(const truth_result *truth, const vis_result *result)
{
    uint32_t named = 0;
    compare_sums sums = compare_count(truth, result, name_object, &named);
    double frames = truth->frame_count;
    printf("frames=%u in_frustum=%.1f visible=%.1f false_hidden=%llu largest_px=%u missed=%llu "
           "missed_pct=%.3f\n",
           truth->frame_count, (double)sums.in_frustum / frames, (double)sums.visible / frames,
           (unsigned long long)sums.false_hidden, sums.largest_px, (unsigned long long)sums.missed,
           compare_missed_percent(&sums));
    return sums.false_hidden > 0 ? STATUS_FALSE_HIDDEN : 0;
}

int bench_compare(int argc, char **argv)
{
    static const options_entry entries[] = {{NULL, OPTIONS_FLAG, NULL}};
    char *words[2];
    int count = options_parse(argc, argv, entries, words, 2);
    if (count == OPTIONS_HELP) return fputs(compare_usage, stdout) < 0;
    if (count == OPTIONS_BAD) return 2;
    if (count != 2) return options_complain(argv[0], "expected a truth file and a result file");
    truth_result truth;
    vis_result result;
    if (!truth_read(words[0], &truth)) return 1;
    int status = 1;
    if (vis_read(words[1], &result)) {
        const char *complaint = compare_check(&truth, &result);
        if (complaint)
            fprintf(stderr, "occlude-bench: %s and %s do not go together: %s\n", words[0], words[1],
                    complaint);
        else
            status = judge(&truth, &result);
    }
    truth_free(&truth);
    vis_free(&result);
    return status;
}
