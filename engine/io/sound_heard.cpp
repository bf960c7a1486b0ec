// SPDX-License-Identifier: Apache-2.0
#include "engine/io/sound_heard.hpp"

namespace tactus::io {

void SoundHeard::fill(std::int64_t first, int count, std::int64_t due_ns) noexcept {
    port.first = first;
    if (card) return card->hear(channel, first, port.samples.data(), static_cast<std::size_t>(count), due_ns);
    const auto size = static_cast<std::int64_t>(file.size());
    for (std::int64_t i = 0; i < count; ++i) {
        const bool is_there = first + i >= 0 && first + i < size;
        port.samples[static_cast<std::size_t>(i)] = is_there ? file[static_cast<std::size_t>(first + i)] : 0.0F;
    }
}

}  // namespace tactus::io
