// SPDX-License-Identifier: Apache-2.0
// From what is to be calibrated to the file of a rig, whoever leads through the touches: the terminal or the window.
#pragma once

#include "assets/display/rig_file.hpp"
#include "dsp/display/rig_touches.hpp"
#include "tools/study/displays/calibration_settings.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::study {

/// What is to be touched, in order: the device's place first, since the rest counts from it. Throws Error when that is
/// nothing.
std::vector<display::RigTouch> calibration_steps(const CalibrationSettings& settings);

/// Throws Error when no screen is to be touched and none is known: a rig needs one. Better said before the touches.
void check_screens(const CalibrationSettings& settings, const display::RigFile& base);

/// "touch screen 'left' at 10 % of its width from the left and 90 % of its height from below"
std::string prompt_of(const display::RigTouch& step);

/// How touches are fitted, with what is known of the rig before. Throws Error.
display::RigFitOptions fit_options(const CalibrationSettings& settings, const display::RigFile& base);

/// How far touches are off what was fitted, m.
struct TouchesOff {
    double rms = 0.0, worst = 0.0;
    std::size_t count = 0;
    std::size_t worst_touch = 0;  ///< index among all touches, from 0, of the one that is farthest off
};
TouchesOff touches_off(const display::RigFit& fit);

/// "mirror: 0.41 mm rms, 0.82 mm worst"
std::string part_text(const display::TouchedPart& part);

/// The rig with what was fitted in place of what was known, its screens by name. Throws Error when it has no screen.
display::RigFile calibrated_rig(display::RigFile base, const display::RigFit& fit);

/// Writes the rig with the residuals of its fit as a comment, and reads it again. Throws Error.
void write_calibrated(const std::filesystem::path& file, const display::RigFile& rig, const display::RigFit& fit);

}  // namespace tactus::study
