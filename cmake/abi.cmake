# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=TREE -DVERSION=0.1.0 -DOUTPUT=FILE -P abi.cmake: the header that identifies the headers of nodes, by a digest of
# all in the rooms whose functions a plug-in may call. Comments do not count. As an included file, it declares how it is made.
if(CMAKE_SCRIPT_MODE_FILE)
  cmake_policy(VERSION 3.25)
  file(GLOB_RECURSE headers RELATIVE ${SOURCE} ${SOURCE}/dsp/*.hpp ${SOURCE}/assets/*.hpp ${SOURCE}/graph/*.hpp)
  list(SORT headers)
  set(digests "")
  foreach(header ${headers})
    file(READ ${SOURCE}/${header} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REGEX REPLACE "[ \n]+" " " text "${text}")
    string(STRIP "${text}" text)
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
