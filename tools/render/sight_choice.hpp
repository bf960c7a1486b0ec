// SPDX-License-Identifier: Apache-2.0
// View options of the command line.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::render {

struct SightChoice {
    std::string stereo = "mono";  ///< or side-by-side, anaglyph, quad-buffer
    std::string head;             ///< a pose output: the viewer's head, in the frame of the display
    std::filesystem::path
        display;  ///< a file, or a name in the library; none: a screen 0.3 m high with the scene in it
    /// Shift of the picture against the haptic position: none, study (0.3 m to the right), or three lengths; empty: that of the
    /// display file.
    std::string offset;
};

}  // namespace tactus::render
