// SPDX-License-Identifier: Apache-2.0
// Any bytes called .vdb are a bone file or a tactus::Error, those with a right seal too.
#include "assets/bone/bone.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (size > 0 && bytes[0] != '#') {
        tactus::Hash hash;
        hash.add_bytes(bytes.data(), bytes.size());
        const std::uint64_t value = hash.value();
        bytes += "TACTUSBONE000001";
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    const tactus::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), "b.vdb");
    try {
        tactus::load_bones(file.path());
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    }
    return 0;
}
