# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=TREE -DVERSION=0.1.0 -DOUTPUT=FILE -P abi.cmake: the header that identifies the headers of nodes, by a digest of
# those in graph/node and of all that they include. Comments do not count. As an included file, it declares how it is made.
if(CMAKE_SCRIPT_MODE_FILE)
  cmake_policy(VERSION 3.25)
  file(GLOB waiting RELATIVE ${SOURCE} ${SOURCE}/graph/node/*.hpp)
  set(seen graph/node/abi_headers.hpp)
  while(waiting)
    list(POP_FRONT waiting header)
    if(header IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${header})
    file(STRINGS ${SOURCE}/${header} lines REGEX "^#include \"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" name "${line}")
      list(APPEND waiting ${name})
    endforeach()
  endwhile()
  list(POP_FRONT seen)
  list(SORT seen)
  set(digests "")
  foreach(header ${seen})
    file(READ ${SOURCE}/${header} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REGEX REPLACE "[ \n]+" " " text "${text}")
    string(SHA256 digest "${text}")
    string(APPEND digests "${header} ${digest}\n")
  endforeach()
  string(SHA256 digest "${digests}")
  string(SUBSTRING ${digest} 0 16 digest)
  file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// SPDX-License-Identifier: Apache-2.0
// Made by cmake/abi.cmake.
#pragma once

#define TACTUS_ABI_HEADERS \"@VERSION@-@digest@\"
" @ONLY)
  return()
endif()

set(TACTUS_GENERATED ${CMAKE_BINARY_DIR}/generated)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS dsp/*.hpp assets/*.hpp graph/*.hpp)
add_custom_command(
  OUTPUT ${TACTUS_GENERATED}/graph/node/abi_headers.hpp
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
          -DOUTPUT=${TACTUS_GENERATED}/graph/node/abi_headers.hpp -P ${PROJECT_SOURCE_DIR}/cmake/abi.cmake
  DEPENDS ${headers} cmake/abi.cmake
  COMMENT "Identifying the headers of nodes"
  VERBATIM)
add_custom_target(abi_headers DEPENDS ${TACTUS_GENERATED}/graph/node/abi_headers.hpp)
