# SPDX-License-Identifier: Apache-2.0
# Flags that every target shares, and tactus_room(): one static library per room.
option(TACTUS_PCH "precompile the headers that most files of a room include (gcc, without sanitizers)" ON)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU OR TACTUS_SANITIZE OR TACTUS_COVERAGE)
  set(TACTUS_PCH OFF)
endif()
option(TACTUS_UNITY "compile several files of a room together (gcc, Release)" ON)
if(NOT TACTUS_PCH OR NOT CMAKE_BUILD_TYPE STREQUAL Release)
  set(TACTUS_UNITY OFF)
endif()
add_library(tactus_flags INTERFACE)
target_compile_options(tactus_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wnon-virtual-dtor -Woverloaded-virtual
  -ffp-contract=off -fno-omit-frame-pointer)
# A program loads the libraries that it calls, not all that its rooms may call.
target_link_options(tactus_flags INTERFACE -Wl,--as-needed)
if(TACTUS_UNITY)
  # A class of one .cpp may have a member of a type of its unnamed namespace (gcc takes the .cpp for a header), and names
  # of one .cpp may be local ones of another. Builds with clang or sanitizers warn of both within a file.
  target_compile_options(tactus_flags INTERFACE -Wno-subobject-linkage -Wshadow=local)
else()
  target_compile_options(tactus_flags INTERFACE -Wshadow)
endif()
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
  # Precompiled headers are part of what ccache compares; it asks to be told that this is wanted. Comments count: `#pragma once`
  # recognises a precompiled header by its bytes, so one that was cached before a comment changed would be read twice.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_COMMENTS=1 ${CCACHE})
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

# tactus_unite(TARGET [PATTERN ...]): files of one folder are compiled as one, ten at a time; a folder of fewer than four joins
# the one above it. Reading headers and instantiating templates is most of the time of each file, and is done once for all of
# them. Files of one folder must not give one name to two things, not even in unnamed namespaces. Files that match a pattern
# are compiled alone.
function(tactus_unite target)
  if(NOT TACTUS_UNITY)
    return()
  endif()
  foreach(pattern ${ARGN})
    file(GLOB_RECURSE alone CONFIGURE_DEPENDS ${pattern})
    set_property(SOURCE ${alone} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  set(folders "")
  foreach(source ${sources})
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${source})
    get_filename_component(folder ${path} DIRECTORY)
    list(APPEND "of_${folder}" ${source})
    while(folder)
      list(APPEND folders ${folder})
      get_filename_component(folder ${folder} DIRECTORY)
    endwhile()
  endforeach()
  list(REMOVE_DUPLICATES folders)
  # The deepest first: those above may get files of them.
  list(SORT folders ORDER DESCENDING)
  foreach(folder ${folders})
    list(LENGTH "of_${folder}" count)
    get_filename_component(above ${folder} DIRECTORY)
    if(above AND count LESS 4)
      list(APPEND "of_${above}" ${of_${folder}})
      continue()
    endif()
    string(MAKE_C_IDENTIFIER ${folder} group)
    set(place 0)
    foreach(source ${of_${folder}})
      math(EXPR tens "${place} / 10")
      math(EXPR place "${place} + 1")
      set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${group}_${tens})
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# tactus_needed(OUT FILE ...): the files of tools that those named need: what they include, and of each header NAME.hpp the
# files NAME.cpp and NAME_*.cpp, of those only what has no header of its own.
function(tactus_needed out)
  set(queue ${ARGN})
  set(found "")
  while(queue)
    list(POP_FRONT queue file)
    if(file IN_LIST found OR NOT EXISTS ${PROJECT_SOURCE_DIR}/${file})
      continue()
    endif()
    list(APPEND found ${file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${file} lines REGEX "^#include \"tools/")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"(.*)\.hpp\".*" "\\1" name ${line})
      list(APPEND queue ${name}.hpp ${name}.cpp)
      file(GLOB parts RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${name}_*.cpp)
      foreach(part ${parts})
        string(REGEX REPLACE "cpp$" "hpp" header ${part})
        if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${header})
          list(APPEND queue ${part})
        endif()
      endforeach()
    endforeach()
  endwhile()
  list(FILTER found INCLUDE REGEX "\\.cpp$")
  list(TRANSFORM found PREPEND ${PROJECT_SOURCE_DIR}/)
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# SOURCES: the files, where they are not all of the room's folder. EXCEPT: files of that folder that another library has.
# PRECOMPILE: headers that most files of the room include, beside those of TACTUS_PCH_HEADERS. A file still names what it uses:
# builds with clang or sanitizers have no precompiled headers and check that. ALONE: patterns of tactus_unite().
function(tactus_room name)
  cmake_parse_arguments(ROOM "OPTIMISE" "" "SOURCES;EXCEPT;LINKS;PRIVATE_LINKS;PRECOMPILE;ALONE" ${ARGN})
  set(sources ${ROOM_SOURCES})
  if(NOT sources)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${name}/*.cpp)
  endif()
  # Programs of their own.
  list(FILTER sources EXCLUDE REGEX "/(main|make_library)\\.cpp$")
  list(FILTER sources EXCLUDE REGEX
       "/tools/(bench|embed)/|/assets/(bone/openvdb|transform/hdf5|volume/decoder)/|/devices/display/cairo/")
  if(ROOM_EXCEPT)
    list(REMOVE_ITEM sources ${ROOM_EXCEPT})
  endif()
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
  tactus_unite(tactus_${name} ${ROOM_ALONE})
endfunction()

# tactus_module(NAME SOURCE ... LINKS ...): a part of the program that file::load_module() loads from beside the program on first
# use, because the libraries that it LINKS take longer to load than most commands run. It does not link its room, whose
# united files would bring the room's other libraries.
function(tactus_module name)
  cmake_parse_arguments(MODULE "" "" "LINKS" ${ARGN})
  add_library(${name} MODULE ${MODULE_UNPARSED_ARGUMENTS})
  set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  target_link_libraries(${name} PRIVATE ${MODULE_LINKS} tactus_flags)
  target_link_options(${name} PRIVATE -Wl,--exclude-libs,ALL)
endfunction()
