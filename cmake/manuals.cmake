# SPDX-License-Identifier: Apache-2.0
# `manuals`: manual pages and shell completions, written by the command from its own declarations.
set(manuals ${CMAKE_BINARY_DIR}/manuals)
add_custom_command(
  OUTPUT ${manuals}/man1/tactus.1 ${manuals}/tactus.bash ${manuals}/_tactus ${manuals}/tactus.fish
  # Pages of verbs that are gone must not stay.
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${manuals}
  COMMAND $<TARGET_FILE:tactus-full> generate man ${manuals}/man1
  COMMAND $<TARGET_FILE:tactus-full> generate bash ${manuals}
  COMMAND $<TARGET_FILE:tactus-full> generate zsh ${manuals}
  COMMAND $<TARGET_FILE:tactus-full> generate fish ${manuals}
  DEPENDS tactus-full
  COMMENT "Writing manual pages and completions"
  VERBATIM)
add_custom_target(manuals
  DEPENDS ${manuals}/man1/tactus.1 ${manuals}/tactus.bash ${manuals}/_tactus ${manuals}/tactus.fish)
