// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int options_complain(const char *command, const char *what)
{
    fprintf(stderr, "occlude-bench %s: %s (see occlude-bench %s --help)\n", command, what, command);
    return 2;
}

int options_parse_scene(int argc, char **argv, const options_entry *entries, const char **scene)
{
    char *words[1];
    int count = options_parse(argc, argv, entries, words, 1);
    if (count == OPTIONS_HELP) return OPTIONS_HELP;
    if (count == OPTIONS_BAD) return 2;
    if (count != 1) return options_complain(argv[0], "expected a scene file");
    *scene = words[0];
    return 0;
}

static int complain_about(const char *command, const char *argument, const char *what)
{
    char line[512];
    snprintf(line, sizeof line, "%.200s: %s", argument, what);
    options_complain(command, line);
    return OPTIONS_BAD;
}

bool options_number(const char *text, uint64_t low, uint64_t high, uint64_t *value)
{
    if (*text < '0' || *text > '9') return false; // strtoull() takes signs and spaces
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    *value = number;
    return errno == 0 && *end == '\0' && number >= low && number <= high;
}

bool options_ascending(const char *text, uint32_t limit, uint32_t *list, uint32_t *count)
{
    *count = 0;
    uint64_t next = 0;
    for (;;) {
        char number[16];
        size_t length = strcspn(text, ",");
        uint64_t value;
        if (length >= sizeof number || limit == 0) return false;
        memcpy(number, text, length);
        number[length] = '\0';
        if (!options_number(number, next, limit - 1, &value)) return false;
        list[(*count)++] = (uint32_t)value;
        next = value + 1;
        text += length;
        if (*text == '\0') return true;
        text++;
    }
}

bool options_size(const char *text, options_extent least, uint32_t most, options_extent *extent)
{
    char copy[32]; // what is longer has too many digits
    size_t length = strlen(text);
    if (length >= sizeof copy) return false;
    memcpy(copy, text, length + 1);
    char *times = strchr(copy, 'x');
    if (!times) return false;
    *times = '\0';
    uint64_t width, height;
    if (!options_number(copy, least.width, most, &width) ||
        !options_number(times + 1, least.height, most, &height))
        return false;
    *extent = (options_extent){(uint32_t)width, (uint32_t)height};
    return true;
}

static bool parse_real(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*value) && *value >= 0;
}

// Returns a complaint, or NULL.
static const char *set_value(const options_entry *entry, char *text)
{
    uint64_t number;
    if (entry->kind == OPTIONS_TEXT) {
        *(const char **)entry->value = text;
    } else if (entry->kind == OPTIONS_COUNT) {
        if (!options_number(text, 1, UINT32_MAX, &number)) return "expected a number from 1";
        *(uint32_t *)entry->value = (uint32_t)number;
    } else if (entry->kind == OPTIONS_MOST) {
        if (!options_number(text, 0, UINT32_MAX, &number)) return "expected a number";
        *(uint32_t *)entry->value = (uint32_t)number;
    } else if (!parse_real(text, entry->value)) {
        return "expected a number that is not negative";
    }
    return NULL;
}

static const options_entry *find_option(const options_entry *entries, const char *name)
{
    for (; entries->name; entries++)
        if (strcmp(entries->name, name) == 0) return entries;
    return NULL;
}

static bool asks_for_help(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) return true;
    return false;
}

int options_parse(int argc, char **argv, const options_entry *entries, char **words, int capacity)
{
    if (asks_for_help(argc, argv)) return OPTIONS_HELP;
    int count = 0;
    for (int i = 1; i < argc; i++) {
        if (argv[i][0] != '-') {
            if (count == capacity) return complain_about(argv[0], argv[i], "one word too many");
            words[count++] = argv[i];
            continue;
        }
        const options_entry *entry = find_option(entries, argv[i]);
        if (!entry) return complain_about(argv[0], argv[i], "no such option");
        if (entry->kind == OPTIONS_FLAG) {
            *(bool *)entry->value = true;
            continue;
        }
        if (i + 1 == argc) return complain_about(argv[0], argv[i], "expected a value after it");
        const char *complaint = set_value(entry, argv[++i]);
        if (complaint) return complain_about(argv[0], argv[i - 1], complaint);
    }
    return count;
}
