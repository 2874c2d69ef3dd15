// SPDX-License-Identifier: Apache-2.0
/// @file
/// Command lines: `--name value` options and plain words, in any order.
#ifndef OCC_BENCH_OPTIONS_H
#define OCC_BENCH_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

/// What an option's value is, and what `value` of its entry points to.
typedef enum options_kind {
    OPTIONS_FLAG,  ///< No value; a bool that becomes true.
    OPTIONS_TEXT,  ///< A const char *, into argv.
    OPTIONS_COUNT, ///< A uint32_t, at least 1.
    OPTIONS_MOST,  ///< A uint32_t, 0 included: the most that there may be.
    OPTIONS_REAL   ///< A double, finite and not negative.
} options_kind;

/// An option. An array of them ends with a NULL name.
typedef struct options_entry {
    const char *name; ///< With its dashes.
    options_kind kind;
    void *value;
} options_entry;

enum { OPTIONS_BAD = -1, OPTIONS_HELP = -2 };

/// Fills the options' values and `words`; argv[0] is the subcommand's name. Returns the number of
/// words, OPTIONS_HELP when --help or -h is among the arguments, or OPTIONS_BAD after one line on
/// standard error.
int options_parse(int argc, char **argv, const options_entry *entries, char **words, int capacity);

/// The same for a subcommand whose one word is a scene file. Returns 0, OPTIONS_HELP, or 2 after a
/// complaint.
int options_parse_scene(int argc, char **argv, const options_entry *entries, const char **scene);

/// One line about bad usage on standard error. Returns the exit status 2.
int options_complain(const char *command, const char *what);

/// A whole decimal number from `low` to `high`, and nothing else in the text.
bool options_number(const char *text, uint64_t low, uint64_t high, uint64_t *value);

/// Ascending numbers below `limit`, parted by commas, such as 0,20,40. `list` has room for `limit`
/// of them.
bool options_ascending(const char *text, uint32_t limit, uint32_t *list, uint32_t *count);

/// The sides of a picture or viewport.
typedef struct options_extent {
    uint32_t width, height;
} options_extent;

/// Width and height as 1600x672, and nothing else in the text. Both must be at least `least`'s and
/// at most `most`. Leaves `extent` alone if they are not.
bool options_size(const char *text, options_extent least, uint32_t most, options_extent *extent);

#endif
