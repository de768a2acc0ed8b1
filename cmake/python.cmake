# CONTOUR_PYTHON: the interpreter for tests and tools. build/venv is made by tools/setup and sees the system's packages
# as well as the test peers of PyPI; without it, the system's own, never one that happens to come first in PATH.
find_program(CONTOUR_PYTHON python3 PATHS ${CMAKE_SOURCE_DIR}/build/venv/bin /usr/bin NO_DEFAULT_PATH NO_CACHE)
if(NOT CONTOUR_PYTHON)
  find_program(CONTOUR_PYTHON python3 REQUIRED NO_CACHE)
endif()
