# Several sources of a test as one translation unit: most of a clean build goes into templates of headers that each source would
# instantiate anew. As with precompiled headers, the real-time side goes without, and so do the presets dev, tsan and rtsan.
option(CONTOUR_UNITY "Compile several sources of a test at once" ON)

# contour_together(OUT NAME SOURCE...): what is to be compiled for the target NAME in place of SOURCE..., in groups that
# unity_groups.py makes; a source with options of its own (set before) stays alone. Where a name that is new in one source
# collides with another's, the compiler says so: to configure once more puts the two into different groups.
function(contour_together out name)
  set(alone "")
  set(sources "")
  foreach(source ${ARGN})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(CONTOUR_UNITY AND NOT options AND source MATCHES "\\.cc$")
      list(APPEND sources ${source})
    else()
      list(APPEND alone ${source})
    endif()
  endforeach()
  set(together "")
  if(sources)
    execute_process(COMMAND ${CONTOUR_PYTHON} -I -S -B ${CMAKE_SOURCE_DIR}/cmake/unity_groups.py ${CMAKE_SOURCE_DIR}
                            ${CMAKE_CURRENT_BINARY_DIR}/together/${name} ${sources}
                    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE together
                    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  endif()
  set(${out} ${alone} ${together} PARENT_SCOPE)
endfunction()
