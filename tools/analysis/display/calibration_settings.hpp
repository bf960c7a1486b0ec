// SPDX-License-Identifier: Apache-2.0
// The parts of a display to calibrate, and the method.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

struct CalibrationSettings {
    std::filesystem::path places;              ///< CSV of positions known in the viewer's world; empty: none
    std::string tracker;  ///< driver of a tracker that measures the tip in that world; empty: none
    std::vector<std::string> screens, images;  ///< screens whose markers are touched directly, or at their mirror image
    std::string tip = "0 mm, 0 mm, 0 mm";  ///< position of the tip in the frame of the handle
    int grid = 3;  ///< markers per side of a screen
    int points = 8;  ///< touches of the workspace and of the mirror
    bool mirror = false;  ///< touch the mirror as well
    bool affine = false;  ///< also estimate scale and skew of the device
    std::string tolerance = "3 mm";  ///< largest accepted residual of a touch
};

}  // namespace tactus::analysis
