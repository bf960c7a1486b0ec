// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/frame.hpp"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tactus::FrameReader reader;
    for (std::size_t i = 0; i < size; ++i) {
        if (!reader.take(data[i])) continue;
        tactus::SampleFrame sample;
        tactus::DriveFrame drive;
        if (tactus::unpack(reader.frame(), sample) && tactus::unpack(reader.frame(), drive)) std::abort();
        const tactus::FrameBytes again = tactus::encode(reader.frame());
        if (again.size != reader.frame().size + tactus::frame_overhead) std::abort();
    }
    return 0;
}
