# SPDX-License-Identifier: Apache-2.0
# Builds the target `manuals` of the build folder BUILD, installs below SCRATCH, and uses what is installed: every verb of
# VERBS (docs/reference/verbs.md) has a manual page that man reads without a warning, bash completes verbs, options and
# values, and zsh and fish accept their files, when these programs are installed.
file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BUILD} --target manuals OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
set(share ${SCRATCH}/share)

file(STRINGS ${VERBS} headings REGEX "^##+ ")
list(LENGTH headings count)
if(count LESS 20)
  message(FATAL_ERROR "${VERBS} names only ${count} verbs")
endif()
find_program(MAN man)
foreach(heading ${headings})
  string(REGEX REPLACE "^##+ " "" verb "${heading}")
  # The verbs of tactus-bench are another program's.
  if(verb MATCHES "^bench .")
    continue()
  endif()
  string(REPLACE " " "-" name "tactus ${verb}")
  set(page ${share}/man/man1/${name}.1)
  if(NOT EXISTS ${page})
    message(FATAL_ERROR "no manual page of 'tactus ${verb}': ${page}")
  endif()
  if(MAN)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C.UTF-8 MANWIDTH=80 ${MAN} --warnings -l ${page}
                    OUTPUT_VARIABLE text ERROR_VARIABLE warnings COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "\n +" " " flat "${text}")
    if(NOT warnings STREQUAL "" OR NOT flat MATCHES "SYNOPSIS tactus ${verb}")
      message(FATAL_ERROR "${page}: ${warnings}\n${text}")
    endif()
  endif()
endforeach()

find_program(BASH bash REQUIRED)
function(completed expected)
  execute_process(
    COMMAND ${BASH} --norc -c "source $0; complete -p tactus >/dev/null || exit 1
      COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1)); _tactus; echo \"\${COMPREPLY[*]}\""
            ${share}/bash-completion/completions/tactus ${ARGN}
    OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(NOT said STREQUAL expected)
    message(FATAL_ERROR "bash completes '${ARGN}' by '${said}', not by '${expected}'")
  endif()
endfunction()
completed(spectrum tactus spect)
completed(move tactus plan mo)
completed(--overwrite tactus render patch.toml --over)
completed(baseline tactus snap --mode b)
completed(render tactus --memory 2GB rend)

find_program(ZSH zsh)
if(ZSH)
  execute_process(COMMAND ${ZSH} -n ${share}/zsh/site-functions/_tactus COMMAND_ERROR_IS_FATAL ANY)
endif()
find_program(FISH fish)
if(FISH)
  execute_process(COMMAND ${FISH} --no-config -c "source ${share}/fish/vendor_completions.d/tactus.fish; complete -C 'tactus plan mo'"
                  OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  if(NOT said MATCHES "^move")
    message(FATAL_ERROR "fish completes 'tactus plan mo' by '${said}'")
  endif()
endif()
foreach(file zsh/site-functions/_tactus fish/vendor_completions.d/tactus.fish)
  if(NOT EXISTS ${share}/${file})
    message(FATAL_ERROR "not installed: ${file}")
  endif()
endforeach()
file(REMOVE_RECURSE ${SCRATCH})
