# The Python package as it is used from the build tree: ${CMAKE_BINARY_DIR}/python/takt holds links to the sources in python/takt and,
# beside them, everything that is made: _core, its stubs, takt/msgs, generated modules. The wheel (component "python") gets the same.

set(TAKT_STAGE "${CMAKE_BINARY_DIR}/python")
set(package "${TAKT_STAGE}/takt")
file(MAKE_DIRECTORY "${package}")

file(GLOB staged "${package}/*")
foreach(entry IN LISTS staged)
  if(IS_SYMLINK "${entry}")
    file(REMOVE "${entry}")
  endif()
endforeach()
file(GLOB sources CONFIGURE_DEPENDS LIST_DIRECTORIES true RELATIVE "${PROJECT_SOURCE_DIR}/python/takt" "${PROJECT_SOURCE_DIR}/python/takt/*")
list(REMOVE_ITEM sources __pycache__)
foreach(entry IN LISTS sources)
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/python/takt/${entry}" "${package}/${entry}" SYMBOLIC)
endforeach()

# The tables of function blocks are read by takt.plcopen, too.
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/spec" "${package}/spec" SYMBOLIC)
install(DIRECTORY spec/ DESTINATION takt/spec COMPONENT python)

# The ready machines of `takt demo`.
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/python/examples" "${package}/examples" SYMBOLIC)
install(DIRECTORY python/examples/ DESTINATION takt/examples COMPONENT python PATTERN __pycache__ EXCLUDE)

set_target_properties(_core PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${package}")
install(TARGETS _core LIBRARY DESTINATION takt COMPONENT python)

# takt/msgs, from lcmtypes/.
if(TAKT_LCM_MODULES)
  add_custom_command(OUTPUT "${TAKT_STAGE}/msgs.stamp" DEPENDS ${TAKT_LCM_MODULES} VERBATIM
    COMMAND "${CMAKE_COMMAND}" -E rm -rf "${package}/msgs"
    COMMAND "${CMAKE_COMMAND}" -E copy_directory "${TAKT_LCM_PYTHON_DIR}/takt/msgs" "${package}/msgs"
    COMMAND "${CMAKE_COMMAND}" -E touch "${TAKT_STAGE}/msgs.stamp")
  add_custom_target(takt_python_msgs ALL DEPENDS "${TAKT_STAGE}/msgs.stamp")
  install(DIRECTORY "${TAKT_LCM_PYTHON_DIR}/takt/msgs" DESTINATION takt COMPONENT python PATTERN __pycache__ EXCLUDE)
endif()

# _core.pyi. The module is imported without the package around it, which may need what a build environment has not.
set(stubs "${CMAKE_BINARY_DIR}/stubs")
set(bare "${stubs}/bare")
add_custom_command(OUTPUT "${stubs}/stamp" DEPENDS _core VERBATIM
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${stubs}"
  COMMAND "${CMAKE_COMMAND}" -E make_directory "${bare}/takt" "${stubs}/out"
  COMMAND "${CMAKE_COMMAND}" -E touch "${bare}/takt/__init__.py"
  COMMAND "${CMAKE_COMMAND}" -E create_symlink "$<TARGET_FILE:_core>" "${bare}/takt/$<TARGET_FILE_NAME:_core>"
  COMMAND "${CMAKE_COMMAND}" -E env --modify "PYTHONPATH=path_list_prepend:${bare}"
          "${Python_EXECUTABLE}" -m pybind11_stubgen takt._core --exit-code -o "${stubs}/out"
  COMMAND "${CMAKE_COMMAND}" -E copy_directory "${stubs}/out/takt" "${package}"
  COMMAND "${CMAKE_COMMAND}" -E touch "${stubs}/stamp")
add_custom_target(takt_python_stubs ALL DEPENDS "${stubs}/stamp")
install(DIRECTORY "${stubs}/out/takt/" DESTINATION takt COMPONENT python)

# takt_generated_module(NAME.py DEPENDS ... COMMAND ...): a module of the package made by a command that writes it to standard output.
function(takt_generated_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;COMMAND" ${ARGN})
  set(file "${TAKT_STAGE}/takt/${name}")
  add_custom_command(OUTPUT "${file}" DEPENDS ${ARG_DEPENDS} VERBATIM COMMAND ${ARG_COMMAND} > "${file}.new"
    COMMAND "${CMAKE_COMMAND}" -E rename "${file}.new" "${file}")
  string(MAKE_C_IDENTIFIER "takt_python${name}" target)
  add_custom_target(${target} ALL DEPENDS "${file}")
  install(FILES "${file}" DESTINATION takt COMPONENT python)
endfunction()

# --- Generated modules: one line each, here. -----------------------------------------------------------------------------------------
takt_generated_module(_commands.py DEPENDS taktd "${PROJECT_SOURCE_DIR}/tools/generate_python.py"
  COMMAND "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/tools/generate_python.py" "$<TARGET_FILE:taktd>")

# The engine and the notices of what it is linked with go into the wheel too.
if(SKBUILD)
  install(PROGRAMS "$<TARGET_FILE:taktd>" DESTINATION "${SKBUILD_SCRIPTS_DIR}" COMPONENT python)
  install(FILES "${TAKT_RUCKIG_LICENSE}" DESTINATION takt RENAME LICENSE.ruckig COMPONENT python)
endif()
