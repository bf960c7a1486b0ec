// SPDX-License-Identifier: Apache-2.0
// Code common to the couplings of a held body: index of the body, its grip, and the fading of forces.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "graph/node/port.hpp"
#include "graph/node/visual.hpp"

#include <algorithm>

namespace tactus::nodes {

/// Visual of a coupling: the body that it holds in a scene, in the hand at `device`.
inline Visual held_visual(double held, const Vec3& grip_at = Vec3(0.0)) {
    return {.kind = VisualKind::held,
            .scene = "scene",
            .place = "held",
            .pose = "pose",
            .hand = "device",
            .grip = "grip",
            .force = "wrench",
            .at = grip_at,
            .held = held};
}

/// Follows `grasp`: the index of the held body, whether it is still held, and the strength of its force. Where nothing states
/// the strength, the force of a body that is let go fades over `fade_time`.
struct Hold {
    static constexpr double fade_time = 0.1;  ///< s

    int place = -1;
    bool holds = false, taken = false;  ///< taken: grasped in this tick
    double strength = 1.0;
    double left = 0.0;  ///< share of the fade

    void update(const coupling::Scene& scene, double wanted, const In<bool>& holding, const In<double>& felt,
                double elapsed) noexcept {
        const int now = wanted >= 0.0 && wanted < static_cast<double>(scene.count) ? static_cast<int>(wanted) : -1;
        const bool keeps = now >= 0 && (!holding.connected || holding.get());
        taken = now >= 0 && (now != place || (keeps && !holds));
        place = now;
        holds = keeps;
        left = keeps ? 1.0 : std::max(0.0, left - elapsed / fade_time);
        strength = !felt.connected ? left : now < 0 ? 0.0 : std::clamp(felt.get(), 0.0, 1.0);
        if (!(strength >= 0.0)) strength = 0.0;  // NaN
    }
};

}  // namespace tactus::nodes
