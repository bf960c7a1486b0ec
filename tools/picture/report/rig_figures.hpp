// SPDX-License-Identifier: Apache-2.0
// The pictures of a rig's report.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/study/grippers/rig_report.hpp"

namespace tactus::picture {

/// NRMSE over rate, one panel per object, a colour per motor, dashes per amplitude.
display::Figure draw_rig_errors(const study::RigReport& report);
/// Gain and phase error over rate for springs.
display::Figure draw_rig_response(const study::RigReport& report);
/// Both motors over all that is assumed of them, as bands, and where they cross.
display::Figure draw_rig_crossover(const study::RigReport& report);
/// Error of the loop of the thesis over that with feed-forward.
display::Figure draw_rig_leads(const study::RigReport& report);
/// Position over force of single cells.
display::Figure draw_rig_examples(const study::RigReport& report);

}  // namespace tactus::picture
