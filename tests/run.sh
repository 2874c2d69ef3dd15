#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh tests/run.sh: everything that must hold, from a bare Debian 12 with only this checkout.
# Installs what is missing (as root or through sudo), then runs one stage after the other and stops
# at the first that fails. The last lines are ctest's verdict on the build that ships.
set -eu
cd "$(dirname "$0")/.."
. bench/setup.sh
need_packages docs/debian-packages.txt

# Debian has PoCL and llvmpipe among the packages: a skipped test would hide something.
export OCC_REQUIRE_OPENCL=1
export OCC_REQUIRE_GL=1
mkdir -p build
begin=$(date +%s)

stage()
{
    name=$1
    shift
    since=$(date +%s)
    echo "== $name"
    if ! "$@"; then
        echo "== $name: FAILED" >&2
        exit 1
    fi
    echo "== $name: passed in $(($(date +%s) - since)) s"
}

# A whole workflow, its output kept aside unless it fails: what passed is of no interest here.
workflow()
{
    log=build/workflow-$1.log
    if ! cmake --workflow --preset "$1" >"$log" 2>&1; then
        cat "$log"
        return 1
    fi
    grep -E 'tests passed|^Total Test time' "$log"
}

configure()
{
    cmake --preset default >build/configure.log || {
        cat build/configure.log
        return 1
    }
    # The optional parts: here all of them must be on.
    if grep '^-- occlude: .*: off' build/configure.log; then
        return 1
    fi
}

build()
{
    cmake --build --preset default >build/build.log || {
        cat build/build.log
        return 1
    }
}

verdict()
{
    ctest --preset default --output-log build/ctest.log || return 1
}

stage "format" sh tests/check-format.sh
stage "configure" configure
stage "build" build
stage "kernels, offline" ctest --preset default -Q -L '^kernel$'
stage "clang-tidy" sh tests/check-tidy.sh build/default
stage "AddressSanitizer, UndefinedBehaviorSanitizer" workflow asan
stage "ThreadSanitizer" workflow tsan
stage "fuzzing" workflow fuzz
stage "all tests of the default build" verdict
echo "== all stages passed in $(($(date +%s) - begin)) s"
grep -E 'tests passed|^Total Test time' build/ctest.log
