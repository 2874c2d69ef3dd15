#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/check-format.sh [FILE...]: are these files, or all C and OpenCL files of the project, as
# clang-format 14 would write them? Other versions write other files.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
formatter=${CLANG_FORMAT:-clang-format-14}
if [ $# -gt 0 ]; then
    exec "$formatter" --dry-run -Werror "--style=file:$root/.clang-format" "$@"
fi
cd "$root"
find bench docs include kernels src tests \( -name '*.[ch]' -o -name '*.cl' -o -name '*.cpp' \) -print0 |
    xargs -0 "$formatter" --dry-run -Werror
