# SPDX-License-Identifier: Apache-2.0
# The Debian packages that `./dev package` makes with CPack: one for each component of install().
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tactus)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(TACTUS_MAINTAINER "The Tactus developers <tactus@packages.invalid>" CACHE STRING "whom the packages name")
set(CPACK_PACKAGE_CONTACT ${TACTUS_MAINTAINER})
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_SET_DESTDIR ON)  # the limits for real-time threads lie in /etc
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_OUTPUT_FILE_PREFIX ${CMAKE_BINARY_DIR}/packages)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# libtactus stands in none of the system's folders while dependencies are looked for.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})

set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/compress_manuals.cmake)

# tactus_package(COMPONENT NAME [ARCHITECTURE all] [DEPENDS ...] [CONTROL FILE ...] SUMMARY DESCRIPTION): also its copyright and
# changelog. CONTROL: files of its control archive.
function(tactus_package component name)
  cmake_parse_arguments(PACKAGE "" "ARCHITECTURE;DEPENDS;SECTION;SUMMARY;DESCRIPTION" "CONTROL" ${ARGN})
  string(TOUPPER ${component} upper)
  set(all "set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})\nset(CPACK_COMPONENT_${upper}_DESCRIPTION \"${PACKAGE_SUMMARY}\n${PACKAGE_DESCRIPTION}\")\n")
  if(PACKAGE_ARCHITECTURE)
    string(APPEND all "set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE ${PACKAGE_ARCHITECTURE})\nset(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS OFF)\n")
  endif()
  if(PACKAGE_DEPENDS)
    string(APPEND all "set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS \"${PACKAGE_DEPENDS}\")\n")
  endif()
  if(PACKAGE_CONTROL)
    string(APPEND all "set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA \"${PACKAGE_CONTROL}\")\n")
  endif()
  if(PACKAGE_SECTION)
    string(APPEND all "set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${PACKAGE_SECTION})\n")
  endif()
  set_property(GLOBAL APPEND_STRING PROPERTY tactus_packages "${all}")
  set_property(GLOBAL APPEND PROPERTY tactus_components ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/copyright ${CMAKE_BINARY_DIR}/package/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()

file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${CMAKE_BINARY_DIR}/package/changelog.gz)
file(WRITE ${CMAKE_BINARY_DIR}/package/conffiles "/etc/security/limits.d/tactus-limits.conf\n")
file(WRITE ${CMAKE_BINARY_DIR}/package/triggers "activate-noawait ldconfig\n")
file(WRITE ${CMAKE_BINARY_DIR}/package/shlibs "libtactus ${TACTUS_ABI} libtactus${TACTUS_ABI} (>= ${PROJECT_VERSION})\n")
set(same "(= ${PROJECT_VERSION})")
tactus_package(command tactus DEPENDS "tactus-common ${same}"
  SUMMARY "real-time signal processing for haptics"
  DESCRIPTION " Patches of nodes and wires compute forces at 1 kHz, carve bone at 60 Hz and play\n vibration at audio rate, live with a haptic device or offline with the same bits.\n This package has the command, its window and its benchmarks.")
tactus_package(common tactus-common CONTROL ${CMAKE_BINARY_DIR}/package/conffiles
  SUMMARY "files that the tactus command and its library share"
  DESCRIPTION " Patches, bones, saws and tasks of the library of Tactus, and the programs that run\n drivers and read scans.")
tactus_package(library libtactus${TACTUS_ABI} DEPENDS "tactus-common ${same}" SECTION libs
  CONTROL ${CMAKE_BINARY_DIR}/package/triggers ${CMAKE_BINARY_DIR}/package/shlibs
  SUMMARY "Tactus patches inside other programs"
  DESCRIPTION " The shared library: load a patch, advance it from a loop of one's own or run it\n live, move its hands, read its outputs.")
tactus_package(development libtactus-dev DEPENDS "libtactus${TACTUS_ABI} ${same}, libglm-dev, libfmt-dev" SECTION libdevel
  SUMMARY "headers of libtactus, and the check of nodes"
  DESCRIPTION " The C header tactus.h, the C++ headers of the rooms of Tactus, and files for CMake\n and pkg-config.")
tactus_package(python python3-tactus ARCHITECTURE all DEPENDS "python3, python3-numpy, libtactus${TACTUS_ABI}" SECTION python
  SUMMARY "Tactus in Python"
  DESCRIPTION " Takes as arrays that are mapped from their files, patches as functions, live runs\n from a notebook.")
tactus_package(documentation tactus-doc ARCHITECTURE all SECTION doc
  SUMMARY "documentation of Tactus"
  DESCRIPTION " Tutorials, how-to pages, reference of nodes, verbs and files, and what was measured.")

install(DIRECTORY tools/python/tactus DESTINATION lib/python3/dist-packages COMPONENT python
        FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY docs/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT documentation)
install(FILES cmake/package/70-tactus.rules DESTINATION lib/udev/rules.d COMPONENT common)
install(FILES cmake/package/tactus.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT command)
install(FILES cmake/package/tactus.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT command)
install(FILES cmake/package/tactus.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT command)
install(FILES cmake/package/tactus.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT command)
# Only in a package: elsewhere /etc is the administrator's.
install(FILES cmake/package/tactus-limits.conf DESTINATION /etc/security/limits.d COMPONENT common EXCLUDE_FROM_ALL)

get_property(CPACK_COMPONENTS_ALL GLOBAL PROPERTY tactus_components)
get_property(tactus_packages GLOBAL PROPERTY tactus_packages)
file(WRITE ${CMAKE_BINARY_DIR}/package/components.cmake "${tactus_packages}")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_BINARY_DIR}/package/components.cmake)
include(CPack)
