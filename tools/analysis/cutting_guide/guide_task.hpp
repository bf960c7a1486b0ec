// SPDX-License-Identifier: Apache-2.0
// A training task from a guide: its bone, the guide on it, a cut per slot, and a hand that does it once.
#pragma once

#include "assets/bone/bone.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include <filesystem>
#include <string>

namespace tactus::analysis {

/// Of the simulated blade, m. A saw that swings, as its blade must reach through the slot.
struct TaskBlade {
    double length = 12e-3;  ///< of the tooth line; a placeholder
    double stroke = 3e-3;  ///< peak to peak
    double thickness_share = 0.7;  ///< of the kerf
};

struct GuideTask {
    std::string text;  ///< of the task file
    bone::Bone bone;   ///< around the guide; its density is assumed
    bone::Bone guide;
};

/// The cuts run in the middle of what the blade removes, half a kerf from the wall on the kept side. The script of the hand
/// puts the guide on, goes back, and saws every slot in turn; it is a demonstration, not a surgeon. `bone_file` and
/// `guide_file` are named relative to the task. Throws Error for a blade below 0.3 mm, whose kerf would need voxels below
/// 0.1 mm, and for a cut that does not meet the bone.
GuideTask guide_task(const PlannedGuide& guide, const std::string& title, const std::filesystem::path& bone_file,
                     const std::filesystem::path& guide_file, const TaskBlade& blade = {});

}  // namespace tactus::analysis
