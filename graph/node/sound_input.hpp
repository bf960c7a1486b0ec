// SPDX-License-Identifier: Apache-2.0
// Sound input: channels of a sound card, synchronous to the sample with the outputs of that card.
#pragma once

#include "graph/node/setup.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus {

/// A recorded channel. The engine fills it before the nodes of a call run.
struct SoundInPort {
    std::int64_t first = 0;  ///< activation of the first sample
    std::vector<float> samples;  ///< of the activations of this call; full scale ±1
};

/// Optional interface of a `Host`: obtain it by dynamic_cast.
class SoundInputs {
public:
    virtual ~SoundInputs() = default;
    /// Returns a channel of a card in a live run. Without a card it plays the samples `instead` from activation 0,
    /// followed by silence. `place.channel` counts from 1. Throws Error if there is neither.
    virtual const SoundInPort& listen(const SoundPlace& place, Flicks period,
                                      std::optional<std::vector<float>> instead) = 0;
};

}  // namespace tactus
