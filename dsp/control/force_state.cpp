// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/force_state.hpp"

namespace tactus::control {

const char* describe(ForceState state) noexcept {
    switch (state) {
        case ForceState::unknown: return "no forces";
        case ForceState::on: return "forces are on";
        case ForceState::ramps: return "forces are coming in";
        case ForceState::waits: return "forces return when the hand leaves the bone";
        case ForceState::held_back: return "forces are held back for a pause or an edit";
        case ForceState::returns: return "forces return by themselves once ticks were on time";
        case ForceState::returns_freed: return "forces return when this is over and the hand leaves the bone";
        case ForceState::by_hand: return "forces stay off until you let them return";
        case ForceState::by_source: return "forces stay off until the node that reports the fault goes on";
        case ForceState::never: return "forces stay off in this run";
    }
    return "unknown state";
}

}  // namespace tactus::control
