// SPDX-License-Identifier: Apache-2.0
// The steps of a calibration for the terminal and the window: the touches, the fit, the display file.
#pragma once

#include "assets/display/display_file.hpp"
#include "dsp/display/display_fit.hpp"
#include "tools/analysis/display/calibration_settings.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Returns the required touches in order: first those for the pose of the device, on which the others depend. Throws
/// Error if there are none.
std::vector<display::Touch> calibration_steps(const CalibrationSettings& settings);

/// Throws Error if neither the settings nor the base file name a screen. Call it before the first touch.
void check_screens(const CalibrationSettings& settings, const display::DisplayFile& base);

/// "touch screen 'left' at 10 % of its width from the left and 90 % of its height from below"
std::string prompt_of(const display::Touch& step);

/// Returns the options of the fit; parts that are not touched come from the base file. Throws Error.
display::DisplayFitOptions fit_options(const CalibrationSettings& settings, const display::DisplayFile& base);

/// Residuals of all touches, m.
struct TouchesOff {
    double rms = 0.0, worst = 0.0;
    std::size_t count = 0;
    std::size_t worst_touch = 0;  ///< index of the touch with the largest residual
};
TouchesOff touches_off(const display::DisplayFit& fit);

/// "mirror: 0.41 mm rms, 0.82 mm worst"
std::string part_text(const display::TouchedPart& part);

/// The base file with the fitted values; screens are matched by name. Throws Error when it has no screen.
display::DisplayFile calibrated_display(display::DisplayFile base, const display::DisplayFit& fit);

/// Writes the display file with the residuals of the fit as a comment, and reads it back as a check. Throws Error.
void write_calibrated(const std::filesystem::path& file, const display::DisplayFile& display,
                      const display::DisplayFit& fit);

}  // namespace tactus::analysis
