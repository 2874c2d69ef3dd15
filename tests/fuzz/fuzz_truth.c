// SPDX-License-Identifier: Apache-2.0
// Bytes as a truth file, or as a scene to be sampled: neither ever goes wrong, whatever the
// numbers.
#include "bytes.h"

#include "truth_sample.h"

enum { WIDTH = 24, HEIGHT = 16 };

static void check_verdict(const truth_verdict *verdict, uint64_t samples)
{
    FUZZ_CHECK(verdict->samples <= samples);
    FUZZ_CHECK(verdict->flags <= TRUTH_IN_FRUSTUM);
    FUZZ_CHECK(verdict->flags || !truth_is_visible(verdict));
}

static void read_truth(const uint8_t *data, size_t size)
{
    static const truth_result nothing;
    truth_result truth;
    if (truth_parse(data, size, NULL, &truth)) {
        for (size_t i = 0; i < (size_t)truth.object_count * truth.frame_count; i++)
            check_verdict(&truth.verdicts[i], (uint64_t)truth.width * truth.height);
    } else {
        FUZZ_CHECK(!memcmp(&truth, &nothing, sizeof truth));
    }
    truth_free(&truth);
}

static void sample_scene(const uint8_t *data, size_t size)
{
    obs_scene scene;
    truth_verdict *verdicts;
    if (!obs_parse(data, size, NULL, &scene)) return;
    verdicts = calloc((size_t)scene.object_count + 1, sizeof *verdicts);
    FUZZ_CHECK(verdicts);
    for (uint32_t f = 0; f < scene.frame_count && f < 2; f++) {
        if (truth_sample(&scene, f, WIDTH, HEIGHT, verdicts)) continue;
        for (uint32_t i = 0; i < scene.object_count; i++)
            check_verdict(&verdicts[i], (uint64_t)WIDTH * HEIGHT);
    }
    free(verdicts);
    obs_free(&scene);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_truth(data, size);
    sample_scene(data, size);
    return 0;
}
