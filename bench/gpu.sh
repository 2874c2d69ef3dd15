#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/gpu.sh [RESULTS]: the tables of docs/opencl.md on the device of this machine, in one run: builds what it
# needs, makes the scenes, and prints a row for each. Takes what compilers and OpenCL loader there are; installs
# nothing. RESULTS (default build/gpu) receives what every command printed, and all of it in log.txt.
#   SIZES=small in the environment: nothing above a million objects.
#   HUGE=1: a hundred million objects too; takes 40 GiB of memory.
#   DEVICES=2: tables spread over so many sub-devices as well, where a device can be divided.
set -eu
cd "$(dirname "$0")/.."
results=${1:-build/gpu}
build=${BUILD:-build/gpu-build}
mkdir -p "$results"
rm -f "$results"/*.txt
cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release >"$results/configure.txt"
cmake --build "$build" --parallel --target occlude-bench >"$results/build.txt" 2>&1
bench=$build/bench/occlude-bench

# field NAME FILE: what NAME=... says in a summary line, the last one.
field() {
    tr ' ' '\n' <"$2" | sed -n "s/^$1=//p" | tail -n 1
}

# row NAME ARGUMENTS...: `occlude-bench gpu` with these arguments, as a row.
row() {
    name=$1
    shift
    if ! "$bench" gpu "$@" >"$results/$name.txt" 2>&1; then
        echo "| $name | failed: $(tail -n 1 "$results/$name.txt") |"
        return 0
    fi
    sed -n 's/^# driver=//p' "$results/$name.txt" >"$results/device.txt"
    tr ' ' '\n' <"$results/$name.txt" | sed -n 's/^\([a-z_0-9]*\)=\(.*\)$/\1 \2/p' | awk -v name="$name" '
        { v[$1] = $2 }
        END {
            kernels = v["blocks_ms"] + v["objects_ms"] + v["fusion_ms"]
            printf "| %s | %d | %.0f | %.0f | `%s` | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.0f | %.1f | %.1f | %.2f |\n",
                name, v["objects"], v["occluders"], v["visible"], v["mask"], v["frame_ms"], v["p99_ms"], v["walk_ms"],
                v["blocks_ms"], v["objects_ms"], v["fusion_ms"], kernels, v["copy_gbs"], v["pinned_gbs"], v["move_gbs"],
                v["device_bytes"] / 1e9
        }'
}

echo '| run | objects | occluders | visible | mask | frame ms | p99 | walk | blocks | objects | fusion | kernels | copy GB/s | pinned GB/s | moved GB/s | device GB |'
echo '|---|---:|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|'
row city_100000 city 100000 2 --every 3
row forest_100000 forest 100000 2 --every 3 --arrange
row city_1000000 city 1000000 2 --every 3
row city_1000000_strips city 1000000 2 --every 3 --strips 4
row city_1000000_strips8 city 1000000 2 --every 3 --strips 8
row city_1000000_arranged city 1000000 2 --every 3 --arrange --strips 4
row city_1000000_single city 1000000 2 --every 3 --method single --strips 4
row soup_100000 soup 100000 2 --every 3 --arrange
row soup_100000_strips soup 100000 2 --every 3 --arrange --strips 4
row city_1000000_moved city 1000000 2 --every 3 --move
if [ -n "${DEVICES:-}" ]; then
    row city_1000000_devices city 1000000 2 --every 3 --devices "$DEVICES"
fi
if [ "${SIZES:-}" != small ]; then
    row city_10000000 city 10000000 2 --every 3
    row city_10000000_strips city 10000000 2 --every 3 --strips 4
    row forest_10000000 forest 10000000 2 --every 3 --arrange
    row forest_10000000_strips forest 10000000 2 --every 3 --arrange --strips 4
fi
if [ -n "${HUGE:-}" ]; then
    row city_100000000 city 100000000 2 --every 6
fi
echo
echo "Device: $(cat "$results/device.txt")"
echo

# The octree walked on the host, the objects tested on the host or on the device: the same verdicts, byte for byte, and
# how long each takes. And what each misses, tables too, against the sampled truth.
# view SCENE NAME ARGUMENTS...: a row, and the verdicts of every frame.
view() {
    scene=$1 name=$2
    shift 2
    "$bench" cull "$results/$scene.obs" "$@" --repeat 7 --out "$results/$scene.$name.vis" >"$results/$scene.$name.txt"
    "$bench" compare "$results/$scene.tru" "$results/$scene.$name.vis" >"$results/$scene.$name.missed.txt"
    text=$results/$scene.$name.txt
    same=-
    if [ "$name" != openmp ]; then
        same=no
        cmp -s "$results/$scene.openmp.vis" "$results/$scene.$name.vis" && same=yes
    fi
    echo "| $scene | $name | $(field median_ms "$text") | $(field walk_ms "$text") | $(field test_ms "$text") |" \
        "$same | $(field missed_pct "$results/$scene.$name.missed.txt") |" \
        "$(field false_hidden "$results/$scene.$name.missed.txt") |"
}

# table SCENE NAME ARGUMENTS...: what a table misses.
table() {
    scene=$1 name=$2
    shift 2
    "$bench" gpu "$results/$scene.obs" "$@" --repeat 3 --out "$results/$scene.$name.vis" >"$results/$scene.$name.txt"
    "$bench" compare "$results/$scene.tru" "$results/$scene.$name.vis" >"$results/$scene.$name.missed.txt"
    text=$results/$scene.$name.txt
    echo "| $scene | $name | $(field frame_ms "$text") | $(field walk_ms "$text") | | |" \
        "$(field missed_pct "$results/$scene.$name.missed.txt") |" \
        "$(field false_hidden "$results/$scene.$name.missed.txt") |"
}

echo "| scene | by | frame ms | walk | test | OpenMP's verdicts | missed % | false hidden |"
echo "|---|---|---:|---:|---:|---|---:|---:|"
for scene in city_100000 city_1000000 forest_100000 soup_100000; do
    "$bench" scene "${scene%_*}" "${scene#*_}" 2 --out "$results/$scene.obs" >/dev/null
    "$bench" truth "$results/$scene.obs" --frames 0,20,40 --out "$results/$scene.tru" >"$results/$scene.truth.txt"
    view "$scene" openmp --backend openmp --threads 1
    view "$scene" openmp_all --backend openmp
    view "$scene" opencl --backend opencl
    table "$scene" table --arrange
    table "$scene" table_strips --arrange --strips 4
    rm -f "$results/$scene".*.vis "$results/$scene.obs" "$results/$scene.tru"
done

cat "$results"/*.txt >"$results/log"
rm -f "$results"/*.txt
mv "$results/log" "$results/log.txt"
