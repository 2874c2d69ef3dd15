#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/run.sh: from a bare Debian 12 (as root or with sudo) to measured results. Installs what is
# missing, builds, measures the named scenes and the thesis's experiment, and leaves tables, CSV files,
# a plot and pictures in build/bench-results. Real models are measured too where ../shared/scenes has them.
set -eu
cd "$(dirname "$0")/.."
. bench/setup.sh
need_packages docs/debian-packages.txt

results=build/bench-results
scenes=build/bench-scenes
models=../shared/scenes
started=$(date +%s)
mkdir -p "$results" "$scenes"
rm -f "$results"/*.csv "$results"/*.txt "$results"/*.png "$results"/*.vis

echo "Building..."
if ! { cmake --preset default && cmake --build --preset default --target occlude-bench; } >"$results/build.log" 2>&1; then
    tail -n 30 "$results/build.log"
    exit 1
fi
bench=build/default/bench/occlude-bench
summaries=$results/summaries.txt
: >"$summaries"

# measure SCENE METHOD BACKEND [OPTION...]: a run whose summary line and CSV are kept.
measure() {
    measure_scene=$1 measure_method=$2 measure_backend=$3
    shift 3
    measure_stem=$results/$measure_scene-$measure_method-$measure_backend
    if [ "$measure_backend" = openmp1 ]; then set -- --threads 1 "$@"; fi # one thread
    "$bench" cull "$scenes/$measure_scene.obs" --method "$measure_method" --backend "${measure_backend%1}" \
        --csv "$measure_stem.csv" "$@" >"$measure_stem.txt" || return 1
    { tail -n 1 "$measure_stem.txt" | tr '\n' ' '
      sed -n 's/^memory.* \([0-9.]*\) bytes per object$/bytes_per_object=\1/p' "$measure_stem.txt"
    } >>"$summaries"
    rm "$measure_stem.txt"
}

# verdicts SCENE METHOD [OPTION...]: the method on every backend; their masks must be the same bits.
verdicts() {
    verdicts_scene=$1 verdicts_method=$2
    shift 2
    for verdicts_backend in plain openmp1 openmp $opencl; do
        verdicts_file=$scenes/$verdicts_scene-$verdicts_method-$verdicts_backend.vis
        measure "$verdicts_scene" "$verdicts_method" "$verdicts_backend" --out "$verdicts_file" "$@"
        if ! cmp -s "$verdicts_file" "$scenes/$verdicts_scene-$verdicts_method-plain.vis"; then
            echo "$verdicts_scene, $verdicts_method: $verdicts_backend differs from plain" >&2
            exit 1
        fi
    done
}

# table PATTERN: the summary lines of the scenes that match, in columns. `culled` is the share of the
# objects in the frustum that the method reports hidden.
table() {
    printf '%-17s %-9s %-7s %7s %6s %9s %11s %9s %8s %10s %8s %8s %8s %8s %9s\n' scene method backend threads \
        frames objects in_frustum visible culled_% median_ms p99_ms max_ms walk_ms test_ms B/object
    grep "^scene=$1" "$summaries" | awk '{
        for (i = 1; i <= NF; i++) { split($i, pair, "="); v[pair[1]] = pair[2] }
        culled = v["in_frustum"] > 0 ? 100 * (1 - v["visible"] / v["in_frustum"]) : 0
        printf "%-17s %-9s %-7s %7s %6s %9s %11s %9s %8.1f %10.3f %8.3f %8.3f %8.3f %8.3f %9s\n", v["scene"],
            v["method"], v["backend"], v["threads"], v["frames"], v["objects"], v["in_frustum"], v["visible"], culled,
            v["median_ms"], v["p99_ms"], v["max_ms"], v["walk_ms"], v["test_ms"], v["bytes_per_object"]
    }'
}

picture() { # picture SCENE FRAME
    "$bench" picture "$scenes/$1.obs" --frame "$2" --out "$results/$1-frame$2.png" >/dev/null
}

"$bench" scene city 40 2 --out "$scenes/probe.obs" >/dev/null
opencl=opencl
if ! "$bench" cull "$scenes/probe.obs" --backend opencl --repeat 1 >/dev/null 2>"$results/opencl.log"; then
    opencl=
    echo "No OpenCL device here: the opencl backend is left out ($results/opencl.log)."
fi

echo "Measuring the city..."
for count in 1000 10000 100000 1000000; do
    "$bench" scene city $count 2 --out "$scenes/city_$count.obs" >/dev/null
    measure city_$count frustum plain
    verdicts city_$count fused
    [ $count = 1000 ] || continue
    verdicts city_$count pairwise
    measure city_$count thesis plain --every 10 --repeat 1
done

echo "Measuring the other scenes..."
for count in 1000 10000 100000; do
    "$bench" scene seedscene $count 1 --out "$scenes/seedscene_$count.obs" >/dev/null
    measure seedscene_$count frustum plain
    verdicts seedscene_$count fused --repeat 21
    [ $count = 1000 ] || continue
    verdicts seedscene_$count pairwise
    measure seedscene_$count thesis plain --repeat 3
done
"$bench" scene forest 100000 3 --out "$scenes/forest_100000.obs" >/dev/null
"$bench" scene soup 100000 4 --out "$scenes/soup_100000.obs" >/dev/null
"$bench" scene interior 10000 5 --out "$scenes/interior_10000.obs" >/dev/null
for scene in forest_100000 soup_100000 interior_10000; do
    measure $scene frustum plain
    verdicts $scene fused
done
for scene in city_10000 interior_10000 forest_100000; do picture $scene 20; done
picture seedscene_1000 0

for model in alphacorp.obj institute.obj sponza.ply; do
    name=${model%.*}
    if [ ! -f "$models/$model" ]; then
        echo "$model: skipped, there is no $models/$model"
        continue
    fi
    echo "Measuring $model..."
    "$bench" convert "$models/$model" --out "$scenes/$name.obs" >"$results/$name-convert.txt"
    measure "$name" frustum plain
    verdicts "$name" fused
    verdicts "$name" pairwise --repeat 1
    measure "$name" thesis plain --every 20 --repeat 1 --force
    picture "$name" 20
    "$bench" image "$scenes/$name.obs" --model "$models/$model" --every 10 --csv "$results/$name-image.csv" \
        --pictures "$results/$name" >"$results/$name-image.txt"
    tail -n 1 "$results/$name-image.txt"
done

echo "The thesis's experiment..."
"$bench" seed --plot "$results/seed.png" --csv "$results/seed.csv" >"$results/seed.txt"
cat "$results/seed.txt"

echo "Speed against error..."
"$bench" error --quick --out "$results/error" >"$results/error.txt"
sed -n '/^scene /,$p' "$results/error.txt"

table city_ >"$results/city.txt"
table '' >"$results/all.txt"
echo
cat "$results/all.txt"
echo
echo "On every scene above the masks of plain, openmp${opencl:+, opencl} were compared: the same bits."
echo "Results are in $results: seed.txt, seed.csv, seed.png, city.txt, all.txt, a CSV for each run, pictures,"
echo "and error/error.md, tables and plots of speed against error."
echo "$(($(date +%s) - started)) seconds after the installs."
