# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=commit_id.h -DSOURCE=DIR -P commit_id.cmake: writes the commit that SOURCE is at, and
# "-dirty" after it where files differ from it; touches OUT only when that has changed.
cmake_minimum_required(VERSION 3.25)
set(commit "unknown")
execute_process(COMMAND git describe --always --dirty --abbrev=12 --exclude=*
    WORKING_DIRECTORY "${SOURCE}" OUTPUT_VARIABLE described RESULT_VARIABLE status
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(status EQUAL 0)
    set(commit "${described}")
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "#define OCC_BENCH_COMMIT \"@commit@\"\n" @ONLY)
