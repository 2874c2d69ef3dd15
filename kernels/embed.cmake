# SPDX-License-Identifier: Apache-2.0
# Turns kernel files into a C file of byte arrays (see src/kernel_sources.h), and into one joined
# program for the offline checks.
#   cmake -DOUT_C=x.c -DOUT_CL=x.cl "-DFILES=a.h;b.cl" -P embed.cmake
# Arrays rather than string literals: C99 promises only 4095 bytes of those.
cmake_minimum_required(VERSION 3.25)

set(arrays "")
set(table "")
set(joined "")
foreach(path IN LISTS FILES)
    cmake_path(GET path FILENAME name)
    file(READ "${path}" text)
    # Sibling files stand before this one in the program already: an empty line keeps the numbering.
    string(REGEX REPLACE "(^|\n)[ \t]*#[ \t]*include[ \t]*\"[^\n]*" "\\1" text "${text}")
    set(text "#line 1 \"${name}\"\n${text}")
    string(APPEND joined "${text}")

    string(MAKE_C_IDENTIFIER "occ_kernel_${name}" array)
    string(HEX "${text}" bytes)
    string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
    # Character constants have char's own signedness: bytes above 127 need no cast.
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
    string(APPEND arrays "static const char ${array}[] = {\n${bytes}0};\n\n")
    string(APPEND table "    {\"${name}\", ${array}, sizeof ${array} - 1},\n")
endforeach()

list(LENGTH FILES count)
file(WRITE "${OUT_C}" "// Written by kernels/embed.cmake.\n#include \"kernel_sources.h\"\n\n${arrays}"
    "const struct occ_kernel_source occ_kernel_sources[] = {\n${table}};\n\n"
    "const unsigned occ_kernel_source_count = ${count};\n")
file(WRITE "${OUT_CL}" "${joined}")
