// SPDX-License-Identifier: Apache-2.0
// What is calibrated of a display rig.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::study {

struct CalibrationSettings {
    std::filesystem::path places;              ///< CSV of places known in the viewer's world; empty: none
    std::string tracker;                       ///< driver that tells where the tip is there; empty: none
    std::vector<std::string> screens, images;  ///< whose marks are touched, themselves or in the mirror
    std::string tip = "0 mm, 0 mm, 0 mm";      ///< of the device, in the frame of its handle
    int grid = 3;                              ///< marks per side of a screen
    int points = 8;                            ///< of workspace and mirror
    bool mirror = false;                       ///< it is touched as well
    bool affine = false;                       ///< scales and skews of the device are taken up
    std::string tolerance = "3 mm";            ///< a touch farther off what the others say is refused
};

}  // namespace tactus::study
