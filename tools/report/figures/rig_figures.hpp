// SPDX-License-Identifier: Apache-2.0
// Figures of the gripper report.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/gripper/rig_report.hpp"

namespace tactus::report {

/// NRMSE over rate; one panel per object, one colour per motor, one dash pattern per amplitude.
display::Figure draw_rig_errors(const analysis::RigReport& report);
/// Gain and phase error over rate for springs.
display::Figure draw_rig_response(const analysis::RigReport& report);
/// NRMSE bands of both motors over all assumptions, and the crossover rates.
display::Figure draw_rig_crossover(const analysis::RigReport& report);
/// Error of the loop of the thesis relative to the error with feed-forward.
display::Figure draw_rig_leads(const analysis::RigReport& report);
/// Position over force of selected cells.
display::Figure draw_rig_examples(const analysis::RigReport& report);

}  // namespace tactus::report
