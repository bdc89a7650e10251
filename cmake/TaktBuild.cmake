# How every target of the project is built, in one place.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Many sources in one go: half the time, as most of it goes into the headers they share. `./dev test --long` compiles each by itself, too.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_UNITY_BUILD)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
endif()

find_program(TAKT_CCACHE ccache)
if(TAKT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${TAKT_CCACHE}")
endif()

add_library(takt_options INTERFACE)
# No fused multiply-add: the same bits whatever the compiler contracts. -Wrestrict: GCC 12 raises it on std::string's own code (its bug 105651).
target_compile_options(takt_options INTERFACE -Wall -Wextra -Wconversion -Werror $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion;-Wno-missing-braces;-Wno-c99-designator;-Wno-unknown-warning-option> -ffp-contract=off)
if(TAKT_SANITIZE)
  target_compile_definitions(takt_options INTERFACE TAKT_SANITIZED)
endif()
if(TAKT_SANITIZE STREQUAL "address")
  # Without what would be checked at each pointer, which is a third of the time to compile: null pointers fault by themselves.
  target_compile_options(takt_options INTERFACE -fsanitize=address,undefined -fno-sanitize=null,alignment,vptr
                         -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(takt_options INTERFACE -fsanitize=address,undefined)
elseif(TAKT_SANITIZE STREQUAL "thread")
  target_compile_options(takt_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(takt_options INTERFACE -fsanitize=thread)
endif()

# takt_harden(TARGET): what reads the network. Overwritten stacks and indices beyond the end of a container end the program instead of
# being used; tables of addresses are read only once it has started. Not for the cycle's folders, which compute with what was read.
function(takt_harden target)
  if(NOT TAKT_SANITIZE)
    target_compile_options(${target} PRIVATE -fstack-protector-strong -D_GLIBCXX_ASSERTIONS
                           $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>)
  endif()
  target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now,-z,noexecstack)
endfunction()

# takt_folder(NAME DEPENDS a b ... LINK x y ... HEADERS z ...): the folder cpp/takt/NAME becomes the library takt::NAME.
# DEPENDS names other folders (the arrows), LINK names libraries from outside, HEADERS those of them that are headers only, of which
# nothing remains for whoever links with us.
function(takt_folder name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LINK;HEADERS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/takt/${name}/*.cc"
       "${CMAKE_CURRENT_SOURCE_DIR}/takt/${name}/*/*.cc")
  add_library(takt_${name} STATIC ${sources})
  add_library(takt::${name} ALIAS takt_${name})
  set_property(GLOBAL APPEND PROPERTY TAKT_FOLDERS ${name})
  set_target_properties(takt_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(takt_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/cpp> $<INSTALL_INTERFACE:include>)
  target_compile_features(takt_${name} PUBLIC cxx_std_20)
  list(TRANSFORM ARG_DEPENDS PREPEND takt::)
  target_link_libraries(takt_${name} PUBLIC ${ARG_DEPENDS})
  list(TRANSFORM ARG_HEADERS REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(takt_${name} PRIVATE $<BUILD_INTERFACE:takt_options> ${ARG_LINK} ${ARG_HEADERS})
endfunction()
