// SPDX-License-Identifier: Apache-2.0
// What `tactus calibrate` is asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus {

struct CalibrateChoice {
    std::filesystem::path out, touches, keep, base, places;
    std::string device, tracker;
    std::vector<std::string> device_options, tracker_options;  ///< NAME=VALUE, of their drivers
    std::string tip = "0 mm, 0 mm, 0 mm";                      ///< in the frame of the handle
    std::vector<std::string> screens, images;  ///< whose marks are touched, themselves or in the mirror
    int grid = 3;  ///< marks per side of a screen
    int points = 8;  ///< of workspace and mirror
    bool mirror = false, affine = false, json = false;
    int show = 0;  ///< monitor, from 1, that shows the marks
    std::string tolerance = "3 mm";
};

}  // namespace tactus
