# Where the libraries from outside come from. Debian's packages, but for Ruckig, whose wheel carries headers, archive and
# CMake package.

set(FIND_LIBRARY_USE_LIB64_PATHS TRUE)
set_property(GLOBAL PROPERTY FIND_LIBRARY_USE_LIB64_PATHS TRUE)

find_package(Threads REQUIRED)
find_package(yaml-cpp CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
# Of these two the packages only say that they are there: their libraries lie where the linker looks.
find_package(Eigen3 3.4 CONFIG REQUIRED)
find_package(orocos_kdl 1.5 CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(fcl 0.7 CONFIG REQUIRED)
pkg_check_modules(URDFDOM REQUIRED urdfdom)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
find_package(OpenSSL 3.0 REQUIRED COMPONENTS Crypto)

# takt::ruckig: the wheel's headers and archive, without its cloud client, which does not link with GCC 12 and is not wanted. A target of
# our own, since an installation of ours brings the archive along under this name.
find_package(ruckig 0.19 CONFIG REQUIRED)
get_target_property(ruckig_wheel_archive ruckig::ruckig IMPORTED_LOCATION_RELEASE)
set(ruckig_archive "${CMAKE_BINARY_DIR}/libtakt_ruckig.a")
if(NOT EXISTS "${ruckig_archive}" OR "${ruckig_wheel_archive}" IS_NEWER_THAN "${ruckig_archive}"
   OR "${CMAKE_CURRENT_LIST_FILE}" IS_NEWER_THAN "${ruckig_archive}")
  configure_file("${ruckig_wheel_archive}" "${ruckig_archive}" COPYONLY)
  # The client's object holds copies of standard library functions, for which a linker may pull it in.
  execute_process(COMMAND "${CMAKE_AR}" d "${ruckig_archive}" cloud_client.cpp.o COMMAND_ERROR_IS_FATAL ANY)
  # Its elementary functions become those of core/maths_names.cc, which have the same bits on every processor.
  set(renamed "")
  foreach(function acos atan cbrt sincos)
    list(APPEND renamed --redefine-sym ${function}=takt_${function})
  endforeach()
  execute_process(COMMAND "${CMAKE_OBJCOPY}" ${renamed} "${ruckig_archive}" COMMAND_ERROR_IS_FATAL ANY)
  file(TOUCH "${ruckig_archive}")
endif()
get_target_property(ruckig_headers ruckig::ruckig INTERFACE_INCLUDE_DIRECTORIES)
file(GLOB TAKT_RUCKIG_LICENSE "${ruckig_DIR}/../../../ruckig-*.dist-info/licenses/LICENSE")
add_library(takt::ruckig STATIC IMPORTED GLOBAL)
set_target_properties(takt::ruckig PROPERTIES
  IMPORTED_LOCATION "${ruckig_archive}" INTERFACE_INCLUDE_DIRECTORIES "${ruckig_headers}" INTERFACE_LINK_LIBRARIES takt::core)

if(TAKT_BUILD_PYTHON)
  find_package(Python 3.10 COMPONENTS Interpreter Development.Module REQUIRED)
endif()
