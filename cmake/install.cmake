# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where. It needs the targets tactus, tactus-full, tactus-bench and bundled_library.
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME command)
set(installed_library ${CMAKE_INSTALL_DATADIR}/tactus/library)

# tactus_place(DEFINITION DESTINATION SOURCE ...): tells sources how a program, and how a library, comes from its folder to a
# destination, wherever the whole is moved to (assets/file/part.hpp).
function(tactus_place definition destination)
  file(RELATIVE_PATH from_program ${CMAKE_INSTALL_FULL_BINDIR} ${destination})
  file(RELATIVE_PATH from_library ${CMAKE_INSTALL_FULL_LIBDIR} ${destination})
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_DEFINITIONS ${definition}="${from_program}:${from_library}")
endfunction()

tactus_place(TACTUS_INSTALLED_LIBRARY ${CMAKE_INSTALL_FULL_DATADIR}/tactus tools/run/load_plan.cpp)
install(TARGETS tactus tactus-full tactus-bench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Not for users to call: the command finds it from its own place.
install(TARGETS tactus-device-host tactus-scan-decoder RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tactus COMPONENT common)
tactus_place(TACTUS_INSTALLED_PROGRAMS ${CMAKE_INSTALL_FULL_LIBEXECDIR}/tactus
             devices/hosted/host_process.cpp assets/volume/dicom_reader.cpp)

install(TARGETS tactus-openvdb tactus-hdf5 tactus-cairo LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/tactus COMPONENT common)
tactus_place(TACTUS_INSTALLED_MODULES ${CMAKE_INSTALL_FULL_LIBDIR}/tactus assets/file/module.cpp)

# Nodes from outside that all users have.
tactus_place(TACTUS_INSTALLED_NODES ${CMAKE_INSTALL_FULL_LIBDIR}/tactus graph/plugin/plugins.cpp)

install(DIRECTORY assets/library/patches assets/library/displays assets/library/sweeps DESTINATION ${installed_library}
        COMPONENT common FILES_MATCHING PATTERN "*.toml" PATTERN "*.targets")
install(DIRECTORY assets/library/experiments DESTINATION ${installed_library} COMPONENT common)
install(DIRECTORY assets/library/pictures DESTINATION ${installed_library} COMPONENT common FILES_MATCHING PATTERN "*.png")
install(DIRECTORY docs/how-to/patches/ DESTINATION ${installed_library}/examples COMPONENT common FILES_MATCHING PATTERN "*.toml")
# saw-vibration.json is what the commands that made the equaliser printed.
foreach(kind bones cases equalisers saw tasks)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/library/${kind} DESTINATION ${installed_library} COMPONENT common PATTERN "saw-vibration.json" EXCLUDE)
endforeach()

install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN "*.toml")

# Man pages and completions are there when the target `manuals` has been built.
set(manuals ${CMAKE_BINARY_DIR}/manuals)
install(DIRECTORY ${manuals}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} OPTIONAL FILES_MATCHING PATTERN "*.1")
install(FILES ${manuals}/tactus.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME tactus OPTIONAL)
install(FILES ${manuals}/_tactus DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions OPTIONAL)
install(FILES ${manuals}/tactus.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d OPTIONAL)
