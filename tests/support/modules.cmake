# SPDX-License-Identifier: Apache-2.0
# Modules that test programs load on first use.
include_guard(GLOBAL)

# The product's modules are loaded from beside the program.
foreach(folder tests tests/bench tests/campaign tests/fuzz)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/${folder})
  foreach(module openvdb hdf5 cairo)
    file(CREATE_LINK ${CMAKE_BINARY_DIR}/tactus-${module}.so ${CMAKE_BINARY_DIR}/${folder}/tactus-${module}.so SYMBOLIC)
  endforeach()
endforeach()

# Loaded by bone_files.cpp.
add_library(repacked_bone MODULE ${CMAKE_CURRENT_LIST_DIR}/repacked_bone.cpp)
target_link_libraries(repacked_bone PRIVATE OpenVDB::openvdb tactus_flags)
