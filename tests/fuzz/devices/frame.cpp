// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/frame.hpp"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tactus::gripper::FrameReader reader;
    for (std::size_t i = 0; i < size; ++i) {
        if (!reader.take(data[i])) continue;
        tactus::gripper::SampleFrame sample;
        tactus::gripper::DriveFrame drive;
        if (tactus::gripper::unpack(reader.frame(), sample) && tactus::gripper::unpack(reader.frame(), drive))
            std::abort();
        const tactus::gripper::FrameBytes again = tactus::gripper::encode(reader.frame());
        if (again.size != reader.frame().size + tactus::gripper::frame_overhead) std::abort();
    }
    return 0;
}
