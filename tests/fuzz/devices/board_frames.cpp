// SPDX-License-Identifier: Apache-2.0
// What boards with motors tell, in both protocols. The first byte chooses; each piece is as long as its first byte says.
#include "devices/board/lines.hpp"
#include "devices/board/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tactus;
    if (size == 0) return 0;
    std::unique_ptr<board::Protocol> protocol;
    if (data[0] % 2 == 0) protocol = std::make_unique<board::FrameProtocol>(2, 115200);
    else protocol = std::make_unique<board::DiyProtocol>(board::DiyProtocol::Settings{});
    const board::Mechanism linkage = board::Mechanism::pantograph(0.05, 0.07, 0.02);
    for (std::size_t at = 1; at < size;) {
        const std::size_t piece = std::min<std::size_t>(data[at] % 32, size - at - 1);
        const std::int64_t silence = data[at] >= 128 ? 10'000'000 : 0;
        protocol->take({data + at + 1, piece}, silence);
        at += 1 + piece;
        const board::Told& told = protocol->told();
        if (!std::isfinite(told.angle[0]) || !std::isfinite(told.angle[1])) std::abort();
        for (const double torque : linkage.torques(told.angle, {1.0, 1.0, 0.0}))
            if (!std::isfinite(torque)) std::abort();
        if (protocol->request({0.1, -0.1}, true).empty()) std::abort();
    }
    return 0;
}
