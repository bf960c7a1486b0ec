// SPDX-License-Identifier: Apache-2.0
// Whether a hand feels forces, and what brings them back, for people.
#pragma once

#include <cstdint>

namespace tactus::control {

enum class ForceState : std::uint8_t {
    unknown,        ///< no node of the patch sends forces, or none of its ticks has run
    on,
    ramps,          ///< forces are coming in
    waits,          ///< the patch asks for a large force: engagement waits until the hand leaves the bone
    held_back,      ///< on purpose: a pause or an edit
    returns,        ///< a late tick: forces come back by themselves
    returns_freed,  ///< another fault: once it is over and the hand leaves the bone
    by_hand,        ///< forces stay away until a person asks for them
    by_source,      ///< a fault that came by a wire: until the node that sends it goes on
    never,          ///< forces stay away until the end of the run
};

/// Forces are away because of a fault.
constexpr bool is_off(ForceState state) noexcept { return state >= ForceState::returns; }

/// What a person is told, as a clause: "forces are on".
const char* describe(ForceState state) noexcept;

}  // namespace tactus::control
