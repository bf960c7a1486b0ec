# SPDX-License-Identifier: Apache-2.0
# The library stands beside the command: patches, tasks, experiments, sweeps and display files copied from assets/library, bones and recordings computed.
foreach(kind patches displays tasks experiments sweeps)
  set(folder ${PROJECT_SOURCE_DIR}/assets/library/${kind})
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.toml ${folder}/*.targets)
  foreach(file ${files})
    configure_file(${folder}/${file} ${CMAKE_BINARY_DIR}/library/${kind}/${file} COPYONLY)
  endforeach()
endforeach()

# Small pictures of the patches, for the window's first page.
file(GLOB pictures CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/assets/library/pictures/*.png)
foreach(file ${pictures})
  get_filename_component(name ${file} NAME)
  configure_file(${file} ${CMAKE_BINARY_DIR}/library/pictures/${name} COPYONLY)
endforeach()

# The gallery: small patches that `tactus new` copies.
file(GLOB examples CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/how-to/patches/*.toml)
foreach(file ${examples})
  get_filename_component(name ${file} NAME)
  configure_file(${file} ${CMAKE_BINARY_DIR}/library/examples/${name} COPYONLY)
endforeach()

# The bone and the saw that come with Tactus are computed, not kept; again only when their generator has changed.
add_executable(make_library tools/make_library.cpp)
target_link_libraries(make_library PRIVATE tactus_assets tactus_flags)
add_custom_command(
  OUTPUT ${CMAKE_BINARY_DIR}/library/bones/mandible.vdb ${CMAKE_BINARY_DIR}/library/bones/fragments.vdb ${CMAKE_BINARY_DIR}/library/bones/fibula.vdb ${CMAKE_BINARY_DIR}/library/tasks/mandible-canal.nrrd ${CMAKE_BINARY_DIR}/library/tasks/fibula-vessels.nrrd ${CMAKE_BINARY_DIR}/library/cases/mandible-twelve/case.plan.json ${CMAKE_BINARY_DIR}/library/cases/fibula-flap/case.plan.json ${CMAKE_BINARY_DIR}/library/saw/reciprocating.toml
  # OpenVDB and TBB are not instrumented; elsewhere the variable means nothing.
  COMMAND ${CMAKE_COMMAND} -E env TSAN_OPTIONS=ignore_noninstrumented_modules=1 $<TARGET_FILE:make_library> ${CMAKE_BINARY_DIR}/library
  DEPENDS make_library
  COMMENT "Computing the bundled bone and saw"
  VERBATIM)

# The equaliser of the bundled actuator, by the commands that a user has.
set(equaliser ${CMAKE_BINARY_DIR}/library/equalisers/saw-vibration)
add_custom_command(
  OUTPUT ${equaliser}.toml
  COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/library/equalisers
  COMMAND ${CMAKE_COMMAND} -E env TSAN_OPTIONS=ignore_noninstrumented_modules=1 $<TARGET_FILE:tactus> measure
          saw-vibration --in actuator.drive --probe handle.out --amplitude 100 -o ${equaliser}.csv --json > ${equaliser}.json
  COMMAND ${CMAKE_COMMAND} -E env TSAN_OPTIONS=ignore_noninstrumented_modules=1 $<TARGET_FILE:tactus> equalise
          ${equaliser}.csv -o ${equaliser}.toml --kind linear --volts 0.004 --json >> ${equaliser}.json
  DEPENDS tactus ${PROJECT_SOURCE_DIR}/assets/library/patches/saw-vibration.toml ${PROJECT_SOURCE_DIR}/assets/library/patches/parts/handle.toml
  COMMENT "Measuring the bundled actuator and making its equaliser"
  VERBATIM)

add_custom_target(bundled_library ALL
  DEPENDS ${CMAKE_BINARY_DIR}/library/bones/mandible.vdb ${CMAKE_BINARY_DIR}/library/bones/fragments.vdb ${CMAKE_BINARY_DIR}/library/bones/fibula.vdb ${CMAKE_BINARY_DIR}/library/tasks/mandible-canal.nrrd ${CMAKE_BINARY_DIR}/library/tasks/fibula-vessels.nrrd ${CMAKE_BINARY_DIR}/library/cases/mandible-twelve/case.plan.json ${CMAKE_BINARY_DIR}/library/cases/fibula-flap/case.plan.json ${CMAKE_BINARY_DIR}/library/saw/reciprocating.toml ${equaliser}.toml)
