// SPDX-License-Identifier: Apache-2.0
// A display rig on disk: where screens, mirror and haptic device stand in the world of the viewer, and which eye each
// screen is for. `tactus calibrate` writes one; people write and change them by hand.
#pragma once

#include "dsp/display/screen.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::display {

/// Which eyes of the head a screen is for.
enum class ScreenEyes : std::uint8_t { both, left, right, middle };
inline constexpr std::array<std::string_view, 4> screen_eye_names{"both", "left", "right", "middle"};

/// How one screen of a rig is driven.
struct RigScreen {
    std::string name;
    ScreenEyes eyes = ScreenEyes::both;
    std::optional<Vec3> eye;  ///< m, a fixed one in place of the head's: one direction of a multi-view display
    std::optional<StereoMode> stereo;  ///< none: as whoever looks wants it
    int monitor = 0;  ///< from 1, a full screen there; 0: none
    std::array<int, 4> window{};  ///< x, y from the upper left of the desktop, width, height in pixels; 0: none
};

struct RigFile {
    std::string title;
    DisplayRig rig;  ///< its haptic world is the frame of the device: position, orientation and stretch
    std::vector<RigScreen> screens;  ///< one for each of the rig's
    Pose eyes_in_head;  ///< the place between the eyes in the frame of what is tracked
    double head_away = 0.6;  ///< m from the first screen: where the head is when nothing tells
};

/// Reads TOML. Throws Error with file:line:column for what is missing, unknown or cannot be (such as screens that are
/// not rectangles), before anything is shown.
///
///     title = "half-transparent mirror"
///     between_eyes = "63 mm"
///     offset = "0 mm, 0 mm, 0 mm"           # what is seen is moved by so much against where it is felt
///
///     [head]                                # the place between the eyes in the frame of the tracked body
///     position = "0 mm, -60 mm, -20 mm"
///     rotation = "0 deg, 0 deg, 0 deg"      # about x first, then y, then z; x leads from the left eye to the right one
///     away     = "600 mm"                   # from the first screen, when nothing tells where the head is
///
///     [device]                              # frame of the haptic device, in the world of the viewer
///     position    = "10 mm, -250 mm, -40 mm"
///     orientation = [1, 0, 0, 0]            # quaternion w, x, y, z; or rotation, as above
///     stretch     = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]   # rows; before the rotation
///
///     [mirror]
///     point  = "0 mm, 0 mm, 0 mm"
///     normal = [0, 0, 1]
///
///     [[screens]]
///     name      = "monitor"
///     low_left  = "-260 mm, 0 mm, 300 mm"
///     low_right = "260 mm, 0 mm, 300 mm"
///     high_left = "-260 mm, -290 mm, 300 mm"
///     in_mirror = true
///     eyes      = "both"                    # left, right, middle: one projector each
///     eye       = "0 mm, -500 mm, 400 mm"   # a fixed eye, for displays with one projector per direction
///     stereo    = "side-by-side"            # mono, anaglyph, quad-buffer
///     monitor   = 1                         # a full screen there
///     window    = [0, 0, 1920, 1080]        # or so many pixels of the desktop
RigFile load_rig_file(const std::filesystem::path& path);

/// The text of a rig, which load_rig_file reads back to the nanometre. `about`: lines of comment at its head.
std::string rig_text(const RigFile& rig, const std::vector<std::string>& about = {});

/// "1 mm, 2 mm, 3 mm" in SI, each part like `unit`. Throws Error.
Vec3 parse_vector(std::string_view text, std::string_view unit);

}  // namespace tactus::display
