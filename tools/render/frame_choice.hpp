// SPDX-License-Identifier: Apache-2.0
// Settings of the pictures of `render`.
#pragma once

#include "tools/render/sight_choice.hpp"

#include <string>

namespace tactus::render {

/// The options of the command line.
struct FrameChoice {
    int frames = 0;                ///< number of pictures, 0: none
    /// A name or number of dsp/display/camera.hpp, or "tool": an iso view from the side of the tool.
    std::string view_from = "tool";
    std::string size = "1280x800";
    bool has_no_legend = false;    ///< and no scale
    /// "x", "-y", "z=12 mm", "1,1,0", "1,1,0=12 mm": clip plane; the part above it along the axis, or the direction, is
    /// removed, and the section shows the density of what is cut.
    std::string clip;
    std::string map;  ///< "gaps" or "mirror": colours of a plan's fragments; empty: their own
    std::string map_range = "1 mm";  ///< distance of the fullest colour
    SightChoice sight;
};

}  // namespace tactus::render
