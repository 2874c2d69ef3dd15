#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/pair.sh SCENE.obs TRUTH.tru 'PROGRAM [OPTION...]'...: settings, or the programs of several commits, against
# each other: `PROGRAM cull SCENE.obs` with its options, one after the other and that in rounds, so that a slow phase
# of the machine meets them all. Prints a row for each: the median over the rounds of its median frame, that over the
# first one's, its slowest frame, and its errors by the truth. ROUNDS=N in the environment: so many rounds (default 7).
set -eu
scene=$1 truth=$2
shift 2
rounds=${ROUNDS:-7}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# median FILE: of its numbers.
median() {
    sort -g "$1" | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int((NR + 2) / 2)]) / 2 }'
}

round=0
while [ "$round" -lt "$rounds" ]; do
    number=0
    for setting in "$@"; do
        number=$((number + 1))
        program=${setting%% *}
        options=
        case $setting in *' '*) options=${setting#* } ;; esac
        # The options are split into words on purpose; later ones win over --threads 1.
        # shellcheck disable=SC2086
        "$program" cull "$scene" --method fused --threads 1 --out "$work/$number.vis" $options >"$work/log"
        for key in median_ms max_ms; do
            sed -n "s/^scene=.* $key=\([0-9.]*\).*/\1/p" "$work/log" >>"$work/$number.$key"
        done
    done
    round=$((round + 1))
done

echo '| setting | ms | times the first | slowest frame, ms | missed, % | false-hidden |'
echo '|---|---:|---:|---:|---:|---:|'
number=0
for setting in "$@"; do
    number=$((number + 1))
    # Whether the program of another commit wrote it or not, one program compares.
    "${1%% *}" compare "$truth" "$work/$number.vis" >"$work/log"
    errors=$(sed -n 's/^frames=.* false_hidden=\([0-9]*\) .* missed_pct=\([0-9.]*\).*/\2 | \1/p' "$work/log")
    ms=$(median "$work/$number.median_ms")
    ratio=$(echo "$ms $(median "$work/1.median_ms")" | awk '{ printf "%.2f", $1 / $2 }')
    # A program is named where it is not the first one, options where there are any.
    program=${setting%% *}
    name=
    if [ "$program" != "${1%% *}" ] || [ "$program" = "$setting" ]; then name="${program##*/} "; fi
    case $setting in *' '*) name="$name${setting#* } " ;; esac
    echo "| $name| $ms | $ratio | $(median "$work/$number.max_ms") | $errors |"
done
