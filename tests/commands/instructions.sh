#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh instructions.sh PROGRAM SCRIPT: bench/instructions.sh counts the same twice, counts occ_cull() alone, and
# writes what it prints.
set -eu
program=$1 script=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail()
{
    echo "$1"
    cat "$work/first.md"
    exit 1
}

sh "$script" "$program" "$work/first.md" city:1000:2:30 seedscene:300:1:1 >"$work/printed.md"
sh "$script" "$program" "$work/second.md" city:1000:2:30 seedscene:300:1:1 >/dev/null
cmp -s "$work/first.md" "$work/printed.md" || fail "what is written is not what is printed"
cmp -s "$work/first.md" "$work/second.md" || fail "counted otherwise the second time"
grep '^| [a-z]* [0-9]*, seed' "$work/first.md" >"$work/rows" || fail "no rows"
[ "$(wc -l <"$work/rows")" -eq 4 ] || fail "not a row for each scene and method"
grep -q '^| city 1000, seed 2 | fused | 2 | ' "$work/rows" || fail "no row for city, fused"
grep -q "^- city 1000: \`[a-z_]*\` [0-9]* %, " "$work/first.md" || fail "not where they go"
grep -q '^| seedscene 300, seed 1 | single | 1 | ' "$work/rows" || fail "no row for seedscene, single"
# Reading and building a scene would be tens of millions, nothing at all would be none.
awk -F'|' '$6 < 10000 || $6 > 5000000 { exit 1 }' "$work/rows" || fail "not what a frame takes"
