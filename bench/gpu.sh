#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/gpu.sh [RESULTS]: the tables of docs/opencl.md on the device of this machine, in one run: builds what it
# needs, makes the scenes in memory, and prints a row for each. Takes what compilers and OpenCL loader there are;
# installs nothing. RESULTS (default build/gpu) receives what every command printed.
#   SIZES=small in the environment: nothing above a million objects.
#   HUGE=1: a hundred million objects too; takes 40 GiB of memory.
set -eu
cd "$(dirname "$0")/.."
results=${1:-build/gpu}
build=${BUILD:-build/gpu-build}
mkdir -p "$results"
cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release >"$results/configure.log"
cmake --build "$build" --parallel --target occlude-bench >"$results/build.log" 2>&1
bench=$build/bench/occlude-bench

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
            printf "| %s | %d | %.0f | %.0f | `%s` | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.0f | %.1f | %.1f |\n",
                name, v["objects"], v["occluders"], v["visible"], v["mask"], v["frame_ms"], v["p99_ms"], v["walk_ms"],
                v["blocks_ms"], v["objects_ms"], v["fusion_ms"], kernels, v["copy_gbs"], v["pinned_gbs"], v["move_gbs"]
        }'
}

echo '| run | objects | occluders | visible | mask | frame ms | p99 | walk | blocks | objects | fusion | kernels | copy GB/s | pinned GB/s | moved GB/s |'
echo '|---|---:|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|'
row city_100000 city 100000 2 --every 3
row forest_100000 forest 100000 2 --every 3 --arrange
row city_1000000 city 1000000 2 --every 3
row city_1000000_arranged city 1000000 2 --every 3 --arrange
row city_1000000_single city 1000000 2 --every 3 --method single
row soup_100000 soup 100000 2 --every 3 --arrange
row city_1000000_moved city 1000000 2 --every 3 --move
if [ "${SIZES:-}" != small ]; then
    row city_10000000 city 10000000 2 --every 3
    row forest_10000000 forest 10000000 2 --every 3 --arrange
fi
if [ -n "${HUGE:-}" ]; then
    row city_100000000 city 100000000 2 --every 6
fi
echo
echo "Device: $(cat "$results/device.txt")"
echo
# The walk on the host with the test on the device, beside OpenMP's, on the same host.
for count in 100000 1000000; do
    scene=$results/city_$count.obs
    "$bench" scene city "$count" 2 --out "$scene" >/dev/null
    for backend in openmp opencl; do
        "$bench" cull "$scene" --backend "$backend" --threads 1 --repeat 7 --every 3 | tail -n 1
    done
done
