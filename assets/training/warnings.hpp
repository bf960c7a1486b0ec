// SPDX-License-Identifier: Apache-2.0
// The warnings of an attempt at an instant: what a trainee sees live, and what the score counts. One function for both,
// so that a score carries every warning that was shown.
#pragma once

#include "assets/training/task_file.hpp"
#include "dsp/training/planned_cut.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace tactus::training {

/// m above the bone: from here on deviations from the plan count.
inline constexpr double near_bone = 3e-3;

enum class Warning : std::size_t { off_plan, too_deep, too_near, over_force, over_time, over_heat };
inline constexpr std::size_t warning_count = 6;
/// Names of the ports of the node 'task', in the order of Warning.
inline constexpr std::array<std::string_view, warning_count> warning_names{"off_plan",   "too_deep",  "too_near",
                                                                           "over_force", "over_time", "over_heat"};
/// The same for trainees.
inline constexpr std::array<std::string_view, warning_count> warning_words{"off the plan",   "too deep",  "too near",
                                                                           "too much force", "over time", "too hot"};

/// An attempt at an instant.
struct AttemptState {
    CutDeviation deviation;  ///< of the blade from the planned cut
    double margin_left = 1.0;  ///< m, least distance to a structure to spare beyond its margin; 1 without any
    double hand_N = 0.0;  ///< force on the hand
    double elapsed_s = 0.0;  ///< since the first touch of the bone
    double heat_s = -1.0;  ///< above the temperature that harms bone; negative: unknown
};

/// Active warnings. `cut`: the cut nearest to the blade. Called in a tick: allocates nothing.
inline std::array<bool, warning_count> warnings_of(const TaskFile& task, const PlannedCut& cut,
                                                   const AttemptState& now) noexcept {
    const TaskLimits& limits = task.limits;
    const bool is_near = now.deviation.depth > -near_bone;
    const double aside = now.deviation.distance < 0.0 ? -now.deviation.distance : now.deviation.distance;
    return {is_near && (aside > cut.tolerance || now.deviation.angle > cut.angle_tolerance),
            now.deviation.depth - cut.depth > cut.depth_tolerance,
            now.margin_left < 0.0,
            limits.force && now.hand_N > *limits.force,
            limits.time && now.elapsed_s > *limits.time,
            limits.heat && now.heat_s > *limits.heat};
}

}  // namespace tactus::training
