# SPDX-License-Identifier: Apache-2.0
# Installs the build folder BUILD below SCRATCH, moves the installation, and renders with it from another folder what
# the built command BUILT renders.
file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/first
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${SCRATCH}/first ${SCRATCH}/moved)

function(output_hash command folder result)
  file(MAKE_DIRECTORY ${folder})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env --unset=TACTUS_LIBRARY ${command} render saw-training --seconds 1 --json --out out
    WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE summary COMMAND_ERROR_IS_FATAL ANY)
  string(JSON hash GET "${summary}" output_hash)
  set(${result} ${hash} PARENT_SCOPE)
endfunction()
output_hash(${SCRATCH}/moved/bin/tactus ${SCRATCH}/here installed)
output_hash(${BUILT} ${SCRATCH}/there built)
if(NOT installed STREQUAL built)
  message(FATAL_ERROR "the installed command renders ${installed}, the built one ${built}")
endif()

foreach(part bin/tactus-bench libexec/tactus/tactus-device-host share/doc/tactus/README.md share/doc/tactus/docs/reference/nodes.md
             share/tactus/library/cases/mandible-twelve/case.plan.json share/tactus/library/equalisers/saw-vibration.toml
             share/tactus/library/displays/mirror.toml share/tactus/library/patches/parts/handle.toml)
  if(NOT EXISTS ${SCRATCH}/moved/${part})
    message(FATAL_ERROR "not installed: ${part}")
  endif()
endforeach()

# The system's loader finds all libraries: the program names no folder of the machine that built it. Libraries that are
# slow to load are those of modules.
find_program(READELF readelf)
if(READELF)
  execute_process(COMMAND ${READELF} -d ${SCRATCH}/moved/bin/tactus OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
  if(dynamic MATCHES "RPATH|RUNPATH")
    message(FATAL_ERROR "the installed command has an rpath:\n${dynamic}")
  endif()
  if(dynamic MATCHES "openvdb")
    message(FATAL_ERROR "the command loads OpenVDB at its start:\n${dynamic}")
  endif()
endif()
# Programs with a patch inside are built with what was installed, and run.
set(ENV{LD_LIBRARY_PATH} ${SCRATCH}/moved/${LIBDIR})
foreach(example embed-c embed-cpp)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${EXAMPLES}/${example} -B ${SCRATCH}/${example} -DCMAKE_PREFIX_PATH=${SCRATCH}/moved
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${SCRATCH}/${example} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "-" "_" program ${example})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=TACTUS_LIBRARY ${SCRATCH}/${example}/${program}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${SCRATCH}/moved/${LIBDIR}/pkgconfig ${PKG_CONFIG} --cflags --libs tactus
                  OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  if(NOT flags MATCHES "-ltactus")
    message(FATAL_ERROR "pkg-config says: ${flags}")
  endif()
endif()
file(REMOVE_RECURSE ${SCRATCH})
