// SPDX-License-Identifier: Apache-2.0
// How a scene is looked at, as the command line gives it.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::picture {

struct SightChoice {
    std::string stereo = "mono";  ///< or side-by-side, anaglyph, quad-buffer
    std::string head;             ///< a pose output: the viewer's head, in the frame of the rig
    std::filesystem::path rig;  ///< a file, or a name in the library; none: a screen 0.3 m high with the scene in it
    /// What is seen against what is felt: none, study (0.3 m to the right), or three lengths; empty: as the rig says.
    std::string offset;
};

}  // namespace tactus::picture
