# SPDX-License-Identifier: Apache-2.0
# What every target of the project has in common, and the functions that make targets.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

# The same bits on every CPU: no fused multiply-add, no reordered arithmetic. Whoever includes the
# headers needs it too, which is why it is installed with the library.
set(VERA_SAME_BITS -ffp-contract=off)

add_library(vera_options INTERFACE)
target_compile_options(vera_options INTERFACE
    ${VERA_SAME_BITS}
    # Nobody replaces our functions at run time, so that calls within the library may be inlined.
    -fno-semantic-interposition
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
        if(VERA_BUILD_FUZZERS AND name MATCHES "^(formats|generate|image)$")
            # What reads strange bytes tells the fuzzer which branches it took.
            target_compile_options(vera_${name} PRIVATE -fsanitize=fuzzer-no-link)
        endif()
        set_property(GLOBAL APPEND PROPERTY VERA_FOLDER_LIBRARIES vera_${name})
    else()
        add_library(vera_${name} INTERFACE)
        target_link_libraries(vera_${name} INTERFACE vera_options ${FOLDER_LINKS})
    endif()
    add_library(vera::${name} ALIAS vera_${name})
endfunction()

# vera_tests(FOLDER LABEL [THREADED] SOURCES file... [LINKS target...])
# One GoogleTest program for the tests of a folder that carry a label: unit, agree, golden or door.
# THREADED tests are also run under ThreadSanitizer, and carry a label that ends in _threaded.
function(vera_tests folder label)
    cmake_parse_arguments(TESTS "THREADED" "" "SOURCES;LINKS" ${ARGN})
    set(target ${folder}_${label}_tests)
    add_executable(${target} ${TESTS_SOURCES})
    target_link_libraries(${target} PRIVATE ${TESTS_LINKS} GTest::gmock GTest::gtest_main)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(${target} PRIVATE VERA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")

    set(test_label ${label})
    if(TESTS_THREADED)
        # One word: gtest_discover_tests takes lists apart, and ctest -L finds parts of labels.
        string(APPEND test_label "_threaded")
        add_dependencies(threaded_tests ${target})
    endif()
    if(label MATCHES "^(unit|agree)$")
        add_dependencies(unit_and_agree_tests ${target})
    endif()
    # Tests are listed when they are linked, and some go through all example scenes: a new scene
    # links them again.
    file(GLOB example_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*)
    set_property(TARGET ${target} PROPERTY LINK_DEPENDS "${example_scenes}")
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 120 PROPERTIES LABELS "${test_label}" TIMEOUT 600)
endfunction()
