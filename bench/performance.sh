#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/performance.sh [SCENES]: the figures of docs/performance.md anew, into docs/results. SCENES is a folder of
# scene files (default build/scenes); what it lacks the generators make, there for the knobs. Takes about ten minutes on
# two cores, and a few more the first time, for the truths. Let nothing else run meanwhile.
set -eu
cd "$(dirname "$0")/.."
scenes=${1:-build/scenes}
out=build/performance
program=build/default/bench/occlude-bench
mkdir -p "$scenes" "$out"

cmake --preset default >"$out/build.log"
cmake --build --preset default --target occlude-bench >>"$out/build.log"
for lanes in avx2 plain; do # not on every machine
    cmake --build --preset default --target occlude-bench-$lanes >>"$out/build.log" 2>&1 || rm -f "$program-$lanes"
done

for scene in "seedscene 1000 1" "seedscene 10000 1" "seedscene 100000 1" "city 1000 2" "city 10000 2" \
    "city 100000 2" "city 1000000 2" "forest 100000 3" "soup 100000 4" "interior 10000 5"; do
    # shellcheck disable=SC2086 # three words
    set -- $scene
    [ -f "$scenes/$1_$2.obs" ] || "$program" scene "$1" "$2" "$3" --out "$scenes/$1_$2.obs"
done

"$program" error --targets --scenes "$scenes" --out "$out"
cp "$out/targets.md" "$out/targets.csv" docs/results/
sh bench/knobs.sh "$program" "$scenes" "$out/truth" >"$out/knobs.md"
cp "$out/knobs.md" docs/results/
sh bench/instructions.sh "$program" docs/results/instructions.md
"$program" seed --csv "$out/seed.csv" --plot "$out/seed.png" >"$out/seed.txt"
cp "$out/seed.csv" docs/results/
cat "$out/seed.txt"
