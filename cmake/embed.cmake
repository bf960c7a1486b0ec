# SPDX-License-Identifier: Apache-2.0
# libtactus: patches inside other programs (tools/embed/tactus.h). It holds the rooms dsp to engine whole, so that C++ programs
# reach all of them. The SONAME has the minor version until 1.0: only the C functions stay compatible.
set(TACTUS_ABI ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
file(GLOB embed CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/embed/*.cpp)
add_library(tactus_embed SHARED ${embed})
set_source_files_properties(tools/embed/c_api.cpp PROPERTIES COMPILE_DEFINITIONS "TACTUS_VERSION=\"${PROJECT_VERSION}\"")
set(rooms_in_library tactus_dsp tactus_assets tactus_graph tactus_devices tactus_nodes tactus_engine)
target_link_libraries(tactus_embed PRIVATE ${rooms_in_library} tactus_tools tactus_flags)
string(REPLACE ";" "," rooms_in_library "${rooms_in_library}")
set_target_properties(tactus_embed PROPERTIES
  OUTPUT_NAME tactus EXPORT_NAME tactus VERSION ${PROJECT_VERSION} SOVERSION ${TACTUS_ABI}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
  LINK_LIBRARY_OVERRIDE "WHOLE_ARCHIVE,${rooms_in_library}"
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exports.map)
# Exported is what is Tactus': of the libraries that are linked in, two of a kind may meet in one program.
target_link_options(tactus_embed PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exports.map -Wl,-Bsymbolic-functions)
# Own headers are <tactus/ROOM/...>; within them the rooms stand without a prefix.
target_include_directories(tactus_embed INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/tools/embed> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tactus>)
add_dependencies(tactus_embed tactus-device-host tactus-scan-decoder)

install(TARGETS tactus_embed EXPORT tactus LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT library NAMELINK_COMPONENT development)
install(FILES tools/embed/tactus.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
foreach(room dsp assets graph devices nodes engine)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus COMPONENT development FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(FILES tools/embed/embedded.hpp tools/embed/host_hand.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/tools/embed COMPONENT development)
install(FILES tools/session/output_folder.hpp tools/session/patch_choice.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/tools/session COMPONENT development)

# find_package(Tactus 0.1) → Tactus::tactus; pkg-config tactus.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Tactus)
install(EXPORT tactus NAMESPACE Tactus:: FILE TactusTargets.cmake DESTINATION ${package} COMPONENT development)
file(WRITE ${CMAKE_BINARY_DIR}/TactusConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/TactusTargets.cmake)\n")
write_basic_package_version_file(${CMAKE_BINARY_DIR}/TactusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/TactusConfig.cmake ${CMAKE_BINARY_DIR}/TactusConfigVersion.cmake DESTINATION ${package}
        COMPONENT development)
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
file(WRITE ${CMAKE_BINARY_DIR}/tactus.pc
"prefix=\${pcfiledir}/${prefix_from_pkgconfig}
libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}
includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}

Name: tactus
Description: Real-time signal processing for haptics
Version: ${PROJECT_VERSION}
Libs: -L\${libdir} -ltactus
Cflags: -I\${includedir}
")
install(FILES ${CMAKE_BINARY_DIR}/tactus.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
