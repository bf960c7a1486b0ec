// SPDX-License-Identifier: Apache-2.0
// Any bytes called .stl are a mesh or a tactus::Error.
#include "tests/fuzz/mesh_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tactus::try_mesh(data, size, "m.stl");
    return 0;
}
