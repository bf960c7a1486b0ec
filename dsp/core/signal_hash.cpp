// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/signal_hash.hpp"

#include <algorithm>

namespace tactus {

void SignalHash::add(std::uint64_t position, const float* samples, std::size_t count) noexcept {
    while (count > 0) {
        const std::size_t at = position % window, now = std::min(count, window - at);
        const std::uint32_t* key = keys.data() + at;
        std::uint64_t total = 0;
        for (std::size_t i = 0; i < now; ++i) total += std::uint64_t{std::bit_cast<std::uint32_t>(samples[i])} * key[i];
        sum += total;
        if (at + now == window) close();
        position += now;
        samples += now;
        count -= now;
    }
}

}  // namespace tactus
