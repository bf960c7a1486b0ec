# SPDX-License-Identifier: Apache-2.0
# cmake -DARCHIVES="A;B" -DOUTPUT=FILE -P identity.cmake: a source with take::build_identity(), a digest of the rooms that compute.
# As an included file, it declares the library with it. All programs of one build have the same.
if(CMAKE_SCRIPT_MODE_FILE)
  set(digests "")
  foreach(archive ${ARCHIVES})
    file(SHA256 ${archive} digest)
    string(APPEND digests ${digest})
  endforeach()
  string(SHA256 digest "${digests}")
  string(SUBSTRING ${digest} 0 16 digest)
  file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// SPDX-License-Identifier: Apache-2.0
// Made by cmake/identity.cmake.
#include \"engine/take/take_writer.hpp\"

namespace tactus::take {

std::string build_identity() { return \"@digest@\"; }

}  // namespace tactus::take
" @ONLY)
  return()
endif()

set(archives "")
foreach(room dsp assets graph devices nodes engine)
  list(APPEND archives $<TARGET_FILE:tactus_${room}>)
endforeach()
set(identity ${TACTUS_GENERATED}/engine/take/build_identity.cpp)
add_custom_command(
  OUTPUT ${identity}
  COMMAND ${CMAKE_COMMAND} "-DARCHIVES=${archives}" -DOUTPUT=${identity} -P ${PROJECT_SOURCE_DIR}/cmake/identity.cmake
  DEPENDS ${archives} ${PROJECT_SOURCE_DIR}/cmake/identity.cmake
  COMMENT "Identifying the build"
  VERBATIM)
add_library(tactus_identity STATIC ${identity})
target_include_directories(tactus_identity PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(tactus_identity PRIVATE tactus_flags)
target_link_libraries(tactus_engine INTERFACE tactus_identity)
