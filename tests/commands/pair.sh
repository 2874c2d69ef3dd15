#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh pair.sh PROGRAM BENCH: BENCH/pair.sh and BENCH/knobs.sh measure what they say, in the order given.
set -eu
program=$1 bench=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail()
{
    echo "$1"
    cat "$work/table.md"
    exit 1
}

# cell ROW COLUMN: of the table.
cell()
{
    sed -n "$(($1 + 2))p" "$work/table.md" | awk -F'|' -v column="$2" '{ gsub(/ /, "", $(column + 1)); print $(column + 1) }'
}

"$program" scene city 300 2 --out "$work/city_300.obs" >/dev/null
mkdir "$work/truth"
"$program" truth "$work/city_300.obs" --out "$work/truth/city_300-0123456789abcdef.tru" --size 512x288 >/dev/null

ROUNDS=2 sh "$bench/pair.sh" "$work/city_300.obs" "$work/truth/city_300-0123456789abcdef.tru" \
    "$program --repeat 1" "$program --repeat 1 --method frustum" "$program --repeat 1" >"$work/table.md"
[ "$(wc -l <"$work/table.md")" -eq 5 ] || fail "not a row for each setting"
[ "$(cell 1 1) $(cell 2 1)" = '--repeat1 --repeat1--methodfrustum' ] || fail "other names"
[ "$(cell 1 3)" = 1.00 ] || fail "the first is not its own measure"
for row in 1 2 3; do
    [ "$(cell $row 6)" = 0 ] || fail "false-hidden objects"
    awk -v ms="$(cell $row 2)" -v slowest="$(cell $row 4)" 'BEGIN { exit !(ms > 0 && slowest >= ms) }' || fail "no times"
done
awk -v a="$(cell 1 2)" -v b="$(cell 2 2)" -v ratio="$(cell 2 3)" \
    'BEGIN { off = b / a - ratio; exit !(off < 0.01 && off > -0.01) }' || fail "another ratio"
[ "$(cell 1 5)" = "$(cell 3 5)" ] || fail "one setting misses now this and now that"
awk -v a="$(cell 1 5)" -v b="$(cell 2 5)" 'BEGIN { exit !(a < b) }' || fail "the frustum alone misses no more"

ROUNDS=1 sh "$bench/knobs.sh" "$program" "$work" "$work/truth" city_300 >"$work/table.md"
grep -q '^| default | [0-9.]* | 1.00 | [0-9.]* | [0-9.]* | 0 |$' "$work/table.md" || fail "no default"
grep -q '^| --preset fast | ' "$work/table.md" || fail "no presets"
if grep '^|.*| *|' "$work/table.md"; then fail "empty cells"; fi
