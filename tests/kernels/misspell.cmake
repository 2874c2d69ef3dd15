# SPDX-License-Identifier: Apache-2.0
# Copies a kernel and misspells one built-in function in it: -DIN=x.cl -DOUT=y.cl.
file(READ "${IN}" text)
string(REPLACE "get_local_id(" "get_locl_id(" planted "${text}")
if(planted STREQUAL text)
    message(FATAL_ERROR "${IN} calls no get_local_id(): plant another bug")
endif()
file(WRITE "${OUT}" "${planted}")
