#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# hard.sh PROGRAM: what `occlude-bench hard` prints, writes and refuses.
set -eu
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail()
{
    echo "hard.sh: $1" >&2
    exit 1
}

# status WANTED ARGUMENT...: runs, and demands that exit status.
status()
{
    wanted=$1
    shift
    got=0
    "$program" hard "$@" >"$folder/out" 2>"$folder/err" || got=$?
    [ "$got" -eq "$wanted" ] || fail "exit status $got, not $wanted: $*"
}

# Columns: family worlds verdicts hidden seen outside false_hidden missed % generous exact%
sum_of()
{
    awk -v column="$1" '$2 ~ /^[0-9]+$/ { sum += $column } END { print sum }' "$folder/out"
}

status 0 --family list
families=$(wc -l <"$folder/out")
names=$(awk '{ print $1 }' "$folder/out")

# Every family has a row, and the last line is the sum of the rows.
status 0 --worlds 14 --csv "$folder/table.csv"
for name in $names; do
    grep -q "^$name  *14 " "$folder/out" || fail "no row for $name"
done
expected="families=$families worlds=$(sum_of 2) verdicts=$(sum_of 3) false_hidden=0 missed=$(sum_of 8)"
tail -n 1 "$folder/out" | grep -q "^$expected missed_pct=" || fail "the sum is not $expected"
[ "$(sum_of 3)" -eq $(($(sum_of 4) + $(sum_of 5) + $(sum_of 6))) ] || fail "verdicts do not add up"
[ "$(sum_of 8)" -gt 0 ] || fail "nothing is missed, which cannot be"
cp "$folder/out" "$folder/all"

# The table in the file is the one that was printed.
[ "$(grep -c '^# [a-z_]*=' "$folder/table.csv")" -ge 9 ] || fail "no head in the table"
sed -n '/^family,/,$p' "$folder/table.csv" | awk -F, 'NR > 1 { print $1, $2, $3, $4, $5, $6, $7, $8, $10 }' \
    >"$folder/file"
awk '$2 ~ /^[0-9]+$/ { print $1, $2, $3, $4, $5, $6, $7, $8, $10 }' "$folder/all" >"$folder/printed"
cmp "$folder/file" "$folder/printed" || fail "file and print differ"

# Workers and backends change nothing; methods do.
for arguments in "--threads 1" "--threads 3" "--backend openmp --threads 2"; do
    # shellcheck disable=SC2086
    status 0 --worlds 14 $arguments
    cmp "$folder/out" "$folder/all" || fail "$arguments has another answer"
done
status 0 --worlds 14 --method frustum
[ "$(sum_of 8)" -eq "$(sum_of 4)" ] || fail "frustum hides something"
status 0 --worlds 14 --min-area 0.1
[ "$(sum_of 8)" -gt "$(awk '$2 ~ /^[0-9]+$/ { s += $8 } END { print s }' "$folder/all")" ] ||
    fail "large occluders alone do not miss more"

# A world at a place of its own, as a scene file that the program reads.
status 0 --family needles --scale 1 --offset 0 --seed 6 --out "$folder/world.obs"
objects=$(sum_of 3)
"$program" cull "$folder/world.obs" >"$folder/cull" || fail "the scene file cannot be culled"
read_back=$(sed -n 's/.* objects=\([0-9]*\) .*/\1/p' "$folder/cull" | tail -n 1)
[ "$read_back" -eq $((objects + 1)) ] || fail "$read_back objects in the file, not $objects and a point"

status 2 --family nonsense
status 2 --scale 1e9
status 2 --offset 2e7
status 2 --seed -1
status 2 --out "$folder/no.obs"
status 2 --method thesis
status 1 --worlds 1 --csv "$folder/none/table.csv"
