// SPDX-License-Identifier: Apache-2.0
// Admittance loop with a one-sided object, judged by simulation.
#pragma once

#include "dsp/control/loop_stability.hpp"
#include "dsp/control/virtual_object.hpp"

namespace tactus::control {

/// A finger that a hand presses against the object, lifts off, or holds at its edge comes to rest. A loop that is stable in
/// contact and stable in front of the object may oscillate across the edge for ever, by switching between the two (D. Liberzon,
/// Switching in Systems and Control, 2003): no eigenvalue shows it. Simulates the loop of LoopModel at `model.gain` from a
/// few starts. But for the edge and the largest speed of the motor it is linear. Real-time safe: at most 8 starts of 4000 periods,
/// about 1.4 ms; most come to rest within a tenth of that.
bool settles(const LoopModel& model, const ObjectSettings& object) noexcept;

/// `gain_limit` of the two linear loops, lowered to the largest gain below which `settles` holds, 1/s; 0: none. Real-time safe.
double switched_gain_limit(const LoopModel& model, const ObjectSettings& object) noexcept;

}  // namespace tactus::control
