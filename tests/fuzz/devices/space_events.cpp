// SPDX-License-Identifier: Apache-2.0
#include "devices/spacenav/events.hpp"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using tactus::spacenav::EventReader;
    EventReader whole, pieces;
    whole.take({data, size});
    for (std::size_t i = 0; i < size; ++i) pieces.take({data + i, 1});
    if (whole.state().deflection != pieces.state().deflection || whole.state().buttons != pieces.state().buttons)
        std::abort();
    for (const int deflection : whole.state().deflection)
        if (deflection < -500 || deflection > 500) std::abort();
    return 0;
}
