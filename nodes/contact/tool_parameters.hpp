// SPDX-License-Identifier: Apache-2.0
// Code common to the tools that cut bone.
#pragma once

#include "dsp/contact/contact_switch.hpp"
#include "dsp/saw/hand_limits.hpp"
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::nodes {

inline constexpr const char* tool_waits = "the tool lies in bone and has no force until it is drawn out";
inline constexpr const char* tool_released =
    "the tool was released from the bone: its force fades, and it has force again once it is out of the bone";

/// Fraction of the commanded force that the device received, 0 to 1; 1 without both wires. A device that is weaker than
/// the tool's force, or that has failed, renders a part of it or nothing.
inline double rendered_share(const In<Wrench>& asked, const In<Wrench>& applied) noexcept {
    if (!asked.connected || !applied.connected) return 1.0;
    const double square = glm::dot(asked->force, asked->force);
    if (!(square > 1e-12)) return 1.0;
    const double share = glm::dot(applied->force, asked->force) / square;
    constexpr double rounding = 1e-9;
    return share > 1.0 - rounding ? 1.0 : std::max(share, 0.0);
}

/// Time that a tool cuts in a tick, s: after skipped ticks at most 0.05 s, unless a period is longer.
inline double step_of(const Tick& tick) noexcept {
    const double period = seconds(tick.period);
    return std::clamp(tick.elapsed_seconds(), period, std::max(period, 0.05));
}

/// After a pause of more than 100 ms and three ticks, a tick does not continue the previous motion if the tool was
/// moved meanwhile.
class PauseWatch {
public:
    bool is_moved_in_pause(const Tick& tick, const Pose& pose) noexcept {
        constexpr double longest_pause = 0.1, reach = 0.05;  // s, m
        const bool moved = tick.elapsed_seconds() > std::max(longest_pause, 3.0 * seconds(tick.period)) &&
                           !(is_valid(pose) && is_valid(last_) && !saw::is_jump(last_, pose, reach, 0.0));
        last_ = pose;
        return moved;
    }

private:
    Pose last_;
};

struct ContactThreshold {
    Param contact_on{"0.05 N", "0 N", "10 N", "contact begins above this force"};
    Param contact_off{"0.02 N", "0 N", "10 N", "contact ends below this force"};
    TACTUS_GROUP(contact_on, contact_off)

    bool update(contact::ContactSwitch& now, double force) const noexcept {
        return now.update(force, contact_on, std::min<double>(contact_off, contact_on));
    }
};

}  // namespace tactus::nodes
