// SPDX-License-Identifier: Apache-2.0
// Any bytes called .vdb are a bone file or a tactus::Error, with a seal that fits them: anyone can compute one.
#include "assets/bone/bone.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/support/bone_files.hpp"

#include <algorithm>
#include <new>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t seal = 24;
    const std::string bytes = tactus::test::sealed({reinterpret_cast<const char*>(data), size - std::min(size, seal)});
    const tactus::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), "b.vdb");
    try {
        tactus::bone::load_bones(file.path());
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    } catch (const std::bad_alloc&) {
        // More than the machine has room for.
    }
    return 0;
}
