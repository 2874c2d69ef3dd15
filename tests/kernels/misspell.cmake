# SPDX-License-Identifier: Apache-2.0
# Copies a kernel and misspells the built-in functions that number work-items: -DIN=x.cl -DOUT=y.cl.
file(READ "${IN}" text)
string(REGEX REPLACE "get_(global|local|group)_id\\(" "get_\\1_idd(" planted "${text}")
if(planted STREQUAL text)
    message(FATAL_ERROR "${IN} asks for no number of a work-item: plant another bug")
endif()
file(WRITE "${OUT}" "${planted}")
