// SPDX-License-Identifier: Apache-2.0
// What a host that hears offers to nodes: channels of a sound card, sample by sample with the outputs of that card.
#pragma once

#include "graph/node/setup.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus {

/// A channel that is heard. The engine fills it before the nodes of a call run.
struct SoundInPort {
    std::int64_t first = 0;  ///< activation of the first sample
    std::vector<float> samples;  ///< of the activations of this call; full scale ±1
};

/// A `Host` may be one: ask it by dynamic_cast.
class SoundInputs {
public:
    virtual ~SoundInputs() = default;
    /// A channel of a card in a live run; without a card `instead`, the samples from activation 0 on, silence after them.
    /// `place.channel` is from 1. Throws Error when there is neither.
    virtual const SoundInPort& listen(const SoundPlace& place, Flicks period,
                                      std::optional<std::vector<float>> instead) = 0;
};

}  // namespace tactus
