// SPDX-License-Identifier: Apache-2.0
// A sound input of a node, and the source of its samples.
#pragma once

#include "dsp/core/time.hpp"
#include "engine/io/sound_card.hpp"
#include "graph/node/sound_input.hpp"

#include <cstdint>
#include <vector>

namespace tactus::io {

struct SoundHeard {
    SoundInPort port;
    int group = -1;
    int id = 0;  ///< within its group
    SoundCard* card = nullptr;  ///< or null: `file`
    int channel = 0;  ///< from 0
    std::vector<float> file;  ///< from activation 0 on

    /// Fills the port for activations first … first + count − 1, which were due at steady time `due_ns`. Group's
    /// thread; wait-free.
    void fill(std::int64_t first, int count, std::int64_t due_ns) noexcept;
};

}  // namespace tactus::io
