# What most sources include, compiled once: libraries share the first, test programs the second. Headers are held to stand
# alone by tests/architecture.
function(wearwell_precompiled name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/${name}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

set(common_headers <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <limits> <map> <memory> <mutex>
  <numbers> <numeric> <optional> <set> <span> <sstream> <stop_token> <string> <unordered_map> <variant> <vector>
  <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp> <Eigen/Dense> <Random123/philox.h>)
wearwell_precompiled(wearwell_headers
  HEADERS ${common_headers}
  LIBRARIES Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json Threads::Threads)
set_target_properties(wearwell_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
# Tests are compiled once and run once: what their own code would gain by -O3 the compiler takes longer to find.
set(test_options $<$<CONFIG:Release>:-O1>)
if(WEARWELL_BUILD_TESTS)
  wearwell_precompiled(wearwell_test_headers
    HEADERS ${common_headers} <gmock/gmock.h> <gtest/gtest.h> <rapidcheck/gtest.h>
    LIBRARIES Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json GTest::gmock rapidcheck Threads::Threads)
  target_compile_options(wearwell_test_headers PRIVATE ${test_options})
endif()

# Sources of one folder are compiled two dozen at a time where WEARWELL_UNITY says so (presets `release` and of sanitizers): most of what a
# source costs is what its neighbours cost too. Helpers of a folder therefore have names of their own. APART are those whose helpers
# have names of the others but not of one another: they have batches of their own. ALONE are those that are compiled one by one.
function(wearwell_batches target)
  cmake_parse_arguments(ARG "" "" "SOURCES;APART;ALONE" ${ARGN})
  if(NOT WEARWELL_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # What a neighbour names is no global that a local would hide, nor does its source become a header.
  target_compile_options(${target} PRIVATE -Wno-shadow "$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local;-Wno-subobject-linkage>")
  foreach(group batch apart)
    set(at_${group} 0)
  endforeach()
  foreach(source ${ARG_SOURCES})
    if(source IN_LIST ARG_ALONE)
      continue()
    endif()
    set(group batch)
    if(source IN_LIST ARG_APART)
      set(group apart)
    endif()
    math(EXPR batch "${at_${group}} / 24")
    math(EXPR at_${group} "${at_${group}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}${batch})
  endforeach()
endfunction()

# One library per folder, so that an include against the direction of the design fails to link.
#
#   wearwell_library(bayes SOURCES posterior.cpp USES prob table LIBRARIES fmt::fmt)
#
# A folder without sources is a header-only library. USES names folders, LIBRARIES third parties, APART and ALONE those sources
# that are not compiled together with the others (wearwell_batches).
function(wearwell_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES;APART;ALONE" ${ARGN})
  list(TRANSFORM ARG_USES PREPEND wearwell_)
  if(ARG_SOURCES)
    add_library(wearwell_${name} STATIC ${ARG_SOURCES})
    target_precompile_headers(wearwell_${name} REUSE_FROM wearwell_headers)
    wearwell_batches(wearwell_${name} SOURCES ${ARG_SOURCES} APART ${ARG_APART} ALONE ${ARG_ALONE})
    set(scope PUBLIC)
  else()
    add_library(wearwell_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(wearwell_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(wearwell_${name} ${scope} cxx_std_20)
  target_link_libraries(wearwell_${name} ${scope} ${ARG_USES} ${ARG_LIBRARIES})
  set_target_properties(wearwell_${name} PROPERTIES EXPORT_NAME ${name})
  if(ARG_SOURCES)
    set_target_properties(wearwell_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  set_property(GLOBAL APPEND PROPERTY wearwell_libraries wearwell_${name})
endfunction()

# Commands cost seconds each, nearly all of it the parser of command lines: a group of them is compiled as one source.
#
#   wearwell_commands(cli commands fit.cpp check.cpp)
function(wearwell_commands name group)
  set_target_properties(wearwell_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
endfunction()

# One test program per folder under tests/, linked to the folder it tests. `make test` neither builds nor runs those that are ON_REQUEST
# (the presets of tests leave their names out where they are not built).
#
#   wearwell_test(prob SOURCES distribution_test.cpp USES prob)
function(wearwell_test name)
  cmake_parse_arguments(ARG "ON_REQUEST" "LABEL;TIMEOUT" "SOURCES;USES;LIBRARIES;APART;ALONE" ${ARGN})
  list(TRANSFORM ARG_USES PREPEND wearwell_)
  add_executable(test_${name} ${ARG_SOURCES})
  set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL ${ARG_ON_REQUEST})
  target_compile_options(test_${name} PRIVATE ${test_options})
  target_precompile_headers(test_${name} REUSE_FROM wearwell_test_headers)
  wearwell_batches(test_${name} SOURCES ${ARG_SOURCES} APART ${ARG_APART} ALONE ${ARG_ALONE})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(test_${name} PRIVATE
    ${ARG_USES} ${ARG_LIBRARIES} Eigen3::Eigen fmt::fmt GTest::gmock_main rapidcheck)
  target_compile_definitions(test_${name} PRIVATE
    PROJECT_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    WEARWELL_BINARY="$<TARGET_FILE:wearwell>")
  if(NOT ARG_LABEL)
    set(ARG_LABEL ${name})
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 900)
  endif()
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    math(EXPR ARG_TIMEOUT "20 * ${ARG_TIMEOUT}")
  endif()
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake)
  file(GENERATE OUTPUT ${suites} CONTENT "include(${PROJECT_SOURCE_DIR}/tests/suites.cmake)
wearwell_suites(${name} $<TARGET_FILE:test_${name}> ${ARG_LABEL} ${ARG_TIMEOUT})
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
endfunction()
