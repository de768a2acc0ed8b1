# Half of the compile time of the tools and tests went into reading the same headers of the standard library, Eigen and GoogleTest.
# These are read once. The real-time side goes without, and so do the presets dev and tsan: there a file that does
# not include what it uses does not compile.

set(CONTOUR_STANDARD_HEADERS
  <algorithm> <array> <atomic> <charconv> <chrono> <cmath> <cstdint> <cstdio> <cstring> <filesystem> <fstream> <functional>
  <iostream> <limits> <map> <memory> <mutex> <numbers> <numeric> <optional> <random> <set> <span> <sstream> <stdexcept>
  <string> <string_view> <thread> <tuple> <utility> <variant> <vector> <Eigen/Dense>)

# contour_precompiled(NAME LINK ... HEADERS ...): an object library that reads HEADERS once for those that reuse them.
function(contour_precompiled name)
  cmake_parse_arguments(arg "" "" "LINK;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${name}.cc CONTENT "// ${name}\n" @ONLY)
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/generated/${name}.cc)
  contour_flags(${name})
  target_compile_options(${name} PRIVATE -pthread)
  target_link_libraries(${name} PRIVATE ${arg_LINK} Eigen3::Eigen)
  target_precompile_headers(${name} PRIVATE ${CONTOUR_STANDARD_HEADERS} ${arg_HEADERS})
  # For ccache with pch_external_checksum: what was compiled in one folder serves another, although the paths in this file differ.
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${name}.dir/cmake_pch.hxx.gch.sum
       CONTENT "${CONTOUR_STANDARD_HEADERS};${arg_HEADERS};${Eigen3_VERSION};${GTest_VERSION};${CLI11_VERSION};${nlohmann_json_VERSION}\n" @ONLY)
endfunction()

# contour_reuse_headers(TARGET NAME): TARGET starts from the headers of NAME; the compiler refuses them when flags differ.
function(contour_reuse_headers target name)
  target_compile_options(${target} PRIVATE -pthread)
  # GCC 12 forgets that precompiled headers are the system's, and warns of overlaps and lengths in std::string that are not there.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds>)
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()
