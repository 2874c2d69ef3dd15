# SPDX-License-Identifier: Apache-2.0
# Planted bugs: copies of single files of the library, each with one mistake of the kind that the
# accuracy tests are there for. A test program that holds with the library must fail with the copy,
# and with the message that belongs to the mistake: a crash would not do. Nothing of this is in the
# library's own text, and no build of it can be asked for such a bug.

# occ_plant(<bug> IN <file> REPLACE <text> BY <text> COMPILE <part> ...)
# `text` must stand in the file once. The parts are those of the library that see the mistake: files
# of src/, lanes_<instruction set>, or kernels, which are the OpenCL program.
function(occ_plant bug)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "IN;REPLACE;BY" "COMPILE")
    set(folder "${CMAKE_CURRENT_BINARY_DIR}/${bug}")
    set(source "${PROJECT_SOURCE_DIR}/${arg_IN}")
    set(occ_planted_file "${arg_IN}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}")
    file(READ "${source}" text)
    string(FIND "${text}" "${arg_REPLACE}" first)
    string(FIND "${text}" "${arg_REPLACE}" last REVERSE)
    if(first EQUAL -1 OR NOT first EQUAL last)
        message(FATAL_ERROR "the bug ${bug} has lost its place: ${arg_IN} should hold once:\n${arg_REPLACE}\n"
            "Plant it in what stands there now (${CMAKE_CURRENT_LIST_FILE}).")
    endif()
    string(REPLACE "${arg_REPLACE}" "${arg_BY}" text "${text}")

    set(includes "${PROJECT_SOURCE_DIR}/src" "${PROJECT_SOURCE_DIR}/kernels" "${PROJECT_SOURCE_DIR}/include")
    if(arg_IN MATCHES "^kernels/")
        # Headers look for each other in their own folder first.
        file(GLOB siblings RELATIVE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/kernels/*.h"
            "${PROJECT_SOURCE_DIR}/kernels/*.cl")
        foreach(sibling IN LISTS siblings)
            occ_copy("${sibling}" "${folder}")
        endforeach()
        list(PREPEND includes "${folder}/kernels")
    elseif(arg_IN MATCHES "^src/lanes_.*h$")
        file(GLOB siblings RELATIVE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/src/lanes_*.h")
        foreach(sibling IN LISTS siblings)
            occ_copy("${sibling}" "${folder}")
        endforeach()
    endif()
    # Written only if it changed, so that it is compiled only then.
    set(old "")
    if(EXISTS "${folder}/${arg_IN}")
        file(READ "${folder}/${arg_IN}" old)
    endif()
    if(NOT old STREQUAL text)
        file(WRITE "${folder}/${arg_IN}" "${text}")
    endif()
    set(occ_planted_includes_${bug} "${includes}" PARENT_SCOPE)

    set(objects "")
    set(sources "")
    foreach(part IN LISTS arg_COMPILE)
        if(part MATCHES "^lanes_[a-z0-9]+$")
            occ_plant_part(planted_${bug}_${part} occ_${part} "${includes}" "${folder}" lanes.c)
            list(APPEND objects $<TARGET_OBJECTS:planted_${bug}_${part}>)
        elseif(part STREQUAL "kernels")
            occ_plant_kernels("${folder}")
            list(APPEND sources "${folder}/kernel_sources.c")
        else()
            list(APPEND sources "${part}")
        endif()
    endforeach()
    if(sources)
        occ_plant_part(planted_${bug} occlude_internal "${includes}" "${folder}" ${sources})
        list(APPEND objects $<TARGET_OBJECTS:planted_${bug}>)
    endif()
    set(occ_planted_objects_${bug} "${objects}" PARENT_SCOPE)
endfunction()

# Copies a file without a bug. (What is compiled is all copied: clang-tidy has seen the original.)
function(occ_copy path folder)
    if(NOT path STREQUAL occ_planted_file)
        configure_file("${PROJECT_SOURCE_DIR}/${path}" "${folder}/${path}" COPYONLY)
    endif()
endfunction()

# Compiles files of src/, or their copies in `folder`, as the target `model` does.
function(occ_plant_part target model includes folder)
    get_target_property(aliased ${model} ALIASED_TARGET)
    if(aliased)
        set(model ${aliased})
    endif()
    get_target_property(definitions ${model} COMPILE_DEFINITIONS)
    get_target_property(options ${model} COMPILE_OPTIONS)
    set(paths "")
    foreach(source IN LISTS ARGN)
        if(NOT IS_ABSOLUTE "${source}")
            occ_copy("src/${source}" "${folder}")
            set(source "${folder}/src/${source}")
        endif()
        list(APPEND paths "${source}")
    endforeach()
    add_library(${target} OBJECT ${paths})
    target_include_directories(${target} PRIVATE ${includes})
    target_include_directories(${target} SYSTEM PRIVATE ${cglm_INCLUDE_DIRS})
    target_compile_definitions(${target} PRIVATE ${definitions})
    if(options)
        target_compile_options(${target} PRIVATE ${options})
    endif()
endfunction()

function(occ_plant_kernels folder)
    list(TRANSFORM occ_kernel_files PREPEND "${folder}/kernels/" OUTPUT_VARIABLE paths)
    add_custom_command(OUTPUT "${folder}/kernel_sources.c"
        COMMAND "${CMAKE_COMMAND}" "-DOUT_C=${folder}/kernel_sources.c" "-DOUT_CL=${folder}/kernel_program.cl"
            "-DFILES=${paths}" -P "${PROJECT_SOURCE_DIR}/kernels/embed.cmake"
        DEPENDS ${paths} "${PROJECT_SOURCE_DIR}/kernels/embed.cmake" VERBATIM)
endfunction()

# occ_caught_by(<bug> <module> <case> <message> [COMPILED]): the test's case must fail with that
# message. COMPILED: the test itself includes what the bug is in.
function(occ_caught_by bug module case message)
    set(program planted_${bug}_${module})
    if(NOT TARGET ${program})
        if("COMPILED" IN_LIST ARGN)
            set(folder "${CMAKE_CURRENT_BINARY_DIR}/${bug}")
            occ_copy("tests/test_${module}.c" "${folder}")
            add_executable(${program} "${folder}/tests/test_${module}.c" ${occ_planted_objects_${bug}})
            target_include_directories(${program} BEFORE PRIVATE ${occ_planted_includes_${bug}})
            foreach(what IN ITEMS COMPILE_DEFINITIONS INCLUDE_DIRECTORIES)
                get_target_property(value test_${module} ${what})
                set_property(TARGET ${program} APPEND PROPERTY ${what} ${value})
            endforeach()
        else()
            add_executable(${program} $<TARGET_OBJECTS:test_${module}> ${occ_planted_objects_${bug}})
            set_target_properties(${program} PROPERTIES LINKER_LANGUAGE C)
        endif()
        # What the library holds of the same name is left out, since it is defined already.
        get_target_property(libraries test_${module} LINK_LIBRARIES)
        target_link_libraries(${program} PRIVATE ${libraries})
    endif()
    occ_register(twin.${module}.${bug} ${program} "${case}" LABELS unit TIMEOUT 60)
    set_tests_properties(twin.${module}.${bug} PROPERTIES
        PASS_REGULAR_EXPRESSION ":F:${case}:[a-z_]*:[0-9]+: ${message}"
        SKIP_REGULAR_EXPRESSION "no OpenCL device")
endfunction()

# The instruction sets whose lanes run here: of the others no test could say anything.
set(occ_planted_lanes plain)
if(TARGET occ_lanes_avx2 AND EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
    if(flags MATCHES " avx2 ")
        list(APPEND occ_planted_lanes avx2)
    endif()
    if(flags MATCHES " avx512f " AND flags MATCHES " avx512bw " AND flags MATCHES " avx512vl " AND flags MATCHES " avx512dq ")
        list(APPEND occ_planted_lanes avx512)
    endif()
endif()
