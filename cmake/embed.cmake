# SPDX-License-Identifier: Apache-2.0
# libtactus: patches inside other programs (tools/embed/tactus.h). It holds the rooms dsp to engine whole, so that C++ programs
# reach all of them. The SONAME has the minor version until 1.0: only the C functions stay compatible.
set(TACTUS_ABI ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
file(GLOB embed CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/embed/*.cpp)
add_library(tactus_embed SHARED ${embed})
set_source_files_properties(tools/embed/c_api.cpp PROPERTIES COMPILE_DEFINITIONS "TACTUS_VERSION=\"${PROJECT_VERSION}\"")
tactus_precompile(tactus_embed <filesystem> <fmt/format.h> <functional> <map> ${PROJECT_SOURCE_DIR}/graph/node/node.hpp)
set(rooms_in_library tactus_dsp tactus_assets tactus_graph tactus_devices tactus_nodes tactus_engine)
# The objects, not the archives: of these the linker would take what the C functions need.
foreach(room ${rooms_in_library})
  target_sources(tactus_embed PRIVATE $<TARGET_OBJECTS:${room}>)
endforeach()
target_link_libraries(tactus_embed PRIVATE ${rooms_in_library} tactus_tools tactus_flags)
set_target_properties(tactus_embed PROPERTIES
  OUTPUT_NAME tactus EXPORT_NAME tactus VERSION ${PROJECT_VERSION} SOVERSION ${TACTUS_ABI}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exports.map)
# Exported is what is Tactus': of the libraries that are linked in, two of a kind may meet in one program.
target_link_options(tactus_embed PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exports.map -Wl,-Bsymbolic-functions)
# Own headers are <tactus/ROOM/...>; within them the rooms stand without a prefix.
target_include_directories(tactus_embed INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/tools/embed> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tactus>)
add_dependencies(tactus_embed tactus-device-host tactus-scan-decoder)

# Tactus::node: how a plug-in with nodes is compiled. It links nothing: its functions are those of the program that loads it. Names
# that it shares with Tactus, as of a struct Gain, stay its own when they are hidden.
add_library(tactus_node INTERFACE)
add_dependencies(tactus_node abi_headers)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/as_installed)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/as_installed/tactus SYMBOLIC)
set_target_properties(tactus_node PROPERTIES EXPORT_NAME node)
target_include_directories(tactus_node INTERFACE
  $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/as_installed> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${TACTUS_GENERATED}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tactus>)
target_compile_features(tactus_node INTERFACE cxx_std_20)
target_compile_options(tactus_node INTERFACE -ffp-contract=off -fvisibility=hidden -fvisibility-inlines-hidden
  # An error in the list of members names that line only.
  $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique;-ftrack-macro-expansion=0>)

# tactus-check-node FILE.so: what the tests check of the nodes of the tree.
add_executable(tactus-check-node tests/check_node/main.cpp tests/check_node/node_checks.cpp
  tests/support/node_harness.cpp tests/support/node_values.cpp tests/support/sample_assets.cpp tests/support/realtime_check.cpp
  tests/support/realtime_counters.cpp tests/support/refused_threads.cpp tests/support/system_call_trap.cpp
  tests/support/virtual_clock.cpp)
target_include_directories(tactus-check-node PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(tactus-check-node PRIVATE tactus_embed glm::glm fmt::fmt tactus_flags ${CMAKE_DL_LIBS} Threads::Threads)
target_compile_options(tactus-check-node PRIVATE $<$<CONFIG:Release>:-O1>)
file(RELATIVE_PATH library_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set_target_properties(tactus-check-node PROPERTIES EXPORT_NAME check-node RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
  INSTALL_RPATH "$ORIGIN/${library_from_bin}")
add_executable(Tactus::check-node ALIAS tactus-check-node)
install(TARGETS tactus-check-node EXPORT tactus RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT development)

install(TARGETS tactus_node EXPORT tactus)
install(TARGETS tactus_embed EXPORT tactus LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT library NAMELINK_COMPONENT development)
install(FILES tools/embed/tactus.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
foreach(room dsp assets graph devices nodes engine)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus COMPONENT development FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(FILES ${TACTUS_GENERATED}/graph/node/abi_headers.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/graph/node COMPONENT development)
install(FILES tools/embed/embedded.hpp tools/embed/host_hand.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/tools/embed COMPONENT development)
install(FILES tools/run/output_folder.hpp tools/run/patch_choice.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/tools/run COMPONENT development)

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
