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

foreach(part bin/tactus-full bin/tactus-bench libexec/tactus/tactus-device-host share/doc/tactus/README.md share/doc/tactus/docs/reference/nodes.md
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
  foreach(program tactus tactus-full)
    execute_process(COMMAND ${READELF} -d ${SCRATCH}/moved/bin/${program} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
    if(dynamic MATCHES "RPATH|RUNPATH")
      message(FATAL_ERROR "the installed ${program} has an rpath:\n${dynamic}")
    endif()
    if(dynamic MATCHES "openvdb" OR (program STREQUAL "tactus" AND dynamic MATCHES "glfw|imgui"))
      message(FATAL_ERROR "${program} loads at its start what few runs need:\n${dynamic}")
    endif()
  endforeach()
endif()
# Programs with a patch inside are built with what was installed, and run.
set(ENV{LD_LIBRARY_PATH} ${SCRATCH}/moved/${LIBDIR})
function(build_project source folder)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${folder} -DCMAKE_PREFIX_PATH=${SCRATCH}/moved
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${folder} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()
foreach(example embed-c embed-cpp)
  build_project(${EXAMPLES}/${example} ${SCRATCH}/${example})
  string(REPLACE "-" "_" program ${example})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=TACTUS_LIBRARY ${SCRATCH}/${example}/${program}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
# C# calls the same library, where Mono is installed.
find_program(MCS mcs)
find_program(MONO mono)
if(MCS AND MONO)
  file(GLOB csharp ${EXAMPLES}/unity/*.cs)
  execute_process(COMMAND ${MCS} -warnaserror -out:${SCRATCH}/unity.exe ${csharp} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=TACTUS_LIBRARY ${MONO} ${SCRATCH}/unity.exe OUTPUT_VARIABLE said
                  COMMAND_ERROR_IS_FATAL ANY)
  if(NOT said MATCHES "did you mean 'stiffness'")
    message(FATAL_ERROR "an error of a patch did not reach C#:\n${said}")
  endif()
endif()
# Nodes from outside: an example, and the project that the command writes. They are built against the installed headers, checked by
# the installed program, and run.
unset(ENV{TACTUS_LIBRARY})
unset(ENV{TACTUS_NODES})
set(tactus ${SCRATCH}/moved/bin/tactus)
build_project(${EXAMPLES}/node ${SCRATCH}/node)
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${SCRATCH}/node --output-on-failure OUTPUT_VARIABLE said RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the node of docs/examples/node fails its tests:\n${said}")
endif()
execute_process(COMMAND ${tactus} render ${EXAMPLES}/node/patch.toml --seconds 2 --json --out out --nodes ${SCRATCH}/node/granulate.so
                WORKING_DIRECTORY ${SCRATCH} OUTPUT_VARIABLE summary COMMAND_ERROR_IS_FATAL ANY)
string(JSON grains GET "${summary}" granulate grains)
# 100 mm of strokes over grains 2 mm apart.
if(grains LESS 40 OR grains GREATER 60)
  message(FATAL_ERROR "a hand passed ${grains} grains")
endif()
execute_process(COMMAND ${tactus} nodes --new my_gain WORKING_DIRECTORY ${SCRATCH} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
build_project(${SCRATCH}/my_gain ${SCRATCH}/my_gain/build)
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${SCRATCH}/my_gain/build --output-on-failure OUTPUT_VARIABLE said RESULT_VARIABLE code)
if(NOT code EQUAL 0 OR NOT said MATCHES "100% tests passed, 0 tests failed out of 2")
  message(FATAL_ERROR "the project of a new node fails its tests:\n${said}")
endif()
# The installed checker finds the library beside it.
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=LD_LIBRARY_PATH ${SCRATCH}/moved/bin/tactus-check-node
                        ${SCRATCH}/my_gain/build/my_gain.so
                OUTPUT_VARIABLE said ERROR_VARIABLE complaints RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the installed tactus-check-node ends with ${code}:\n${said}${complaints}")
endif()
# The folder of all users.
file(INSTALL ${SCRATCH}/my_gain/build/my_gain.so DESTINATION ${SCRATCH}/moved/${LIBDIR}/tactus/nodes)
execute_process(COMMAND ${tactus} nodes my_gain OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "my_gain 0.1, ${SCRATCH}/moved/${LIBDIR}/tactus/nodes/my_gain.so")
  message(FATAL_ERROR "a node in the installed folder is not listed:\n${said}")
endif()

# A driver from outside, in a process of its own, with an arm that presses on a ball until it feels it.
find_program(PYTHON python3)
if(PYTHON)
  build_project(${EXAMPLES}/driver ${SCRATCH}/driver)
  set(ENV{TACTUS_DEVICE_HOST} ${SCRATCH}/driver/udp_arm)
  string(RANDOM LENGTH 4 ALPHABET 0123456789 port)
  execute_process(COMMAND ${tactus} run ${EXAMPLES}/driver/patch.toml --set arm.port=4${port} --seconds 5 --out run
                  COMMAND ${PYTHON} ${EXAMPLES}/driver/arm.py 4${port}
                  WORKING_DIRECTORY ${SCRATCH} OUTPUT_VARIABLE said ERROR_VARIABLE complaints RESULTS_VARIABLE codes)
  if(NOT codes STREQUAL "0;0")
    message(FATAL_ERROR "an arm behind a driver from outside: exit codes ${codes}\n${said}\n${complaints}")
  endif()
  unset(ENV{TACTUS_DEVICE_HOST})
endif()
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${SCRATCH}/moved/${LIBDIR}/pkgconfig ${PKG_CONFIG} --cflags --libs tactus
                  OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  if(NOT flags MATCHES "-ltactus")
    message(FATAL_ERROR "pkg-config says: ${flags}")
  endif()
endif()
file(REMOVE_RECURSE ${SCRATCH})
