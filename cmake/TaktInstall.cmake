# The C++ side of an installation (component "cpp"): headers, archives, find_package(takt). The Python side is in TaktPython.cmake.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(folders GLOBAL PROPERTY TAKT_FOLDERS)
list(TRANSFORM folders PREPEND takt_)
install(TARGETS ${folders} takt_lcmtypes EXPORT takt ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT cpp)
install(DIRECTORY cpp/takt DESTINATION include COMPONENT cpp FILES_MATCHING PATTERN "*.h")
install(DIRECTORY "${TAKT_LCM_CPP_DIR}/takt" DESTINATION include COMPONENT cpp FILES_MATCHING PATTERN "*.hpp")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT cpp)
install(TARGETS taktd RUNTIME DESTINATION bin COMPONENT cpp)

# Ruckig is an affair of ours: its archive comes along, so that nobody else has to find its wheel.
get_target_property(archive takt::ruckig IMPORTED_LOCATION)
install(FILES "${archive}" DESTINATION "${CMAKE_INSTALL_LIBDIR}" RENAME libtakt_ruckig.a COMPONENT cpp)
install(FILES "${TAKT_RUCKIG_LICENSE}" DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME LICENSE.ruckig COMPONENT cpp)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/takt")
configure_package_config_file(cmake/taktConfig.cmake.in "${CMAKE_BINARY_DIR}/taktConfig.cmake"
  INSTALL_DESTINATION "${package_dir}" PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/taktConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/taktConfig.cmake" "${CMAKE_BINARY_DIR}/taktConfigVersion.cmake"
  DESTINATION "${package_dir}" COMPONENT cpp)
install(EXPORT takt NAMESPACE takt:: FILE taktTargets.cmake DESTINATION "${package_dir}" COMPONENT cpp)
