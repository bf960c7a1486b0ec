# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where. It needs the targets tactus, tactus-bench and bundled_library.
include(GNUInstallDirs)
set(installed_library ${CMAKE_INSTALL_DATADIR}/tactus/library)

# How the command in its folder comes to the library, wherever the whole is moved to.
file(RELATIVE_PATH library_from_command ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/tactus/library)
set_property(SOURCE tools/session/load_plan.cpp APPEND PROPERTY
             COMPILE_DEFINITIONS TACTUS_INSTALLED_LIBRARY="${library_from_command}")

install(TARGETS tactus tactus-bench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Not for users to call: the command finds it from its own place.
install(TARGETS tactus-device-host tactus-scan-decoder RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tactus)
file(RELATIVE_PATH programs_from_command ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBEXECDIR}/tactus)
set_property(SOURCE devices/hosted/host_process.cpp assets/volume/dicom_reader.cpp APPEND PROPERTY
             COMPILE_DEFINITIONS TACTUS_INSTALLED_PROGRAMS="${programs_from_command}")

install(TARGETS tactus-openvdb LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/tactus)
file(RELATIVE_PATH modules_from_command ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/tactus)
set_property(SOURCE assets/file/module.cpp APPEND PROPERTY
             COMPILE_DEFINITIONS TACTUS_INSTALLED_MODULES="${modules_from_command}")

install(DIRECTORY assets/library/patches assets/library/displays DESTINATION ${installed_library}
        FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY assets/library/pictures DESTINATION ${installed_library} FILES_MATCHING PATTERN "*.png")
install(DIRECTORY docs/how-to/patches/ DESTINATION ${installed_library}/examples FILES_MATCHING PATTERN "*.toml")
# saw-vibration.json is what the commands that made the equaliser printed.
foreach(kind bones cases equalisers saw tasks)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/library/${kind} DESTINATION ${installed_library} PATTERN "saw-vibration.json" EXCLUDE)
endforeach()

install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN "*.toml")

# Man pages and completions are there when the target `manuals` has been built.
set(manuals ${CMAKE_BINARY_DIR}/manuals)
install(DIRECTORY ${manuals}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} OPTIONAL FILES_MATCHING PATTERN "*.1")
install(FILES ${manuals}/tactus.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME tactus OPTIONAL)
install(FILES ${manuals}/_tactus DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions OPTIONAL)
install(FILES ${manuals}/tactus.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d OPTIONAL)
