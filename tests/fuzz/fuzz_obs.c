// SPDX-License-Identifier: Apache-2.0
// Bytes as a scene file: reading them never goes wrong, and what can be read is written back as it
// was.
#define _POSIX_C_SOURCE 200809L
#include "bytes.h"

#include "obs.h"

#include <unistd.h>

// A file of this process alone.
static const char *path_of_copy(void)
{
    static char path[512];
    if (!path[0]) {
        const char *folder = getenv("TMPDIR");
        int length = snprintf(path, sizeof path, "%s/occlude-fuzz-%ld.obs",
                              folder ? folder : "/tmp", (long)getpid());
        FUZZ_CHECK(length > 0 && (size_t)length < sizeof path);
    }
    return path;
}

// A file of version 2 without sheets becomes one of version 1: its header says so, and that there
// are none is left out.
static void check_copy(const obs_scene *scene, const uint8_t *data, size_t size)
{
    const char *path = path_of_copy();
    FUZZ_CHECK(obs_write(path, scene));
    size_t written = 0, skipped = 0, kept = 0;
    uint8_t *copy = obs_read_bytes(path, &written);
    FUZZ_CHECK(copy && written >= 16);
    if (scene->sheet_count == 0 && data[3] == '2') {
        FUZZ_CHECK(!memcmp(copy, "OBS1", 4) && !memcmp(copy + 4, data + 4, 8));
        kept = 12;
        skipped = 4;
    }
    FUZZ_CHECK(written + skipped == size);
    FUZZ_CHECK(!memcmp(copy + kept, data + kept + skipped, written - kept));
    free(copy);
    FUZZ_CHECK(!remove(path));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    obs_scene scene;
    if (obs_parse(data, size, NULL, &scene)) {
        for (uint32_t i = 0; i < scene.occluder_count; i++)
            FUZZ_CHECK(scene.occluders[i].owner < scene.object_count);
        for (uint32_t i = 0; i < scene.sheet_count; i++) {
            const obs_sheet *from = &scene.sheets[i];
            FUZZ_CHECK(from->owner < scene.object_count);
            FUZZ_CHECK(from->sheet.corner_count - 3 <= OCC_SHEET_CORNERS - 3);
            FUZZ_CHECK(from->sheet.sides == OCC_SIDES_BOTH || from->sheet.sides == OCC_SIDES_FRONT);
        }
        check_copy(&scene, data, size);
    } else {
        FUZZ_CHECK(!scene.objects && !scene.occluders && !scene.sheets && !scene.frames);
        FUZZ_CHECK(!scene.object_count && !obs_occluder_total(&scene) && !scene.frame_count);
    }
    obs_free(&scene);
    return 0;
}
