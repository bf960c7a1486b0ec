# SPDX-License-Identifier: Apache-2.0
# Where the command finds the bundled patches, bones and recordings when it runs from the build tree.
target_compile_definitions(tactus_tools PRIVATE
  TACTUS_SOURCE_LIBRARY="${PROJECT_SOURCE_DIR}/assets/library"
  TACTUS_BUILD_LIBRARY="${CMAKE_BINARY_DIR}/library")
