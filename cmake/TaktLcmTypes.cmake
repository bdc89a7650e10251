# lcmtypes/*.lcm -> C++ headers (target takt::lcmtypes, #include "takt/msgs/NAME.hpp") and the Python package takt.msgs.
# Every type says `package takt.msgs;`.

# Debian's lcm-gen fits Debian's library; a Python environment may hold another one of the same name on the PATH.
find_program(TAKT_LCM_GEN lcm-gen PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT TAKT_LCM_GEN)
  find_program(TAKT_LCM_GEN lcm-gen REQUIRED)
endif()

file(GLOB TAKT_LCM_FILES CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/lcmtypes/*.lcm")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${TAKT_LCM_FILES})  # the names of the structs are read here
set(TAKT_LCM_CPP_DIR "${CMAKE_BINARY_DIR}/lcmtypes/cpp")
set(TAKT_LCM_PYTHON_DIR "${CMAKE_BINARY_DIR}/lcmtypes/python")

# Names the structs of one .lcm file.
function(takt_lcm_structs file out)
  set(names "")
  file(STRINGS "${file}" lines REGEX "^[ \t]*struct[ \t]+[A-Za-z0-9_]+")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[ \t]*struct[ \t]+([A-Za-z0-9_]+).*" "\\1" name "${line}")
    list(APPEND names "${name}")
  endforeach()
  set(${out} ${names} PARENT_SCOPE)
endfunction()

set(headers "")
set(modules "${TAKT_LCM_PYTHON_DIR}/takt/msgs/__init__.py")
foreach(file IN LISTS TAKT_LCM_FILES)
  takt_lcm_structs("${file}" structs)
  list(TRANSFORM structs REPLACE "(.+)" "${TAKT_LCM_CPP_DIR}/takt/msgs/\\1.hpp" OUTPUT_VARIABLE file_headers)
  list(TRANSFORM structs REPLACE "(.+)" "${TAKT_LCM_PYTHON_DIR}/takt/msgs/\\1.py" OUTPUT_VARIABLE file_modules)
  add_custom_command(OUTPUT ${file_headers} DEPENDS "${file}" VERBATIM
    COMMAND "${TAKT_LCM_GEN}" --cpp --cpp-std c++11 --cpp-hpath "${TAKT_LCM_CPP_DIR}" "${file}")
  list(APPEND headers ${file_headers})
  list(APPEND modules ${file_modules})
endforeach()

add_library(takt_lcmtypes INTERFACE)
add_library(takt::lcmtypes ALIAS takt_lcmtypes)
set_target_properties(takt_lcmtypes PROPERTIES EXPORT_NAME lcmtypes)
# SYSTEM: our warnings are not for generated code.
target_include_directories(takt_lcmtypes SYSTEM INTERFACE
  $<BUILD_INTERFACE:${TAKT_LCM_CPP_DIR}> $<INSTALL_INTERFACE:include>)
target_link_libraries(takt_lcmtypes INTERFACE PkgConfig::LCM)
add_custom_target(takt_lcm_headers DEPENDS ${headers})
add_dependencies(takt_lcmtypes takt_lcm_headers)

# lcm-gen adds to an __init__.py it finds and writes one for the parent package too: so start from nothing, in a folder of its own,
# from where only takt/msgs is taken.
if(TAKT_BUILD_PYTHON AND TAKT_LCM_FILES)
  set(stub "${TAKT_LCM_PYTHON_DIR}/takt/msgs/__init__.pyi")
  set(stub_tool "${PROJECT_SOURCE_DIR}/tools/lcm_stubs.py")
  add_custom_command(OUTPUT ${modules} "${stub}" DEPENDS ${TAKT_LCM_FILES} "${stub_tool}" VERBATIM
    COMMAND "${CMAKE_COMMAND}" -E rm -rf "${TAKT_LCM_PYTHON_DIR}"
    COMMAND "${TAKT_LCM_GEN}" --python --ppath "${TAKT_LCM_PYTHON_DIR}" ${TAKT_LCM_FILES}
    COMMAND "${Python_EXECUTABLE}" "${stub_tool}" ${TAKT_LCM_FILES} > "${stub}")
  set(TAKT_LCM_MODULES ${modules} "${stub}")
endif()
