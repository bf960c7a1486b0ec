// SPDX-License-Identifier: Apache-2.0
// Figures of the gripper report.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/study/grippers/rig_report.hpp"

namespace tactus::picture {

/// NRMSE over rate; one panel per object, one colour per motor, one dash pattern per amplitude.
display::Figure draw_rig_errors(const study::RigReport& report);
/// Gain and phase error over rate for springs.
display::Figure draw_rig_response(const study::RigReport& report);
/// NRMSE bands of both motors over all assumptions, and the crossover rates.
display::Figure draw_rig_crossover(const study::RigReport& report);
/// Error of the loop of the thesis relative to the error with feed-forward.
display::Figure draw_rig_leads(const study::RigReport& report);
/// Position over force of selected cells.
display::Figure draw_rig_examples(const study::RigReport& report);

}  // namespace tactus::picture
