# SPDX-License-Identifier: Apache-2.0
# One step of an install test; CMakeLists.txt beside this file names the variables.
#   stage          installs a static or shared library into a prefix, then moves the prefix
#   find_package   builds and runs the consumer through occlude-config.cmake
#   wrong_version  the same, asking for a version that is not installed (must fail)
#   pkg_config     builds and runs the consumer through occlude.pc
#   subproject     builds and runs the consumer with the library as a subfolder
#   deb            makes the Debian packages and looks into them
cmake_minimum_required(VERSION 3.25)

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        list(JOIN ARGN " " line)
        message(FATAL_ERROR "failed (${result}): ${line}")
    endif()
endfunction()

set(prefix "${WORK}/${KIND}/moved")
set(consumer "${SOURCE}/tests/install/consumer")
set(extension c)
set(compiler "${C_COMPILER}")
set(standard -std=c99)
if(LANGUAGE STREQUAL "CXX")
    set(extension cpp)
    set(compiler "${CXX_COMPILER}")
    set(standard -std=c++11)
endif()

if(STEP STREQUAL "stage")
    file(REMOVE_RECURSE "${WORK}/${KIND}")
    set(build "${BUILD}")
    if(NOT KIND STREQUAL OWN_KIND)
        set(build "${WORK}/${KIND}/build")
        set(shared OFF)
        if(KIND STREQUAL "shared")
            set(shared ON)
        endif()
        run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${build}" -G "${GENERATOR}" -DBUILD_SHARED_LIBS=${shared}
            "-DCMAKE_C_COMPILER=${C_COMPILER}" -DCMAKE_BUILD_TYPE=Release -DOCCLUDE_TESTS=OFF -DOCCLUDE_BENCH=OFF
            -DOCCLUDE_OPENMP=${OPENMP} -DOCCLUDE_OPENCL=${OPENCL})
        run("${CMAKE_COMMAND}" --build "${build}" --parallel 2)
    endif()
    run("${CMAKE_COMMAND}" --install "${build}" --prefix "${WORK}/${KIND}/installed")
    file(RENAME "${WORK}/${KIND}/installed" "${prefix}")

elseif(STEP STREQUAL "find_package" OR STEP STREQUAL "wrong_version")
    set(version 0.1)
    if(STEP STREQUAL "wrong_version")
        set(version 99)
    endif()
    set(build "${WORK}/${KIND}/${STEP}_${LANGUAGE}")
    run("${CMAKE_COMMAND}" --fresh -S "${consumer}" -B "${build}" -G "${GENERATOR}"
        "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
        "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" --no-warn-unused-cli
        -DLANGUAGE=${LANGUAGE} -DVERSION=${version})
    run("${CMAKE_COMMAND}" --build "${build}")
    run("${build}/consumer")

elseif(STEP STREQUAL "pkg_config")
    set(static "")
    if(KIND STREQUAL "static")
        set(static --static)
    endif()
    set(ENV{PKG_CONFIG_PATH} "${prefix}/${LIBDIR}/pkgconfig")
    execute_process(COMMAND "${PKG_CONFIG}" ${static} --cflags --libs occlude
        OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    set(program "${WORK}/${KIND}/pkg_config_${LANGUAGE}")
    run("${compiler}" ${standard} -Wall -Wextra -Wpedantic -Werror "${consumer}/consumer.${extension}" -o "${program}"
        ${flags} "-Wl,-rpath,${prefix}/${LIBDIR}")
    run("${program}")

elseif(STEP STREQUAL "subproject")
    set(build "${WORK}/${KIND}_subproject")
    run("${CMAKE_COMMAND}" --fresh -S "${consumer}" -B "${build}" -G "${GENERATOR}" "-DCMAKE_C_COMPILER=${C_COMPILER}"
        -DLANGUAGE=C "-DSUBPROJECT=${SOURCE}" -DOCCLUDE_OPENMP=${OPENMP} -DOCCLUDE_OPENCL=${OPENCL})
    run("${CMAKE_COMMAND}" --build "${build}" --parallel 2)
    run("${build}/consumer")

elseif(STEP STREQUAL "deb")
    set(build "${WORK}/shared/build")
    if(OWN_KIND STREQUAL "shared")
        set(build "${BUILD}")
    endif()
    file(REMOVE_RECURSE "${WORK}/deb")
    run("${CMAKE_CPACK_COMMAND}" --config "${build}/CPackConfig.cmake" -B "${WORK}/deb")
    file(GLOB packages "${WORK}/deb/*.deb")
    list(SORT packages)
    set(found "")
    foreach(package IN LISTS packages)
        cmake_path(GET package FILENAME name)
        string(REGEX REPLACE "_.*" "" name "${name}")
        execute_process(COMMAND dpkg-deb --fsys-tarfile "${package}" OUTPUT_FILE "${package}.tar" COMMAND_ERROR_IS_FATAL ANY)
        execute_process(COMMAND "${CMAKE_COMMAND}" -E tar tf "${package}.tar" OUTPUT_VARIABLE files COMMAND_ERROR_IS_FATAL ANY)
        if(name MATCHES "-dev$")
            set(wanted "include/occlude/occlude.h\n" "libocclude.so\n" "occlude.pc\n" "occlude-config.cmake\n")
        else()
            set(wanted "libocclude.so.[0-9.]+\n")
        endif()
        foreach(file IN LISTS wanted)
            if(NOT files MATCHES "${file}")
                message(FATAL_ERROR "${package}: no ${file} among\n${files}")
            endif()
        endforeach()
        list(APPEND found ${name})
    endforeach()
    if(NOT found MATCHES "^libocclude-dev;libocclude[0-9.]+$")
        message(FATAL_ERROR "packages: ${found}")
    endif()

else()
    message(FATAL_ERROR "no such step: ${STEP}")
endif()
