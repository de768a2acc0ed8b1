# One function per kind of target, so that every target gets the same language, warnings and code generation.

set(CONTOUR_SANITIZE "" CACHE STRING "Sanitizers for every target, as -fsanitize= takes them")
set(CONTOUR_SLOWDOWN 1)  # of the tests' time limits
if(CONTOUR_SANITIZE)
  set(CONTOUR_SLOWDOWN 10)
endif()

function(contour_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wimplicit-fallthrough -Wformat=2 -Werror
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # GCC 12 sees overlaps in std::string that are not there (bug 105651)
  # The same results on every machine: a stated baseline, no contraction into FMA, no fast-math.
  target_compile_options(${target} PRIVATE -march=x86-64-v2 -ffp-contract=off)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(${target} PRIVATE -O3)
  endif()
  target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR})
  if(CONTOUR_SANITIZE)
    target_compile_definitions(${target} PRIVATE CONTOUR_BASELINE_VECTORS)
    target_compile_options(${target} PRIVATE -fsanitize=${CONTOUR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${CONTOUR_SANITIZE})
  endif()
endfunction()

# Light optimisation for what computes little: it compiles in two thirds of the time.
function(contour_light_optimisation target)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# contour_library(NAME [SOURCES ...] [LINK ...]): a static library, or an interface library when it has headers only.
# A folder that sets CONTOUR_PRECOMPILED has its libraries reuse those headers; one that sets CONTOUR_TOGETHER has the sources
# of its libraries and tests compiled together (unity.cmake).
function(contour_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  if(arg_SOURCES)
    if(CONTOUR_TOGETHER)
      contour_together(arg_SOURCES ${name} ${arg_SOURCES})
    endif()
    add_library(${name} STATIC ${arg_SOURCES})
    contour_flags(${name})
    if(CONTOUR_PRECOMPILED)
      contour_reuse_headers(${name} ${CONTOUR_PRECOMPILED})
    endif()
    target_link_libraries(${name} PUBLIC ${arg_LINK})
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
    target_link_libraries(${name} INTERFACE ${arg_LINK})
  endif()
endfunction()

function(contour_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  contour_flags(${name})
  target_link_libraries(${name} PRIVATE ${arg_LINK})
endfunction()

# contour_time_limit(SECONDS TEST...): after which tests that hang are ended.
function(contour_time_limit seconds)
  math(EXPR seconds "${CONTOUR_SLOWDOWN} * ${seconds}")
  set_tests_properties(${ARGN} PROPERTIES TIMEOUT ${seconds})
endfunction()

# contour_nightly_test(NAME LABEL SECONDS COMMAND...): what CTest runs at night alone, in the part LABEL of tools/nightly.
function(contour_nightly_test name label seconds)
  add_test(NAME ${name} COMMAND ${ARGN} CONFIGURATIONS nightly)
  set_tests_properties(${name} PROPERTIES LABELS nightly_${label} SKIP_RETURN_CODE 77)
  contour_time_limit(${seconds} ${name})
endfunction()

# contour_by_night(TARGET...): what only tests at night and commands of the documentation need. A build leaves it out; the target
# nightly_programs, which tools/nightly builds, has all of it, and each is built by its own name.
add_custom_target(nightly_programs)
function(contour_by_night)
  set_target_properties(${ARGN} PROPERTIES EXCLUDE_FROM_ALL ON)
  add_dependencies(nightly_programs ${ARGN})
endfunction()

# contour_test(NAME SOURCES ... LINK ... [NIGHTLY CASE...] [OWN_HEADERS]): a GoogleTest program, each case a CTest entry.
# NIGHTLY: cases that take too long for every run of the tests. OWN_HEADERS: it has definitions of its own for the libraries
# that are in the precompiled headers.
function(contour_test name)
  cmake_parse_arguments(arg "OWN_HEADERS" "" "SOURCES;LINK;NIGHTLY" ${ARGN})
  if(CONTOUR_TOGETHER AND NOT arg_OWN_HEADERS)
    contour_together(arg_SOURCES ${name} ${arg_SOURCES})
  endif()
  add_executable(${name} ${arg_SOURCES})
  contour_flags(${name})
  contour_light_optimisation(${name})
  if(NOT arg_OWN_HEADERS)
    contour_reuse_headers(${name} contour_test_headers)
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_link_libraries(${name} PRIVATE ${arg_LINK} GTest::gtest_main)
  math(EXPR limit_s "300 * ${CONTOUR_SLOWDOWN}")
  set(every_run "")
  if(arg_NIGHTLY)
    list(JOIN arg_NIGHTLY ":" cases)
    set(every_run TEST_FILTER "-${cases}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 ${every_run} PROPERTIES TIMEOUT ${limit_s})
  foreach(case ${arg_NIGHTLY})
    contour_nightly_test(nightly.${case} long 1200 ${name} --gtest_filter=${case})
  endforeach()
endfunction()
