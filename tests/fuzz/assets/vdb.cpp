// SPDX-License-Identifier: Apache-2.0
// Any bytes called .vdb are a bone file or a tactus::Error. Behind a checksum that was forged OpenVDB would allocate
// whatever it reads; bone files are opened only when their seal is right, which chance does not give. So no mutated bytes
// are sealed anew here.
#include "assets/bone/bone.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const tactus::MemoryFile file(data, size, "b.vdb");
    try {
        tactus::load_bones(file.path());
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    }
    return 0;
}
