// SPDX-License-Identifier: Apache-2.0
// Real-time priorities of the threads of a live run.
#pragma once

#include "dsp/core/time.hpp"
#include "graph/compile/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::run {

/// SCHED_FIFO priority, 11 to 80; the watchdogs are above it (84, 85). Criticality comes first, then the rate of calls:
/// within one class that is the rate-monotonic order, which is optimal among fixed orders (Liu and Layland 1973). By
/// rate alone a 48 kHz sound group would come before a 1 kHz hand.
inline int priority_of(compile::Criticality criticality, Flicks call_period) noexcept {
    constexpr int of_fastest = 80, levels = 14;  // one for each octave from 1 Hz to 8 kHz
    const int octaves = std::clamp(static_cast<int>(std::lround(std::log2(rate_of(call_period)))), 0, levels - 1);
    return of_fastest - levels * static_cast<int>(criticality) - (levels - 1 - octaves);
}

inline int priority_of(const compile::Schedule& plan, const compile::ScheduleGroup& group) noexcept {
    return priority_of(group.criticality, compile::call_period(plan, group));
}

}  // namespace tactus::run
