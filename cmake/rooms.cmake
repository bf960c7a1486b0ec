# SPDX-License-Identifier: Apache-2.0
# Flags that every target shares, and tactus_room(): one static library per room.
add_library(tactus_flags INTERFACE)
target_compile_options(tactus_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  -ffp-contract=off -fno-omit-frame-pointer)
if(TACTUS_WERROR)
  target_compile_options(tactus_flags INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  # Boost 1.74's MPL, reached through OpenVDB, casts out-of-range constants to an enum.
  target_compile_options(tactus_flags INTERFACE -Wno-enum-constexpr-conversion
    # libstdc++ 12 implements std::stable_sort with std::get_temporary_buffer, which C++17 deprecates.
    -Wno-deprecated-declarations)
endif()
if(TACTUS_SANITIZE)
  target_compile_options(tactus_flags INTERFACE -fsanitize=${TACTUS_SANITIZE} -fno-sanitize-recover=all)
  target_link_options(tactus_flags INTERFACE -fsanitize=${TACTUS_SANITIZE})
  # The check of virtual calls asks the kernel (through a pipe) whether an object can be read, in the middle of a tick.
  target_compile_options(tactus_flags INTERFACE -fno-sanitize=vptr
    # GCC 12 takes the states of std::regex for uninitialised under AddressSanitizer.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
    # Clang takes no values together in loops that a sanitizer watches, and says so where one asks for it.
    $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>)
endif()
if(TACTUS_FUZZ)
  target_compile_options(tactus_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(TACTUS_COVERAGE)
  target_compile_options(tactus_flags INTERFACE --coverage)
  target_link_options(tactus_flags INTERFACE --coverage)
endif()
find_program(CCACHE ccache)
if(CCACHE)
  # Precompiled headers are part of what ccache compares; it asks to be told that this is wanted.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
option(TACTUS_PCH "precompile the headers that most files of a room include (gcc, without sanitizers)" ON)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU OR TACTUS_SANITIZE OR TACTUS_COVERAGE)
  set(TACTUS_PCH OFF)
endif()
# Reading the standard library, fmt and GLM takes as long as compiling what a file of ours says.
set(TACTUS_PCH_HEADERS <algorithm> <array> <cmath> <cstring> <memory> <numbers> <optional> <span> <string> <string_view> <vector>
  ${PROJECT_SOURCE_DIR}/dsp/core/error.hpp ${PROJECT_SOURCE_DIR}/dsp/core/types.hpp)
find_program(MOLD mold)
if(MOLD)
  target_link_options(tactus_flags INTERFACE -fuse-ld=mold)
endif()

# tactus_precompile(TARGET [HEADER ...])
function(tactus_precompile target)
  if(NOT TACTUS_PCH)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE ${TACTUS_PCH_HEADERS} ${ARGN})
  # gcc 12 no longer knows precompiled code as that of a system header, and finds faults in std::string that are none.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>)
endfunction()

# PRECOMPILE: headers that most files of the room include, beside those of TACTUS_PCH_HEADERS. A file still names what it uses:
# builds with clang or sanitizers have no precompiled headers and check that.
function(tactus_room name)
  cmake_parse_arguments(ROOM "OPTIMISE" "" "LINKS;PRIVATE_LINKS;PRECOMPILE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${name}/*.cpp)
  # Programs of their own.
  list(FILTER sources EXCLUDE REGEX "/(main|make_library)\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "/tools/bench/")
  if(NOT sources)
    file(WRITE ${CMAKE_BINARY_DIR}/empty_${name}.cpp "")
    set(sources ${CMAKE_BINARY_DIR}/empty_${name}.cpp)
  endif()
  add_library(tactus_${name} STATIC ${sources})
  target_include_directories(tactus_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(tactus_${name} PUBLIC ${ROOM_LINKS} fmt::fmt PRIVATE tactus_flags ${ROOM_PRIVATE_LINKS})
  if(ROOM_OPTIMISE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    target_compile_options(tactus_${name} PRIVATE -O3)
  endif()
  tactus_precompile(tactus_${name} ${ROOM_PRECOMPILE})
endfunction()

# Sources whose speed does not matter: a sixth of their compile time goes into -O2. Numbers are the same at any level.
function(tactus_compile_fast)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    return()
  endif()
  foreach(folder ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    set_property(SOURCE ${sources} APPEND PROPERTY COMPILE_OPTIONS -O1)
  endforeach()
endfunction()
