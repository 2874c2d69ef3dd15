# SPDX-License-Identifier: Apache-2.0
# Copies a kernel and misspells the built-in functions that number work-items: -DIN=x.cl -DOUT=y.cl.
file(READ "${IN}" text)
<<<<<<< HEAD
string(REPLACE "get_local_id(" "get_locl_id(" planted "${text}")
if(planted STREQUAL text)
    message(FATAL_ERROR "${IN} calls no get_local_id(): plant another bug")
=======
string(REGEX REPLACE "get_(global|local|group)_id\\(" "get_\\1_idd(" planted "${text}")
if(planted STREQUAL text)
    message(FATAL_ERROR "${IN} asks for no number of a work-item: plant another bug")
>>>>>>> build
endif()
file(WRITE "${OUT}" "${planted}")
