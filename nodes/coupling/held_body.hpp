// SPDX-License-Identifier: Apache-2.0
// What the couplings of a held body share: which body, where it is gripped, and how forces come and go.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "graph/node/port.hpp"

#include <algorithm>

namespace tactus::nodes {

/// Follows `grasp`: which place of the scene is held, whether it still is, and with what strength its force is felt.
struct Hold {
    int place = -1;
    bool holds = false, taken = false;  ///< taken: in this tick
    double strength = 1.0;

    void update(const coupling::Scene& scene, double wanted, const In<bool>& holding, const In<double>& felt) noexcept {
        const int now = wanted >= 0.0 && wanted < static_cast<double>(scene.count) ? static_cast<int>(wanted) : -1;
        const bool keeps = now >= 0 && (!holding.connected || holding.get());
        taken = now >= 0 && (now != place || (keeps && !holds));
        place = now;
        holds = keeps;
        strength = now < 0 ? 0.0 : felt.connected ? std::clamp(felt.get(), 0.0, 1.0) : 1.0;
        if (!(strength >= 0.0)) strength = 0.0;  // not a number
    }
};

}  // namespace tactus::nodes
