# One library per folder, so that an include against the direction of the design fails to link.
#
#   wearwell_library(bayes SOURCES posterior.cpp USES prob table LIBRARIES fmt::fmt)
#
# A folder without sources is a header-only library. USES names folders, LIBRARIES third parties.
function(wearwell_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  list(TRANSFORM ARG_USES PREPEND wearwell_)
  if(ARG_SOURCES)
    add_library(wearwell_${name} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
  else()
    add_library(wearwell_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(wearwell_${name} ${scope} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(wearwell_${name} ${scope} ${ARG_USES} ${ARG_LIBRARIES})
endfunction()

# One test program per folder under tests/, linked to the folder it tests.
#
#   wearwell_test(prob SOURCES law_test.cpp USES prob)
function(wearwell_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;USES;LIBRARIES" ${ARGN})
  list(TRANSFORM ARG_USES PREPEND wearwell_)
  add_executable(test_${name} ${ARG_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(test_${name} PRIVATE ${ARG_USES} ${ARG_LIBRARIES} GTest::gmock_main rapidcheck)
  target_compile_definitions(test_${name} PRIVATE
    PROJECT_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    WEARWELL_BINARY="$<TARGET_FILE:wearwell>")
  if(NOT ARG_LABEL)
    set(ARG_LABEL ${name})
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  gtest_discover_tests(test_${name}
    TEST_PREFIX "${name}: "
    DISCOVERY_MODE PRE_TEST
    PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()
