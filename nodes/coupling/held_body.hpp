// SPDX-License-Identifier: Apache-2.0
// Code common to the couplings of a held body: index of the body, its grip, and the fading of forces.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "graph/node/port.hpp"
#include "graph/node/visual.hpp"

#include <algorithm>
#include <utility>

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

/// The wrench of a coupling on the hand. The law keeps the last valid pose of the hand, but its force may not stay while the
/// hand is nowhere.
template <class State>
Wrench felt_of(const State& state) noexcept {
    return state.hand_is_valid ? state.wrench : Wrench{};
}

/// Follows `grasp`: the index of the held body, whether it is still held, and the strength of its force. Where nothing specifies
/// the strength, the force of a released body fades over `fade_time`. A specified strength may take as long as it falls; the
/// time in which it does not is limited to `max_wait`.
struct Hold {
    static constexpr double fade_time = 0.1;  ///< s
    static constexpr double max_wait = 1.0;  ///< s

    int place = -1;
    bool holds = false, taken = false;  ///< taken: grasped in this tick
    double strength = 1.0;
    double left = 0.0;  ///< share of the fade
    double before = 0.0;  ///< the specified strength

    void update(const coupling::Scene& scene, double wanted, const In<bool>& holding, const In<double>& felt,
                double elapsed) noexcept {
        const int now = wanted >= 0.0 && wanted < static_cast<double>(scene.count) ? static_cast<int>(wanted) : -1;
        const bool keeps = now >= 0 && (!holding.connected || holding.get());
        taken = now >= 0 && (now != place || (keeps && !holds));
        place = now;
        holds = keeps;
        const double specified = felt.connected ? felt.get() : 0.0;
        const bool falls = std::exchange(before, specified) > specified;
        if (keeps) left = 1.0;
        else if (!falls) left = std::max(0.0, left - elapsed / (felt.connected ? max_wait : fade_time));
        strength = !felt.connected ? left : now < 0 ? 0.0 : std::min(std::clamp(specified, 0.0, 1.0), left);
        if (!(strength >= 0.0)) strength = 0.0;  // NaN
    }
};

}  // namespace tactus::nodes
