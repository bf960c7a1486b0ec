// SPDX-License-Identifier: Apache-2.0
// Which pictures `render` makes.
#pragma once

#include "tools/picture/scene/sight_choice.hpp"

#include <string>

namespace tactus::picture {

/// As the command line gives it.
struct FrameChoice {
    int frames = 0;                ///< how many, 0: none
    std::string view_from = "iso";  ///< a name or number of dsp/display/camera.hpp
    std::string size = "1280x800";
    std::string clip;              ///< "x", "-y", "z=12 mm": what is above along that axis is taken away
    SightChoice sight;
};

}  // namespace tactus::picture
