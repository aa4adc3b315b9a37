# SPDX-License-Identifier: Apache-2.0
# What every target of the project has in common, and the functions that make targets.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

add_library(vera_options INTERFACE)
target_compile_options(vera_options INTERFACE
    # The same bits on every CPU: no fused multiply-add, no reordered arithmetic.
    -ffp-contract=off
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Werror
    # GCC 12 gives this one for strings in designated initialisers, where nothing is amiss.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
target_include_directories(vera_options INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>)

# vera_folder(NAME SOURCES file... [LINKS target...])
# A folder under src/vera is one library target, vera_NAME, and links the folders that it uses.
function(vera_folder name)
    cmake_parse_arguments(FOLDER "" "" "SOURCES;LINKS" ${ARGN})
    if(FOLDER_SOURCES)
        add_library(vera_${name} STATIC ${FOLDER_SOURCES})
        target_link_libraries(vera_${name} PUBLIC vera_options ${FOLDER_LINKS})
    else()
        add_library(vera_${name} INTERFACE)
        target_link_libraries(vera_${name} INTERFACE vera_options ${FOLDER_LINKS})
    endif()
    add_library(vera::${name} ALIAS vera_${name})
endfunction()

# vera_tests(FOLDER LABEL SOURCES file... [LINKS target...])
# One GoogleTest program for the tests of a folder that carry a label: unit, agree, golden or door.
function(vera_tests folder label)
    cmake_parse_arguments(TESTS "" "" "SOURCES;LINKS" ${ARGN})
    set(target ${folder}_${label}_tests)
    add_executable(${target} ${TESTS_SOURCES})
    target_link_libraries(${target} PRIVATE ${TESTS_LINKS} GTest::gmock GTest::gtest_main)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(${target} PRIVATE VERA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 120 PROPERTIES LABELS ${label} TIMEOUT 600)
endfunction()
