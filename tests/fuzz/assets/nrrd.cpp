// SPDX-License-Identifier: Apache-2.0
// Any bytes called .nrrd are a volume with as many samples as it says, or a tactus::Error.
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const tactus::MemoryFile file(data, size, "v.nrrd");
    try {
        const tactus::volume::ScanVolume volume = tactus::volume::read_volume(file.path());
        if (volume.values.size() != volume.count()) std::abort();
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    }
    return 0;
}
