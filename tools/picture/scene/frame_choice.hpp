// SPDX-License-Identifier: Apache-2.0
// Settings of the pictures of `render`.
#pragma once

#include "tools/picture/scene/sight_choice.hpp"

#include <string>

namespace tactus::picture {

/// The options of the command line.
struct FrameChoice {
    int frames = 0;                ///< number of pictures, 0: none
    /// A name or number of dsp/display/camera.hpp, or "tool": an iso view from the side of the tool.
    std::string view_from = "tool";
    std::string size = "1280x800";
    bool has_no_legend = false;    ///< and no scale
    std::string clip;              ///< "x", "-y", "z=12 mm": clip plane; the part above it along the axis is removed
    SightChoice sight;
};

}  // namespace tactus::picture
